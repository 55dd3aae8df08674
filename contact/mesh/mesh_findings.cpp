#include "pincer/contact/mesh/mesh_findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/io/counted.h"

namespace pincer::contact {

namespace {

constexpr double kSmallestHeld = 0.005, kLargestHeld = 0.5;  // [m]

std::string millimetres(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

// Open edges that remain once vertices at the same place are one.
int boundaryAfterMerging(const TriangleMesh& mesh) {
  const std::vector<std::int32_t> first = firstAtSamePlace(mesh, usedVertices(mesh));
  std::vector<std::array<std::int32_t, 3>> merged = mesh.triangles;
  for (auto& t : merged) {
    for (std::int32_t& v : t) v = first[static_cast<std::size_t>(v)];
  }
  int boundary = 0;
  forEachEdge(sortedHalfEdges(merged), [&](auto edge) { boundary += isBoundary(edge); });
  return boundary;
}

std::string piecePlace(const TriangleMesh& mesh, const MeshPiece& piece) {
  return fmt::format("the one of {} with {}", counted(piece.triangles, "triangle"),
                     trianglePlace(mesh, piece.first_triangle));
}

}  // namespace

std::string vertexPlace(const TriangleMesh& mesh, std::int32_t vertex) {
  return fmt::format("vertex {} at {}", vertex + 1, millimetres(mesh.vertices[static_cast<std::size_t>(vertex)]));
}

std::string edgePlace(const TriangleMesh& mesh, const VertexPair& edge) {
  return fmt::format("from {} to {}", vertexPlace(mesh, edge[0]), vertexPlace(mesh, edge[1]));
}

std::string trianglePlace(const TriangleMesh& mesh, std::int32_t triangle) {
  Vec3 middle = Vec3::Zero();
  for (const std::int32_t v : mesh.triangles[static_cast<std::size_t>(triangle)])
    middle += mesh.vertices[static_cast<std::size_t>(v)] / 3;
  return fmt::format("triangle {} at {}", triangle + 1, millimetres(middle));
}

MaybeFinding boundaryFinding(const TriangleMesh& mesh, const MeshTopology& t) {
  const int n = t.boundary.count;
  if (n == 0) return {};
  std::string text = fmt::format("the mesh is open: {} with only one triangle, the first {}. ", counted(n, "edge"),
                                 edgePlace(mesh, t.boundary.first));
  const int holes = boundaryAfterMerging(mesh);
  if (holes == 0) {
    return MeshFinding{
        "seams", true, n,
        text + "All of them are seams between duplicate vertices: `pincer mesh convert --repair` welds these."};
  }
  if (holes < n) {
    text += fmt::format(
        "{} of them are seams between duplicate vertices, the others rims of holes. `pincer mesh convert --repair` "
        "welds the "
        "seams; check the result again to see which holes are left.",
        n - holes);
    return MeshFinding{"boundary-edges", true, n, text};
  }
  text += fmt::format("They form {}, the longest of {} near {}. ", counted(t.loops, "loop"),
                      counted(t.longest_loop, "edge"), vertexPlace(mesh, t.longest_loop_vertex));
  text += fmt::format(
      "Fill the holes: `pincer mesh convert --repair --fill-holes {}`, or in a mesh editor; a body's mass needs a "
      "closed "
      "surface.",
      t.longest_loop);
  return MeshFinding{"boundary-edges", true, n, text};
}

MaybeFinding branchingFinding(const TriangleMesh& mesh, const MeshTopology& t) {
  if (t.branching.count == 0) return {};
  return MeshFinding{"nonmanifold-edges", true, t.branching.count,
                     fmt::format("the surface branches at {}, the first {}: more than two triangles meet there. "
                                 "`pincer mesh convert --repair` drops "
                                 "duplicate faces and cuts such edges apart; what is left open then are inner walls: "
                                 "delete them in a mesh editor.",
                                 counted(t.branching.count, "edge"), edgePlace(mesh, t.branching.first))};
}

MaybeFinding reversedFinding(const TriangleMesh& mesh, const MeshTopology& t) {
  if (t.reversed.count == 0) return {};
  return MeshFinding{
      "inconsistent-winding", true, t.reversed.count,
      fmt::format(
          "triangles on the two sides of {} face opposite ways, the first {}. `pincer mesh convert --repair` makes "
          "the orientation consistent.",
          counted(t.reversed.count, "edge"), edgePlace(mesh, t.reversed.first))};
}

MaybeFinding touchingFinding(const TriangleMesh& mesh, const MeshTopology& t) {
  if (t.touching.count == 0) return {};
  return MeshFinding{
      "self-touching", true, t.touching.count,
      fmt::format(
          "the surface touches itself at {}, the first is {}. `pincer mesh convert --repair` splits such vertices.",
          counted(t.touching.count, "vertex"), vertexPlace(mesh, t.touching.first))};
}

MaybeFinding flippedPieceFinding(const TriangleMesh& mesh, const MeshPieces& pieces) {
  Occurrences<const MeshPiece*> flipped;
  for (const MeshPiece& piece : pieces.list) {
    if (piece.facesInwards()) flipped.add(&piece);
  }
  if (flipped.count == 0) return {};
  return MeshFinding{
      "flipped-component", true, flipped.count,
      fmt::format(
          "{} of {} face inwards, the first is {} (signed volume {:.4g} cm^3). `pincer mesh convert --repair` turns "
          "them outwards.",
          flipped.count, counted(static_cast<int>(pieces.list.size()), "piece"), piecePlace(mesh, *flipped.first),
          1e6 * flipped.first->volume)};
}

MaybeFinding nestedPieceFinding(const TriangleMesh& mesh, const MeshPieces& pieces) {
  if (!pieces.nesting_known) {
    return MeshFinding{
        "nesting-unknown", false, static_cast<int>(pieces.list.size()),
        fmt::format(
            "with {} it would take too long to find out which lie inside others: a piece that faces inwards counts "
            "as flipped, not as a cavity. Delete what isn't meant.",
            counted(static_cast<int>(pieces.list.size()), "piece"))};
  }
  Occurrences<const MeshPiece*> nested;
  for (const MeshPiece& piece : pieces.list) {
    if (piece.isNestedSolid()) nested.add(&piece);
  }
  if (nested.count == 0) return {};
  return MeshFinding{
      "nested-component", false, nested.count,
      fmt::format(
          "{} inside others and facing outwards, the first is {}: no finger reaches it and its volume counts twice. "
          "Delete it in a mesh editor, or flip it if it is meant as a cavity.",
          counted(nested.count, "piece"), piecePlace(mesh, *nested.first))};
}

MaybeFinding severalPiecesFinding(const TriangleMesh& mesh, const MeshPieces& pieces) {
  const auto n = static_cast<int>(pieces.list.size());
  if (n < 2) return {};
  const auto smallest =
      std::min_element(pieces.list.begin(), pieces.list.end(), [](auto& a, auto& b) { return a.area < b.area; });
  return MeshFinding{
      "several-components", false, n,
      fmt::format(
          "the mesh has {} separate pieces, the smallest is {}; all of them move as one body. Delete what isn't meant "
          "in a mesh editor.",
          n, piecePlace(mesh, *smallest))};
}

MaybeFinding duplicateVertexFinding(const TriangleMesh& mesh, const std::vector<std::int32_t>& first_at_place) {
  Occurrences<std::int32_t> duplicates;
  for (std::size_t v = 0; v < first_at_place.size(); ++v) {
    if (first_at_place[v] != static_cast<std::int32_t>(v)) duplicates.add(static_cast<std::int32_t>(v));
  }
  if (duplicates.count == 0) return {};
  return MeshFinding{
      "duplicate-vertices", false, duplicates.count,
      fmt::format(
          "{} at the place of an earlier one, the first is {}. Where the surface is open there, `pincer mesh convert "
          "--repair` welds them.",
          counted(duplicates.count, "vertex"), vertexPlace(mesh, duplicates.first))};
}

MaybeFinding unusedVertexFinding(const TriangleMesh& mesh, const std::vector<bool>& used) {
  const auto first = std::find(used.begin(), used.end(), false);
  if (first == used.end()) return {};
  const auto n = static_cast<int>(std::count(first, used.end(), false));
  return MeshFinding{
      "unused-vertices", false, n,
      fmt::format("{} in no triangle, the first is {}; ignored. `pincer mesh convert --repair` drops them.",
                  counted(n, "vertex"), vertexPlace(mesh, static_cast<std::int32_t>(first - used.begin())))};
}

MaybeFinding zeroAreaFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles) {
  if (triangles.count == 0) return {};
  return MeshFinding{
      "zero-area-triangles", true, triangles.count,
      fmt::format(
          "{} without area, the first is {}: it has no normal. `pincer mesh convert --repair` removes them without a "
          "gap.",
          counted(triangles.count, "triangle"), trianglePlace(mesh, triangles.first))};
}

MaybeFinding needleFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles) {
  if (triangles.count == 0) return {};
  return MeshFinding{
      "needle-triangles", false, triangles.count,
      fmt::format(
          "{} thinner than 1/1000 of their length, the first is {}: normals are inaccurate there. Remesh that place "
          "in a mesh editor, or weld its ends (`pincer mesh convert --repair --weld`).",
          counted(triangles.count, "triangle"), trianglePlace(mesh, triangles.first))};
}

