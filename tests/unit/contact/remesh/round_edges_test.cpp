#include "pincer/contact/mesh/round_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/surface_net.h"
#include "pincer/tests/support/inside_out.h"

namespace pincer::contact {
namespace {

using tests::insideOut;

constexpr double kEdgeRadius = 1.5e-3;
constexpr double kHalfCube = 0.0283;  // the dissertation's cube of 56.6 mm

// The solid over a convex polygon, counter-clockwise in the plane z = 0, from z = -half_height to half_height.
TriangleMesh prismOver(const std::vector<Vec2>& polygon, double half_height) {
  TriangleMesh mesh;
  mesh.source = "prism";
  const auto n = static_cast<std::int32_t>(polygon.size());
  for (const double z : {-half_height, half_height}) {
    for (const Vec2& p : polygon) mesh.vertices.emplace_back(p.x(), p.y(), z);
  }
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
    if (i > 0 && j > 0) {
      mesh.triangles.push_back({0, j, i});
      mesh.triangles.push_back({n, n + i, n + j});
    }
  }
  return mesh;
}

TriangleMesh regularPrism(int sides, double circumradius, double half_height) {
  std::vector<Vec2> polygon;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * M_PI * i / sides;
    polygon.emplace_back(circumradius * std::cos(a), circumradius * std::sin(a));
  }
  return prismOver(polygon, half_height);
}

// Tip at (0, 0, height), base of `base` corners in the plane z = 0.
TriangleMesh pyramid(int base, double radius, double height) {
  TriangleMesh mesh;
  mesh.source = "pyramid";
  mesh.vertices = {{0, 0, height}, {0, 0, 0}};
  for (int i = 0; i < base; ++i) {
    const double a = 2 * M_PI * i / base;
    mesh.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), 0);
  }
  for (std::int32_t i = 0; i < base; ++i) {
    const std::int32_t a = 2 + i, b = 2 + (i + 1) % base;
    mesh.triangles.push_back({0, a, b});
    mesh.triangles.push_back({1, b, a});
  }
  return mesh;
}

TriangleMesh tetrahedron(double edge) {
  const double h = edge / std::sqrt(8);
  TriangleMesh mesh;
  mesh.source = "tetrahedron";
  mesh.vertices = {{h, h, h}, {h, -h, -h}, {-h, h, -h}, {-h, -h, h}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return mesh;
}

// A cube with a cubic cavity in its middle: all edges of the cavity are concave seen from the finger.
TriangleMesh hollowCube(double half, double half_cavity) {
  TriangleMesh mesh = box(Vec3::Constant(half)), cavity = insideOut(box(Vec3::Constant(half_cavity)));
  for (auto t : cavity.triangles) {
    for (auto& v : t) v += 8;
    mesh.triangles.push_back(t);
  }
  mesh.vertices.insert(mesh.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  return mesh;
}

struct Deviation {
  double place = 0;   // largest distance of the smooth surface from the exact one [m]
  double normal = 0;  // largest angle of its normals [rad]
};

// The smooth surface over every triangle against a signed distance; its gradient, by
// central differences, is the exact normal.
Deviation deviationOf(const TriangleMesh& mesh, const std::function<double(const Vec3&)>& distance) {
  constexpr double kStep = 1e-7;  // [m]; differences of distances of 0.1 m are good to 1e-9 then
  const SurfaceNet net(mesh, 0.7, true);
  Deviation worst;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangles.size()); ++t) {
    const Patch patch = net.build(t).patch;
    for (int i = 0; i <= 6; ++i) {
      for (int j = 0; i + j <= 6; ++j) {
        const PatchPoint x = evaluate(patch, i / 6.0, j / 6.0);
        Vec3 n;
        for (int k = 0; k < 3; ++k)
          n[k] = distance(x.S + kStep * Vec3::Unit(k)) - distance(x.S - kStep * Vec3::Unit(k));
        worst.place = std::max(worst.place, std::abs(distance(x.S)));
        worst.normal = std::max(worst.normal, std::atan2(x.N.cross(n).norm(), x.N.dot(n)));
      }
    }
  }
  return worst;
}

