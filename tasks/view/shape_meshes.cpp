#include "pincer/tasks/view/shape_meshes.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/mesh/mesh_pieces.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch.h"
#include "pincer/tasks/view/revolved.h"

namespace pincer::tasks {
namespace {

constexpr int kRound = 96;        // segments of a full turn
constexpr double kUp = M_PI / 2;  // latitude of a profile's upper end [rad]

void addViewTriangle(ViewMesh& mesh, const std::array<ViewVertex, 3>& corners) {
  for (const ViewVertex& corner : corners) {
    mesh.triangles.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(corner);
  }
}

// A flat triangle all of whose edges show.
void addFacet(ViewMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3f n = (b - a).cross(c - a).normalized().cast<float>();
  addViewTriangle(mesh, {{{a.cast<float>(), n, Vec3f::UnitX()},
                          {b.cast<float>(), n, Vec3f::UnitY()},
                          {c.cast<float>(), n, Vec3f::UnitZ()}}});
}

// A flat polygon, of which no edge shows.
void addFace(ViewMesh& mesh, std::span<const Vec3> corners, const Vec3& n) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    std::array<ViewVertex, 3> triangle;
    const std::array<std::size_t, 3> at = {0, i, i + 1};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = {corners[at[k]].cast<float>(), n.cast<float>()};
    addViewTriangle(mesh, triangle);
  }
}

ViewMesh meshOf(const contact::Box& box) {
  ViewMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<Vec3, 4> corners;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t at = side > 0 ? k : 3 - k;
        corners[k][axis] = side * box.half[axis];
        corners[k][u] = (at == 1 || at == 2 ? 1 : -1) * box.half[u];
        corners[k][v] = (at >= 2 ? 1 : -1) * box.half[v];
      }
      addFace(mesh, corners, side * Vec3::Unit(axis));
    }
  }
  return mesh;
}

ViewMesh meshOf(const contact::Sphere& sphere) {
  Profile profile;
  addArc(profile, 0, sphere.radius, kUp, -kUp, kRound / 2);
  return revolve(profile, kRound);
}

ViewMesh meshOf(const contact::Capsule& capsule) {
  Profile profile;
  addArc(profile, capsule.half_length, capsule.radius, kUp, 0, kRound / 4);
  addArc(profile, -capsule.half_length, capsule.radius, 0, -kUp, kRound / 4);
  return revolve(profile, kRound);
}

ViewMesh meshOf(const contact::Cylinder& cylinder) {
  const double r = cylinder.radius, h = cylinder.half_length;
  return revolve({{0, h, 0, 1}, {r, h, 0, 1}, {r, h, 1, 0}, {r, -h, 1, 0}, {r, -h, 0, -1}, {0, -h, 0, -1}}, kRound);
}

ViewMesh meshOf(const contact::CylinderWithFlat& c) {
  ViewMesh mesh;
  const double half_angle = math::acos(c.flat_distance / c.radius);
  std::vector<Vec3> top, bottom;
  for (int i = 0; i <= kRound; ++i) {
    const double a = half_angle + (2 * M_PI - 2 * half_angle) * i / kRound;
    top.emplace_back(c.radius * math::cos(a), c.radius * math::sin(a), c.half_length);
    bottom.emplace_back(top.back() - 2 * c.half_length * Vec3::UnitZ());
  }
  const auto normal = [&](std::size_t i) {
    return Vec3f(Vec3(top[i].x() / c.radius, top[i].y() / c.radius, 0).cast<float>());
  };
  for (std::size_t i = 0; i + 1 < top.size(); ++i) {
    const std::size_t j = i + 1;
    addViewTriangle(mesh, {{{top[i].cast<float>(), normal(i)},
                            {bottom[i].cast<float>(), normal(i)},
                            {bottom[j].cast<float>(), normal(j)}}});
    addViewTriangle(
        mesh,
        {{{top[i].cast<float>(), normal(i)}, {bottom[j].cast<float>(), normal(j)}, {top[j].cast<float>(), normal(j)}}});
  }
  addFace(mesh, std::array{top.back(), bottom.back(), bottom.front(), top.front()}, Vec3::UnitX());
  addFace(mesh, top, Vec3::UnitZ());
  std::reverse(bottom.begin(), bottom.end());
  addFace(mesh, bottom, -Vec3::UnitZ());
  return mesh;
}

ViewMesh meshOf(const contact::Convex& convex) {
  ViewMesh mesh;
  for (const auto& face : convex.hull->faces()) {
    std::vector<Vec3> corners;
    for (const int vertex : convex.hull->cornersOf(face))
      corners.push_back(convex.hull->vertices()[static_cast<std::size_t>(vertex)]);
    addFace(mesh, corners, face.n);
  }
  return mesh;
}