MaybeFinding duplicateTriangleFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles) {
  if (triangles.count == 0) return {};
  return MeshFinding{
      "duplicate-faces", true, triangles.count,
      fmt::format("{} with the vertices of an earlier one, the first is {}. `pincer mesh convert --repair` drops them.",
                  counted(triangles.count, "triangle"), trianglePlace(mesh, triangles.first))};
}

MaybeFinding opposingNormalFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles) {
  if (triangles.count == 0) return {};
  return MeshFinding{
      "opposing-normals", false, triangles.count,
      fmt::format(
          "the file's normals point to the back of {}, the first is {}. Such normals don't count, the facets decide "
          "there. `pincer mesh convert --repair` drops them; or have your program compute the normals again.",
          counted(triangles.count, "triangle"), trianglePlace(mesh, triangles.first))};
}

MaybeFinding flatPieceFinding(const TriangleMesh& mesh, const MeshPieces& pieces) {
  Occurrences<const MeshPiece*> flat;
  for (const MeshPiece& piece : pieces.list) {
    if (piece.hasNoThickness()) flat.add(&piece);
  }
  if (flat.count == 0) return {};
  return MeshFinding{
      "zero-thickness", true, flat.count,
      fmt::format(
          "{} closed, but without thickness: its two sides lie on each other, so that it encloses no volume and a "
          "finger slips through. The first is {}. Give it a thickness in a mesh editor (\"solidify\"), or delete it.",
          counted(flat.count, "piece"), piecePlace(mesh, *flat.first))};
}

MaybeFinding sizeFinding(double size, double metres_per_unit) {
  if (size >= kSmallestHeld && size <= kLargestHeld) return {};
  std::string text = fmt::format("the mesh is {:.4g} mm long; hands hold 5 to 500 mm. ", 1e3 * size);
  struct Unit {
    const char* name;
    double metres;
  };
  std::string fitting;
  for (const Unit& unit : {Unit{"mm", 0.001}, Unit{"cm", 0.01}, Unit{"in", 0.0254}, Unit{"m", 1}}) {
    const double other = size / metres_per_unit * unit.metres;
    if (other < kSmallestHeld || other > kLargestHeld) continue;
    fitting += fmt::format("{}--units {} ({:.4g} mm)", fitting.empty() ? "" : " or ", unit.name, 1e3 * other);
  }
  text += fitting.empty() ? "No usual unit makes it hand-sized: give its length, `pincer mesh convert --size 0.06`."
                          : "Is the unit right? It would fit a hand with " + fitting + ".";
  return MeshFinding{"wrong-scale", true, 1, text};
}

}  // namespace pincer::contact