// Of a box with rounded edges, negative inside.
double roundedBoxDistance(const Vec3& p, const Vec3& half, double r) {
  const Vec3 q = p.cwiseAbs() - (half - Vec3::Constant(r));
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0) - r;
}

// Of a convex polygon in the half-plane of (distance to the axis, z), turned about z, its corners rounded.
double roundedProfileDistance(const std::vector<Vec2>& inset, const Vec3& p, double r) {
  const Vec2 q(std::hypot(p.x(), p.y()), p.z());
  double nearest = 1e9;
  bool inside = true;
  for (std::size_t i = 0; i < inset.size(); ++i) {
    const Vec2 a = inset[i], b = inset[(i + 1) % inset.size()], e = b - a, d = q - a;
    nearest = std::min(nearest, (d - e * std::clamp(d.dot(e) / e.squaredNorm(), 0.0, 1.0)).norm());
    inside &= e.x() * d.y() - e.y() * d.x() >= 0;
  }
  return (inside ? -nearest : nearest) - r;
}

void expectSound(const RoundedMesh& rounded) {
  const MeshReport report = inspect(rounded.mesh);
  EXPECT_TRUE(report.closed);
  EXPECT_GT(report.volume, 0);
  EXPECT_EQ(report.crease_edges, 0) << "its normals make it smooth";
  EXPECT_EQ(report.zero_area_triangles + report.duplicate_vertices + report.unused_vertices, 0);
  EXPECT_NO_THROW(requireClosed(rounded.mesh));
  EXPECT_TRUE(SmoothMesh::build(rounded.mesh)->foldedTriangles().empty());
}

// Vertices are exact. Between them the patches over a corner's 16 triangles
// leave the ball by a thousandth of its radius.
TEST(RoundEdges, ACubeBecomesTheRoundedBox) {
  const Vec3 half = Vec3::Constant(kHalfCube);
  const RoundedMesh rounded = roundEdges(box(half), {.radius = kEdgeRadius});
  EXPECT_EQ(rounded.creases, 12);
  EXPECT_EQ(rounded.corners, 8);
  EXPECT_EQ(rounded.mesh.triangles.size(), 12u + 12 * 2 * 4 + 8 * 16);
  expectSound(rounded);
  const auto distance = [&](const Vec3& p) { return roundedBoxDistance(p, half, kEdgeRadius); };
  for (const Vec3& v : rounded.mesh.vertices) EXPECT_NEAR(distance(v), 0, 1e-16);  // closed forms on both sides
  const Deviation deviation = deviationOf(rounded.mesh, distance);
  EXPECT_LE(deviation.place, 2e-6);
  EXPECT_LE(deviation.normal, 1e-3);
}

TEST(RoundEdges, FinerArcsComeCloser) {
  const Vec3 half = Vec3::Constant(kHalfCube);
  const auto distance = [&](const Vec3& p) { return roundedBoxDistance(p, half, kEdgeRadius); };
  const double coarse = deviationOf(roundEdges(box(half), {.radius = kEdgeRadius, .segments = 3}).mesh, distance).place;
  const double fine = deviationOf(roundEdges(box(half), {.radius = kEdgeRadius, .segments = 6}).mesh, distance).place;
  EXPECT_LT(fine, coarse / 6) << "at least third order in the angle";
}

TEST(RoundEdges, ACylinderGetsRimsOfATorus) {
  const double R = 0.025, H = 0.03;
  const RoundedMesh rounded = roundEdges(cylinder(R, H, 48, 2), {.radius = kEdgeRadius});
  EXPECT_EQ(rounded.creases, 96);
  EXPECT_EQ(rounded.corners, 0);
  expectSound(rounded);
  const std::vector<Vec2> inset = {{-R, -H + kEdgeRadius},
                                   {R - kEdgeRadius, -H + kEdgeRadius},
                                   {R - kEdgeRadius, H - kEdgeRadius},
                                   {-R, H - kEdgeRadius}};
  const Deviation deviation =
      deviationOf(rounded.mesh, [&](const Vec3& p) { return roundedProfileDistance(inset, p, kEdgeRadius); });
  // The strip begins at a chord of the cap's circle, whose sagitta is 50 um: 1/30 of
  // the radius, so much its normal is off too.
  EXPECT_LE(deviation.place, 3e-6);
  EXPECT_LE(deviation.normal, 0.04);
}