// A bowl with a wall: inside, rounded rim, outside, flat foot.
ViewMesh bowlMesh(double radius, double extent) {
  const double half = math::asin(std::min(extent / radius, 0.95)), wall = 0.035 * extent;
  const double rim_r = (radius + wall) * math::sin(half), rim_z = radius - (radius + wall) * math::cos(half);
  Profile profile;
  addArc(profile, radius, radius, -kUp, -kUp + half, 48, true);
  for (int i = 1; i < 12; ++i) {
    const double a = M_PI - half + kUp - M_PI * i / 12;  // from the inside over the top
    const Vec2 n(math::cos(a), math::sin(a));
    profile.push_back({rim_r + wall * n.x(), rim_z + wall * n.y(), n.x(), n.y()});
  }
  addArc(profile, radius, radius + 2 * wall, -kUp + half, -kUp, 48);
  return revolve(profile, kRound);
}

ViewMesh facetsOf(const contact::SmoothMesh& surface) {
  ViewMesh mesh;
  const contact::TriangleMesh& flat = surface.triangles();
  for (const auto& t : flat.triangles) {
    const auto corner = [&](int k) { return flat.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
    addFacet(mesh, corner(0), corner(1), corner(2));
  }
  return mesh;
}

// Each patch on a grid of `parts` steps along its edges.
void addPatch(ViewMesh& mesh, const contact::Patch& patch, int parts) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i <= parts; ++i) {
    for (int j = 0; j <= parts - i; ++j) {
      const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
      const contact::PatchPoint at = contact::evaluate(patch, u, v);
      mesh.vertices.push_back(
          {at.S.cast<float>(), at.N.normalized().cast<float>(), Vec3(1 - u - v, u, v).cast<float>()});
    }
  }
  const auto place = [&](int i, int j) {
    return first + static_cast<std::uint32_t>(i * (parts + 1) - i * (i - 1) / 2 + j);
  };
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; j < parts - i; ++j) {
      mesh.triangles.insert(mesh.triangles.end(), {place(i, j), place(i + 1, j), place(i, j + 1)});
      if (j + 1 < parts - i)
        mesh.triangles.insert(mesh.triangles.end(), {place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)});
    }
  }
}

ViewMesh smoothOf(const contact::SmoothMesh& surface) {
  ViewMesh mesh;
  const auto count = static_cast<std::int32_t>(surface.triangles().triangles.size());
  const int parts = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(kDrawnTriangles) / count)), 1, 12);
  for (std::int32_t i = 0; i < count; ++i) addPatch(mesh, surface.patch(i), parts);
  return mesh;
}

}  // namespace

namespace {

// Sheets, and pieces that face inwards, are seen from both sides.
bool isClosed(const contact::TriangleMesh& mesh) {
  const std::vector<contact::HalfEdge> half_edges = contact::sortedHalfEdges(mesh.triangles);
  const contact::MeshPieces pieces = contact::findPieces(mesh, half_edges, contact::findTopology(mesh, half_edges));
  return std::all_of(pieces.list.begin(), pieces.list.end(),
                     [](const auto& piece) { return piece.closed && !piece.facesInwards(); });
}

ViewMesh closed(ViewMesh mesh) {
  mesh.closed = true;
  return mesh;
}

ViewMesh solidMesh(const contact::Shape& shape, double extent) {
  if (const auto* dish = std::get_if<contact::Dish>(&shape)) return bowlMesh(dish->radius, extent);
  if (const auto* sphere = std::get_if<contact::Sphere>(&shape)) return meshOf(*sphere);
  if (const auto* box = std::get_if<contact::Box>(&shape)) return meshOf(*box);
  if (const auto* capsule = std::get_if<contact::Capsule>(&shape)) return meshOf(*capsule);
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&shape)) return meshOf(*cylinder);
  if (const auto* flat = std::get_if<contact::CylinderWithFlat>(&shape)) return meshOf(*flat);
  return meshOf(std::get<contact::Convex>(shape));
}

}  // namespace

ViewMesh shapeMesh(const contact::Shape& shape, MeshLook look, double extent) {
  if (std::holds_alternative<contact::HalfSpace>(shape)) return revolve({{0, 0, 0, 1}, {extent, 0, 0, 1}}, kRound);
  const auto* mesh = std::get_if<contact::Mesh>(&shape);
  if (!mesh) return closed(solidMesh(shape, extent));
  ViewMesh drawn = look == MeshLook::kFacets ? facetsOf(*mesh->surface) : smoothOf(*mesh->surface);
  drawn.closed = isClosed(mesh->surface->triangles());
  return drawn;
}

namespace {

// Of the hull of a pad: each face moved out by the rounding, and its edges and corners
// rounded by strips and caps of small facets.
void addRoundEdge(ViewMesh& mesh, const Vec3& from, const Vec3& to, const Vec3& n, const Vec3& m, double rho) {
  constexpr int kParts = 6;  // of an edge's turn; chosen: it looks round
  const auto normal = [&](int i) -> Vec3 { return (n + (m - n) * (static_cast<double>(i) / kParts)).normalized(); };
  for (int i = 0; i < kParts; ++i) {
    const Vec3 a = normal(i), b = normal(i + 1);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [p, d] : {std::pair(from, a), std::pair(to, a), std::pair(to, b), std::pair(from, b)}) {
      mesh.vertices.push_back({(p + rho * d).cast<float>(), d.cast<float>(), Vec3f::Ones()});
    }
    mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
  }
}

