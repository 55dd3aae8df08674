// Findings of `pincer mesh info` and `pincer mesh check`, and how they are shown.
#include <fmt/format.h>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/self_crossings.h"
#include "pincer/tasks/app/commands/mesh_commands.h"
#include "pincer/tasks/app/terminal.h"

namespace pincer::tasks {
namespace {

constexpr double kTightest = 0.8;  // finger radius over that of a hollow, beyond which contact jumps across

contact::MeshFinding foldFinding(const contact::SmoothMesh& surface) {
  const auto& folded = surface.foldedTriangles();
  const contact::TriangleMesh& mesh = surface.triangles();
  const Vec3 p = 1e3 * mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(folded[0])][0])];
  return {
      "folded-patches", false, static_cast<int>(folded.size()),
      fmt::format(
          "the smooth surface folds over on {} triangle(s), the first is triangle {} near ({:.4g}, {:.4g}, {:.4g}) mm: "
          "neighbouring normals differ too much there, and contact may be held. Refine the mesh there, or make the "
          "edge a "
          "crease (a lower crease angle, or normals in the file).",
          folded.size(), folded[0] + 1, p.x(), p.y(), p.z())};
}

contact::MeshFinding hollowFinding(double hollow, double finger) {
  return {"tight-hollow", false, 1,
          fmt::format("a finger of {:.3g} mm radius doesn't fit into the tightest hollow, of {:.3g} mm radius: contact "
                      "may jump across it. "
                      "Fill or widen such hollows, round concave edges (`pincer mesh round-edges`), or use a finger "
                      "below {:.3g} mm.",
                      1e3 * finger, 1e3 * hollow, 1e3 * kTightest * hollow)};
}

contact::MeshFinding crossingFinding(const contact::TriangleMesh& mesh, const contact::SelfCrossings& found) {
  const auto& t = mesh.triangles[static_cast<std::size_t>(found.first)];
  const Vec3 p = 1e3 * mesh.vertices[static_cast<std::size_t>(t[0])];
  return {
      "self-intersection", true, static_cast<int>(found.pairs),
      fmt::format("{}{} pair(s) of triangles pass through each other, the first is triangle {} at ({:.4g}, {:.4g}, "
                  "{:.4g}) mm with triangle "
                  "{}: a finger may get stuck inside, and volume counts twice. Unite such parts in a mesh editor.",
                  found.is_all ? "" : "at least ", found.pairs, found.first + 1, p.x(), p.y(), p.z(), found.other + 1)};
}

constexpr int kManyTriangles = 20'000;  // beyond these the patches that a finger needs leave the processor's cache

contact::MeshFinding manyTrianglesFinding(int triangles) {
  return {"many-triangles", false, triangles,
          fmt::format("{} triangles are more than a finger feels: ticks take longer, now and then more than 1 ms. "
                      "`pincer mesh simplify` "
                      "makes them fewer and keeps the surface.",
                      triangles)};
}

contact::MeshFinding badFaceFinding(const FaultyMesh& read) {
  return {"bad-faces", true, read.left_out,
          fmt::format("{} can't be used, the first: {} `pincer mesh convert --repair` leaves them out; check the "
                      "result for the holes that "
                      "they leave.",
                      counted(read.left_out, "face"), read.first_bad)};
}

bool hasSmoothSurface(const contact::MeshReport& report) {
  return report.triangles > 0 && report.nonmanifold_edges == 0 && report.nonmanifold_vertices == 0 &&
         report.zero_area_triangles == 0;
}

}  // namespace

MeshCheck checkMesh(const FaultyMesh& read, double metres_per_unit, double finger_radius) {
  const contact::TriangleMesh& mesh = read.mesh;
  MeshCheck check;
  check.report = contact::inspect(mesh, {.metres_per_unit = metres_per_unit});
  if (read.left_out > 0) check.report.findings.insert(check.report.findings.begin(), badFaceFinding(read));
  const contact::SelfCrossings crossings = contact::findSelfCrossings(mesh);
  if (crossings.pairs > 0) check.report.findings.push_back(crossingFinding(mesh, crossings));
  check.has_surface = hasSmoothSurface(check.report);
  if (!check.has_surface) return check;
  if (check.report.triangles > kManyTriangles)
    check.report.findings.push_back(manyTrianglesFinding(check.report.triangles));
  const auto surface = contact::SmoothMesh::build(mesh);
  check.folded_triangles = static_cast<int>(surface->foldedTriangles().size());
  check.concave_radius = surface->tightestConcaveRadius();
  if (check.folded_triangles > 0) check.report.findings.push_back(foldFinding(*surface));
  if (finger_radius > kTightest * check.concave_radius) {
    check.report.findings.push_back(hollowFinding(check.concave_radius, finger_radius));
  }
  return check;
}

std::string findingsText(const std::vector<contact::MeshFinding>& findings) {
  std::string out;
  for (const contact::MeshFinding& finding : findings) {
    out += fmt::format("  {} {}: {}\n", finding.unfit ? bad("!") : "-", finding.name, finding.text);
  }
  return out;
}

void writeFindings(const std::vector<contact::MeshFinding>& findings, JsonWriter& json) {
  json.key("findings").beginArray();
  for (const contact::MeshFinding& finding : findings) {
    json.beginObject().key("name").value(finding.name).key("unfit").value(finding.unfit);
    json.key("count").value(finding.count).key("text").value(finding.text).endObject();
  }
  json.endArray();
}

}  // namespace pincer::tasks