TEST(RoundEdges, AConeGetsARimAndACap) {
  const double R = 0.025, H = 0.05;
  const RoundedMesh rounded = roundEdges(pyramid(96, R, H), {.radius = kEdgeRadius});
  EXPECT_EQ(rounded.creases, 96);
  EXPECT_EQ(rounded.tips, 1);
  expectSound(rounded);
  // The cone moved inwards: its base by the radius, its lines by the radius across them.
  const double slant = std::hypot(R, H);
  const double tip = H - kEdgeRadius * slant / R, base = (tip - kEdgeRadius) * R / H;
  const std::vector<Vec2> inset = {{-base, kEdgeRadius}, {base, kEdgeRadius}, {0, tip}};
  const Deviation deviation =
      deviationOf(rounded.mesh, [&](const Vec3& p) { return roundedProfileDistance(inset, p, kEdgeRadius); });
  // The lateral side, one facet long, is what is off: by less than its sagitta, R
  // (1 - cos 1.9 degrees) = 13 um at the base.
  EXPECT_LE(deviation.place, 7e-6);
  EXPECT_LE(deviation.normal, 0.04);
}

// Faces stay in their planes, all else lies at the radius from the body moved
// inwards: the support function says both at once.
void expectRoundedPolytope(const TriangleMesh& sharp, const RoundedMesh& rounded) {
  std::vector<Vec3> normals;
  std::vector<double> offsets;
  for (const auto& t : sharp.triangles) {
    const auto p = [&](std::size_t i) { return sharp.vertices[static_cast<std::size_t>(t[i])]; };
    normals.push_back((p(1) - p(0)).cross(p(2) - p(0)).normalized());
    offsets.push_back(normals.back().dot(p(0)));
  }
  for (std::size_t v = 0; v < rounded.mesh.vertices.size(); ++v) {
    const Vec3 centre = rounded.mesh.vertices[v] - kEdgeRadius * rounded.mesh.normals[v];
    double room = 1;
    for (std::size_t k = 0; k < normals.size(); ++k) {
      ASSERT_LE(normals[k].dot(rounded.mesh.vertices[v]), offsets[k] + 1e-15) << "nothing sticks out";
      room = std::min(room, offsets[k] - normals[k].dot(centre));
    }
    ASSERT_NEAR(room, kEdgeRadius, 1e-15) << "the ball that made this vertex touches a face and crosses none";
  }
}

TEST(RoundEdges, RoundsTheShapesOfShapeIdentification) {
  const double edge = 0.0566;
  for (const TriangleMesh& sharp : {tetrahedron(edge), regularPrism(3, 0.03, 0.02), regularPrism(8, 0.03, 0.02)}) {
    const RoundedMesh rounded = roundEdges(sharp, {.radius = kEdgeRadius});
    expectSound(rounded);
    EXPECT_EQ(rounded.corners, static_cast<int>(sharp.vertices.size())) << sharp.source;
    expectRoundedPolytope(sharp, rounded);
  }
}

TEST(RoundEdges, RoundsACornerOfManyFacesThatOneBallTouches) {
  const TriangleMesh sharp = pyramid(4, 0.03, 0.03);
  const RoundedMesh rounded = roundEdges(sharp, {.radius = kEdgeRadius});
  EXPECT_EQ(rounded.corners, 5);
  expectSound(rounded);
  expectRoundedPolytope(sharp, rounded);
}

TEST(RoundEdges, RoundsConcaveEdges) {
  const double cavity = 0.02;
  const RoundedMesh rounded = roundEdges(hollowCube(0.03, cavity), {.radius = kEdgeRadius});
  EXPECT_EQ(rounded.creases, 24);
  expectSound(rounded);
  const Deviation deviation = deviationOf(rounded.mesh, [&](const Vec3& p) {
    const double outer = roundedBoxDistance(p, Vec3::Constant(0.03), kEdgeRadius);
    return std::max(outer, -roundedBoxDistance(p, Vec3::Constant(cavity), kEdgeRadius));
  });
  EXPECT_LE(deviation.place, 2e-6);
}

