// Mass properties: primitives against counting points, meshes against primitives,
// principal axes against their definition.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <random>

#include "pincer/contact/error.h"
#include "pincer/engine/motion/mass.h"
#include "pincer/tests/support/constants.h"

namespace pincer::engine {
namespace {

using contact::Box;
using contact::Capsule;
using contact::Cylinder;
using contact::CylinderWithFlat;
using contact::Shape;
using contact::Sphere;
using contact::TriangleMesh;
using tests::kPi;

constexpr double kMass = 0.25;  // [kg]

bool contains(const Sphere& s, const Vec3& p) { return p.norm() <= s.radius; }
bool contains(const Box& b, const Vec3& p) { return (p.cwiseAbs() - b.half).maxCoeff() <= 0; }
bool contains(const Cylinder& c, const Vec3& p) {
  return p.head<2>().norm() <= c.radius && std::abs(p.z()) <= c.half_length;
}
bool contains(const Capsule& c, const Vec3& p) {
  return (p - Vec3(0, 0, std::clamp(p.z(), -c.half_length, c.half_length))).norm() <= c.radius;
}
bool contains(const CylinderWithFlat& c, const Vec3& p) {
  return contains(Cylinder{c.radius, c.half_length}, p) && p.x() <= c.flat_distance;
}
template <class Other>
bool contains(const Other&, const Vec3&) {
  return false;
}

// Counts a million points that fill the cuboid evenly (Kronecker sequence of the
// plastic-number family, M. Roberts 2018): good to 1e-3.
MassProperties countPoints(const Shape& shape, double mass, const Vec3& half, double& volume) {
  constexpr int kPoints = 1000000;
  const Vec3 stride(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  double count = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (int n = 0; n < kPoints; ++n) {
    const Vec3 turns = (n + 0.5) * stride;
    const Vec3 p = half.cwiseProduct(2 * (turns - turns.array().floor().matrix()) - Vec3::Ones());
    if (!std::visit([&](const auto& s) { return contains(s, p); }, shape)) continue;
    ++count;
    first += p;
    second += p * p.transpose();
  }
  volume = 8 * half.prod() * count / kPoints;
  const Vec3 centre = first / count;
  const Mat3 spread = second / count - centre * centre.transpose();
  return {mass, centre, mass * (spread.trace() * Mat3::Identity() - spread)};
}

class Primitive : public testing::TestWithParam<Shape> {};

TEST_P(Primitive, MatchesItsPointsCounted) {
  double volume = 0;
  const MassProperties counted = countPoints(GetParam(), kMass, {0.03, 0.04, 0.05}, volume);
  const MassProperties exact = massPropertiesOf(GetParam(), kMass);
  EXPECT_EQ(exact.mass, kMass);
  EXPECT_NEAR(volumeOf(GetParam()), volume, 2e-3 * volume);
  EXPECT_LE((exact.p_BBcm - counted.p_BBcm).norm(), 5e-5);
  EXPECT_LE((exact.I_BBcm - counted.I_BBcm).norm(), 2e-3 * exact.I_BBcm.norm());
}
INSTANTIATE_TEST_SUITE_P(Shapes, Primitive,
                         testing::Values(Shape(Sphere{0.025}), Shape(Box{{0.01, 0.03, 0.04}}),
                                         Shape(Capsule{0.015, 0.03}), Shape(Capsule{0.02, 0}),
                                         Shape(Cylinder{0.025, 0.04}), Shape(CylinderWithFlat{0.025, 0.04, 0.01}),
                                         Shape(CylinderWithFlat{0.025, 0.01, 0.024}),
                                         Shape(CylinderWithFlat{0.025, 0.02, 0.001})));

constexpr double kRelativeRoundOff = 1e-14;  // relative

TEST(Mass, OfABallIsTwoFifths) {
  const double r = 0.02;
  EXPECT_NEAR(massPropertiesOf(Sphere{r}, kMass).I_BBcm(0, 0), 0.4 * kMass * r * r, kRelativeRoundOff * kMass * r * r);
  EXPECT_NEAR(volumeOf(Sphere{r}), 4.0 / 3 * kPi * r * r * r, kRelativeRoundOff);
}

TEST(Mass, OfACapsuleWithoutLengthIsThatOfABall) {
  const Mat3 difference =
      massPropertiesOf(Capsule{0.02, 0}, kMass).I_BBcm - massPropertiesOf(Sphere{0.02}, kMass).I_BBcm;
  EXPECT_LE(difference.norm(), kRelativeRoundOff * kMass * 4e-4);
}

// The segment's two limits: no cut, and half the cylinder, whose centre is 4 r / (3 pi) from the axis.
TEST(Mass, OfACylinderWithFlatMeetsItsLimits) {
  const double r = 0.02, h = 0.03;
  const MassProperties whole = massPropertiesOf(Cylinder{r, h}, kMass);
  const MassProperties nearly = massPropertiesOf(CylinderWithFlat{r, h, r * (1 - 1e-12)}, kMass);
  EXPECT_LE((whole.I_BBcm - nearly.I_BBcm).norm(), 1e-12 * whole.I_BBcm.norm());
  const MassProperties half = massPropertiesOf(CylinderWithFlat{r, h, r * 1e-13}, kMass);
  const double c = 4 * r / (3 * kPi);
  EXPECT_NEAR(half.p_BBcm.x(), -c, 1e-12 * r);
  EXPECT_NEAR(half.I_BBcm(2, 2), kMass * (r * r / 2 - c * c), 1e-11 * kMass * r * r);
}

TEST(Mass, RefusesWhatHasNoEnd) {
  EXPECT_THROW(massPropertiesOf(contact::HalfSpace{}, kMass), InputError);
  EXPECT_THROW(volumeOf(contact::Shape(contact::Dish{0.1})), InputError);
}

TEST(Mass, RefusesMassesThatAreNotPositive) {
  for (const double mass : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(massPropertiesOf(Sphere{0.02}, mass), InputError) << mass;
}

TriangleMesh boxMesh(const Vec3& half, const Vec3& centre) {
  TriangleMesh mesh;
  mesh.source = "box.obj";
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(
        centre + Vec3(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(), k & 4 ? half.z() : -half.z()));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// The prism over a polygon that goes counter-clockwise around the z axis.
TriangleMesh prism(const std::vector<Vec2>& polygon, double half_length) {
  TriangleMesh mesh;
  const auto n = static_cast<std::int32_t>(polygon.size());
  for (const double z : {-half_length, half_length})
    for (const Vec2& p : polygon) mesh.vertices.push_back({p.x(), p.y(), z});
  for (const double z : {-half_length, half_length}) mesh.vertices.push_back({0, 0, z});
  for (std::int32_t a = 0; a < n; ++a) {
    const std::int32_t b = (a + 1) % n;
    mesh.triangles.insert(mesh.triangles.end(),
                          {{2 * n, b, a}, {2 * n + 1, n + a, n + b}, {a, b, n + b}, {a, n + b, n + a}});
  }
  return mesh;
}

// A polygon of 20,000 corners misses the arc by (pi / 20000)^2 / 6 of its second
// moments at most, 4e-9; twice that for the area.
TEST(MeshMass, OfAPrismIsTheCylindersWithFlat) {
  const CylinderWithFlat cylinder{0.025, 0.04, 0.01};
  const double from = std::acos(cylinder.flat_distance / cylinder.radius);
  constexpr int kCorners = 20000;
  std::vector<Vec2> arc;
  for (int n = 0; n <= kCorners; ++n) {
    const double angle = from + (2 * kPi - 2 * from) * n / kCorners;
    arc.push_back({cylinder.radius * std::cos(angle), cylinder.radius * std::sin(angle)});
  }
  const TriangleMesh mesh = prism(arc, cylinder.half_length);
  const MassProperties sampled = massPropertiesOf(mesh, kMass), exact = massPropertiesOf(cylinder, kMass);
  EXPECT_NEAR(volumeOf(mesh), volumeOf(cylinder), 2e-8 * volumeOf(cylinder));
  EXPECT_LE((sampled.p_BBcm - exact.p_BBcm).norm(), 2e-8 * cylinder.radius);
  EXPECT_LE((sampled.I_BBcm - exact.I_BBcm).norm(), 2e-8 * exact.I_BBcm.norm());
}

TriangleMesh turned(TriangleMesh mesh, const Pose& X) {
  for (Vec3& p : mesh.vertices) p = X * p;
  return mesh;
}

TEST(MeshMass, OfABoxIsTheBoxs) {
  const Vec3 half(0.01, 0.03, 0.04), centre(0.2, -0.3, 0.5);
  const TriangleMesh mesh = boxMesh(half, centre);
  const MassProperties m = massPropertiesOf(mesh, kMass);
  EXPECT_NEAR(volumeOf(mesh), 8 * half.prod(), kRelativeRoundOff);
  EXPECT_LE((m.p_BBcm - centre).norm(), kRelativeRoundOff);
  EXPECT_LE((m.I_BBcm - massPropertiesOf(Box{half}, kMass).I_BBcm).norm(), 1e-13 * m.I_BBcm.norm());
}

// Rotation and translation of the mesh carry over to centre and inertia.
RC_GTEST_PROP(MeshMass, FollowsTheMesh, (int seed)) {
  std::mt19937 generator(static_cast<unsigned>(seed));
  std::normal_distribution<double> normal;
  const auto vector = [&] {
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return Vec3(x, y, z);
  };
  const Pose X{quatFromRotationVector(vector()), vector()};
  const TriangleMesh mesh = boxMesh({0.1, 0.3, 0.2}, {0.1, 0, 0});
  const MassProperties before = massPropertiesOf(mesh, kMass), after = massPropertiesOf(turned(mesh, X), kMass);
  const Mat3 R = X.q.toRotationMatrix();
  RC_ASSERT((after.p_BBcm - X * before.p_BBcm).norm() <= 1e-13 * (1 + X.p.norm()));
  RC_ASSERT((after.I_BBcm - R * before.I_BBcm * R.transpose()).norm() <= 1e-12 * before.I_BBcm.norm());
}

// Two boxes side by side, joined by the parallel-axis theorem, are one box.
TEST(MeshMass, ObeysTheParallelAxisTheorem) {
  const Vec3 half(0.02, 0.03, 0.04), offset(0.02, 0, 0);
  TriangleMesh both = boxMesh(half, offset);
  const TriangleMesh other = boxMesh(half, -offset);
  for (auto triangle : other.triangles) {
    for (auto& vertex : triangle) vertex += 8;
    both.triangles.push_back(triangle);
  }
  both.vertices.insert(both.vertices.end(), other.vertices.begin(), other.vertices.end());
  const Mat3 expected = massPropertiesOf(Box{{0.04, 0.03, 0.04}}, kMass).I_BBcm;
  EXPECT_LE((massPropertiesOf(both, kMass).I_BBcm - expected).norm(), 1e-13 * expected.norm());
}

TEST(MeshMass, RefusesAMeshTurnedInsideOut) {
  TriangleMesh mesh = boxMesh({0.01, 0.01, 0.01}, Vec3::Zero());
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  try {
    massPropertiesOf(mesh, kMass);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("box.obj"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("-8e-06"), std::string::npos);
  }
}

TEST(PrincipalAxes, AreTheBodysOwnWhereItIsSymmetric) {
  const MassProperties m = massPropertiesOf(CylinderWithFlat{0.02, 0.03, 0.01}, kMass);
  const PrincipalInertia principal = principalInertia(m);
  EXPECT_EQ(principal.X_BI.q.coeffs(), Quat::Identity().coeffs());
  EXPECT_EQ(principal.X_BI.p, m.p_BBcm);
  EXPECT_EQ(principal.moments, m.I_BBcm.diagonal());
}

TEST(PrincipalAxes, IgnoreTheRoundOffOfAMesh) {
  const MassProperties m = massPropertiesOf(boxMesh({0.02, 0.02, 0.02}, {0.1, 0.2, 0.3}), kMass);
  EXPECT_EQ(principalInertia(m).X_BI.q.coeffs(), Quat::Identity().coeffs());
}

RC_GTEST_PROP(PrincipalAxes, MakeTheInertiaDiagonal, (int seed)) {
  std::mt19937 generator(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> uniform(-1, 1);
  Mat3 spread;  // any positive semi-definite spread is that of some solid
  for (int k = 0; k < 9; ++k) spread.data()[k] = uniform(generator);
  spread = (spread * spread.transpose()).eval();
  const Mat3 inertia = spread.trace() * Mat3::Identity() - spread;
  const PrincipalInertia principal = principalInertia({1, Vec3::Zero(), inertia});
  const Mat3 R = principal.X_BI.q.toRotationMatrix();
  RC_ASSERT((R * principal.moments.asDiagonal() * R.transpose() - inertia).norm() <= 1e-14 * inertia.norm());
  RC_ASSERT(std::abs(R.determinant() - 1) <= 1e-14);
}

TEST(PrincipalAxes, RefuseWhatNoSolidHas) {
  const auto refused = [](const Vec3& moments) {
    EXPECT_THROW(principalInertia({1, Vec3::Zero(), moments.asDiagonal()}), InputError) << moments;
  };
  refused({0, 1, 1});
  refused({-1, 1, 1});
  refused({1, 1, 2.1});
  refused({1, 1, std::nan("")});
  EXPECT_NO_THROW(principalInertia({1, Vec3::Zero(), Vec3(1, 1, 2).asDiagonal()}));  // a thin plate
}

}  // namespace
}  // namespace pincer::engine