ViewMesh meshOf(const contact::PadTip& pad) {
  ViewMesh mesh;
  const contact::Polytope& hull = *pad.hull;
  const auto vertex = [&](int i) -> const Vec3& { return hull.vertices()[static_cast<std::size_t>(i)]; };
  for (const auto& face : hull.faces()) {
    std::vector<Vec3> corners;
    for (const int i : hull.cornersOf(face)) corners.push_back(vertex(i) + pad.rounding * face.n);
    addFace(mesh, corners, face.n);
  }
  for (const auto& edge : hull.edges()) {
    const Vec3 &left = hull.faces()[static_cast<std::size_t>(edge.left)].n,
               &right = hull.faces()[static_cast<std::size_t>(edge.right)].n;
    addRoundEdge(mesh, vertex(edge.to), vertex(edge.from), left, right, pad.rounding);
  }
  const ViewMesh ball = meshOf(contact::Sphere{pad.rounding});
  for (const Vec3& corner : hull.vertices()) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (ViewVertex v : ball.vertices) {
      v.p += corner.cast<float>();
      mesh.vertices.push_back(v);
    }
    for (const std::uint32_t i : ball.triangles) mesh.triangles.push_back(first + i);
  }
  return mesh;
}

// A ball's points, each moved to the support point along its normal.
ViewMesh roundTip(const contact::FingerShape& tip) {
  ViewMesh mesh = meshOf(contact::Sphere{1});
  for (ViewVertex& v : mesh.vertices) v.p = contact::supportOf(tip, v.n.cast<double>().normalized()).cast<float>();
  return mesh;
}

}  // namespace

ViewMesh tipMesh(const contact::FingerShape& tip) {
  if (const auto* pad = std::get_if<contact::PadTip>(&tip)) return meshOf(*pad);
  return closed(roundTip(tip));
}

ViewMesh ballMesh() { return closed(meshOf(contact::Sphere{1})); }
ViewMesh rodMesh() {
  return closed(revolve({{0, 1, 0, 1}, {1, 1, 0, 1}, {1, 1, 1, 0}, {1, 0, 1, 0}, {1, 0, 0, -1}, {0, 0, 0, -1}}, 24));
}
ViewMesh openConeMesh() {
  const double k = std::sqrt(0.5);
  return revolve({{1, 1, k, -k}, {0, 0, k, -k}}, 48);
}
ViewMesh arrowHeadMesh() {
  const double k = std::sqrt(0.5);
  return closed(revolve({{0, 1, k, k}, {1, 0, k, k}, {1, 0, 0, -1}, {0, 0, 0, -1}}, 32));
}

// A ball at the tip, from there a slightly thicker round body; turned from z to -x.
ViewMesh fingerMesh(double length) {
  Profile profile;
  addArc(profile, 0, 1, kUp, 0, 24);
  const auto width = [&](double share) { return 1 + 0.16 * share * share * (3 - 2 * share); };
  for (int i = 1; i <= 12; ++i) profile.push_back({width(i / 12.0), -length * i / 12.0, 1, 0.08});
  const double end = width(1);
  for (int i = 1; i <= 12; ++i) {
    const double a = -kUp * i / 12;
    profile.push_back(
        {std::max(end * math::cos(a), 0.0), -length + 0.5 * end * math::sin(a), math::cos(a), math::sin(a)});
  }
  ViewMesh mesh = revolve(profile, 64);
  const Eigen::Matrix3f turn = Eigen::Quaternionf::FromTwoVectors(Vec3f::UnitZ(), Vec3f::UnitX()).toRotationMatrix();
  for (ViewVertex& vertex : mesh.vertices) {
    vertex.p = turn * vertex.p;
    vertex.n = turn * vertex.n;
  }
  return closed(std::move(mesh));
}

ViewMesh padMesh(double angle) {
  Profile profile;
  addArc(profile, 0, 1.008, -kUp + angle, -kUp, 16);
  return revolve(profile, 64);
}

// An oval patch on the back of the finger, over the tip.
ViewMesh nailMesh() {
  Profile profile;
  addArc(profile, 0, 1, kUp, kUp - 0.62, 16);
  ViewMesh mesh = revolve(profile, 48);
  for (ViewVertex& vertex : mesh.vertices) {
    vertex.p.x() = 1.15f * vertex.p.x() + 0.05f;
    // Onto the finger: a cylinder behind the centre, a ball before it.
    const float x = std::max(vertex.p.x(), 0.0f), y = vertex.p.y();
    vertex.p.z() = 1.02f * std::sqrt(std::max(1 - x * x - y * y, 0.0f));
    vertex.n = Vec3f(x, y, vertex.p.z()).normalized();
  }
  return mesh;
}

}  // namespace pincer::tasks
