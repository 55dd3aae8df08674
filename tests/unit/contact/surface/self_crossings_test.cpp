// Triangles that pass through each other: against a try of all pairs, and against shapes whose crossings are known.
#include "pincer/contact/surface/self_crossings.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "pincer/contact/generated_meshes.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::RandomNumbers;

TriangleMesh twoOf(const TriangleMesh& mesh, const Vec3& apart) {
  TriangleMesh both = mesh;
  both.normals.clear();
  both.triangle_normals.clear();
  const auto n = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) both.vertices.push_back(v + apart);
  for (const auto& t : mesh.triangles) both.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return both;
}

// Of a segment and a triangle: by the plane's parameter and barycentric coordinates, not by volumes.
bool segmentMeets(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q, const Vec3& r) {
  Mat3 A;
  A << a - b, q - p, r - p;
  const Vec3 x = A.fullPivLu().solve(a - p);
  return x[0] > 0 && x[0] < 1 && x[1] > 0 && x[2] > 0 && x[1] + x[2] < 1;
}

bool triedByHand(const TriangleMesh& mesh, std::size_t s, std::size_t t) {
  const auto at = [&](std::size_t k, std::size_t i) {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[k][i % 3])];
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (segmentMeets(at(s, i), at(s, i + 1), at(t, 0), at(t, 1), at(t, 2))) return true;
    if (segmentMeets(at(t, i), at(t, i + 1), at(s, 0), at(s, 1), at(s, 2))) return true;
  }
  return false;
}

// Random triangles share no vertex and lie in no common plane, so both tests are far from round-off.
TEST(SelfCrossings, AreThoseThatATryOfAllPairsFinds) {
  RandomNumbers random(5);
  for (int round = 0; round < 10; ++round) {
    TriangleMesh soup;
    for (int t = 0; t < 60; ++t) {
      const Vec3 middle(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      for (int i = 0; i < 3; ++i) {
        soup.vertices.push_back(middle +
                                0.5 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
      }
      soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    std::int64_t pairs = 0;
    std::int32_t first = -1, other = -1;
    for (std::size_t s = 0; s < soup.triangles.size(); ++s) {
      for (std::size_t t = s + 1; t < soup.triangles.size(); ++t) {
        if (!triedByHand(soup, s, t)) continue;
        if (++pairs == 1) first = static_cast<std::int32_t>(s), other = static_cast<std::int32_t>(t);
      }
    }
    const SelfCrossings found = findSelfCrossings(soup);
    EXPECT_GT(pairs, 0);
    EXPECT_EQ(found.pairs, pairs);
    EXPECT_EQ(found.first, first);
    EXPECT_EQ(found.other, other);
    EXPECT_TRUE(found.is_all);
  }
}

TEST(SelfCrossings, ASoundMeshHasNone) {
  for (const TriangleMesh& mesh :
       {icosphere(0.02, 3), torus(0.03, 0.012, 48, 24), cylinder(0.02, 0.03, 48, 1), box({0.02, 0.015, 0.03}),
        gridBox({0.03, 0.02, 0.0005}, 12), grooveBlock(M_PI / 4, 0.012, 0.03, 0.03)}) {
    EXPECT_EQ(findSelfCrossings(mesh).pairs, 0) << mesh.source;
  }
}

TEST(SelfCrossings, SolidsThroughEachOtherAreFoundAndThoseBesideEachOtherNot) {
  const TriangleMesh sphere = icosphere(0.02, 2);
  EXPECT_GT(findSelfCrossings(twoOf(sphere, {0.0301, 0.0023, 0.0011})).pairs, 10);
  EXPECT_EQ(findSelfCrossings(twoOf(sphere, {0.0401, 0, 0})).pairs, 0);
  const TriangleMesh cube = box({0.02, 0.02, 0.02});
  EXPECT_EQ(findSelfCrossings(twoOf(cube, {0.04, 0, 0})).pairs, 0) << "face on face";
  EXPECT_GT(findSelfCrossings(twoOf(cube, {0.03, 0.011, 0.007})).pairs, 0);
}

// A vertex pushed through the far side: neighbours at vertices cross what is there.
TEST(SelfCrossings, AVertexPushedThroughTheFarSideIsFound) {
  TriangleMesh mesh = icosphere(0.02, 2);
  mesh.vertices[0] *= -1.2;
  const SelfCrossings found = findSelfCrossings(mesh);
  EXPECT_GE(found.pairs, 5);
  EXPECT_GE(found.first, 0);
  EXPECT_GT(found.other, found.first);
}

}  // namespace
}  // namespace pincer::contact