TEST(RoundEdges, LetsACreaseFadeOut) {
  TriangleMesh mesh = icosphere(0.02, 3);  // smooth by its normals, but for one edge
  for (const Vec3& v : mesh.vertices) mesh.normals.push_back(v.normalized());
  mesh.triangle_normals = mesh.triangles;
  const std::int32_t a = mesh.triangles[0][0], b = mesh.triangles[0][1];
  const Vec3 along = mesh.vertices[static_cast<std::size_t>(b)] - mesh.vertices[static_cast<std::size_t>(a)];
  const Vec3 n = (mesh.normals[static_cast<std::size_t>(a)] -
                  0.2 * along.cross(mesh.normals[static_cast<std::size_t>(a)]).normalized());
  mesh.normals.push_back(n.normalized());
  // corner a of triangle 0 leans: two creases end
  mesh.triangle_normals[0][0] = static_cast<std::int32_t>(mesh.normals.size()) - 1;
  const RoundedMesh rounded = roundEdges(mesh, {.radius = 1e-4});
  EXPECT_GT(rounded.creases, 0);
  const MeshReport report = inspect(rounded.mesh);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.crease_edges, 0);
}

TEST(RoundEdges, LeavesASmoothMeshAlone) {
  const TriangleMesh ball = icosphere(0.02, 2);
  const RoundedMesh rounded = roundEdges(ball);
  EXPECT_EQ(rounded.creases + rounded.corners + rounded.tips, 0);
  EXPECT_EQ(rounded.mesh.vertices, ball.vertices);
  EXPECT_EQ(rounded.mesh.triangles, ball.triangles);
}

std::string errorOf(const TriangleMesh& mesh, const RoundOptions& options) {
  try {
    roundEdges(mesh, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The largest radius of a cube is half its edge; of a tetrahedron its inscribed ball's, edge / sqrt(24).
TEST(RoundEdges, NamesTheLargestRadiusThatFits) {
  const std::string cube = errorOf(box(Vec3::Constant(0.002)), {.radius = 0.0021});
  EXPECT_NE(cube.find("doesn't fit at triangle"), std::string::npos) << cube;
  EXPECT_NE(cube.find("--radius 1.98 (mm)"), std::string::npos) << cube;
  EXPECT_NO_THROW(roundEdges(box(Vec3::Constant(0.002)), {.radius = 0.00198}));
  const double inscribed = 0.0566 / std::sqrt(24);
  EXPECT_EQ(errorOf(tetrahedron(0.0566), {.radius = 0.98 * inscribed}), "");
  EXPECT_NE(errorOf(tetrahedron(0.0566), {.radius = inscribed}), "");
}

TEST(RoundEdges, RefusesByNameWhatNoBallTouches) {
  const std::vector<Vec2> ell = {{0, 0}, {0.04, 0}, {0.04, 0.02}, {0.02, 0.02}, {0.02, 0.04}, {0, 0.04}};
  const std::string mixed = errorOf(prismOver(ell, 0.01), {});
  EXPECT_NE(mixed.find("convex and concave edges meet"), std::string::npos) << mixed;
  TriangleMesh skew = pyramid(4, 0.03, 0.03);
  skew.vertices[2] += Vec3(0.02, 0.02, 0);
  const std::string four = errorOf(skew, {});
  EXPECT_NE(four.find("4 faces meet that no ball touches"), std::string::npos) << four;
  EXPECT_NE(four.find("vertex"), std::string::npos) << four;
  TriangleMesh open = box(Vec3::Constant(0.02));
  open.triangles.pop_back();
  EXPECT_NE(errorOf(open, {}).find("open"), std::string::npos);
  EXPECT_NE(errorOf(box(Vec3::Constant(0.02)), {.radius = -1}).find("out of range"), std::string::npos);
}

}  // namespace
}  // namespace pincer::contact
