// Which corners of a mesh's hull carry it: judged by brute force over its facets.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/pairs.h"

namespace pincer::contact {
namespace {

using tests::featuresOf;
using tests::kMargin;

// A facet of a hull, found by trying every triple of its vertices: all the others lie behind it.
struct Facet {
  std::array<Vec3, 3> corners_B;
  Vec3 n_B;
};

bool isFacet(const std::vector<Vec3>& hull, const Vec3& p, const Vec3& n) {
  return std::none_of(hull.begin(), hull.end(), [&](const Vec3& q) { return n.dot(q - p) > 1e-12; });
}

std::vector<Facet> facetsOf(const std::vector<Vec3>& hull) {
  std::vector<Facet> facets;
  const auto tryFacet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a).normalized();
    if (isFacet(hull, a, n)) facets.push_back({{a, b, c}, n});
    if (isFacet(hull, a, -n)) facets.push_back({{a, c, b}, -n});
  };
  for (std::size_t i = 0; i < hull.size(); ++i) {
    for (std::size_t j = i + 1; j < hull.size(); ++j) {
      for (std::size_t k = j + 1; k < hull.size(); ++k) tryFacet(hull[i], hull[j], hull[k]);
    }
  }
  return facets;
}

// A pebble: an icosphere pulled out of shape, so that no four corners of its hull lie in a plane.
TriangleMesh pebble(int level) {
  TriangleMesh mesh = icosphere(0.03, level);
  for (Vec3& v : mesh.vertices)
    v = Vec3(1.3 * v.x(), v.y(), 0.8 * v.z()) * (1 + 0.03 * std::sin(90 * v.x() + 140 * v.y() + 60 * v.z()));
  return mesh;
}

Pose onFacet(const Facet& facet) {
  const Quat q = Quat::FromTwoVectors(facet.n_B, -Vec3::UnitZ());
  return {q, {0.01, 0.02, -(q * facet.corners_B[0]).z()}};
}

PairPoints onGround(const Mesh& mesh, const Pose& X_WB) {
  PairPoints out;
  PatchCache cache(64);
  collideShapes(mesh, X_WB, HalfSpace{}, Pose{}, kMargin, cache, out);
  return out;
}

double distanceToNearest(const PairPoints& p, const Vec3& p_W) {
  double nearest = 1;
  for (int i = 0; i < p.count; ++i) nearest = std::min(nearest, (p.points[i].p_W - p_W).norm());
  return nearest;
}

struct MeshAtRest : ::testing::Test {
  const Mesh mesh{SmoothMesh::build(pebble(2))};
  const std::vector<Facet> facets = facetsOf(mesh.surface->hullVertices());
};

// A body that lies on a facet has its centre of pressure within it: all three corners must be
// among the points, however close together.
TEST_F(MeshAtRest, KeepsAllCornersOfTheFacetThatItLiesOn) {
  ASSERT_GE(facets.size(), 100u);
  for (const Facet& facet : facets) {
    const Pose X_WB = onFacet(facet);
    const PairPoints p = onGround(mesh, X_WB);
    // round-off of the pose
    for (const Vec3& corner_B : facet.corners_B) ASSERT_LE(distanceToNearest(p, X_WB * corner_B), 1e-12);
  }
}

// Whatever rocks it by less than a micrometre at its corners, the points that carry stay.
TEST_F(MeshAtRest, KeepsThemWhileItRocks) {
  for (const Facet& facet : facets) {
    const Pose still = onFacet(facet);
    for (int i = 0; i < 10; ++i) {
      const Quat rocked = Quat(Eigen::AngleAxisd(1e-6, Vec3(std::cos(i), std::sin(i), 0)));
      const Pose X_WB{rocked * still.q, still.p};
      const PairPoints p = onGround(mesh, X_WB);
      // p_W is half the gap away
      for (const Vec3& corner_B : facet.corners_B) ASSERT_LE(distanceToNearest(p, X_WB * corner_B), 1e-6);
    }
  }
}

std::vector<Vec3> sharedCorners(const Facet& one, const Facet& other) {
  std::vector<Vec3> shared;
  for (const Vec3& a : one.corners_B) {
    if (std::find(other.corners_B.begin(), other.corners_B.end(), a) != other.corners_B.end()) shared.push_back(a);
  }
  return shared;
}

// Balanced on the edge between two facets it keeps both ends of that edge, and a point on
// either side: it tips no further than that way.
TEST_F(MeshAtRest, KeepsAnEdgeAndAPointOnEitherSideOfIt) {
  int edges = 0;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    for (std::size_t j = i + 1; j < facets.size(); ++j) {
      const std::vector<Vec3> shared = sharedCorners(facets[i], facets[j]);
      if (shared.size() != 2 || facets[i].n_B.dot(facets[j].n_B) < 0.99) continue;
      const Quat q = Quat::FromTwoVectors((facets[i].n_B + facets[j].n_B).normalized(), -Vec3::UnitZ());
      const Pose X_WB{q, {0, 0, -(q * shared[0]).z()}};
      const PairPoints p = onGround(mesh, X_WB);
      const Vec3 a_W = X_WB * shared[0], b_W = X_WB * shared[1];
      if (p.count < 4) continue;  // the others are out of reach
      ++edges;
      EXPECT_LE(distanceToNearest(p, a_W), 1e-12) << i << " " << j;
      EXPECT_LE(distanceToNearest(p, b_W), 1e-12) << i << " " << j;
      double right = 0, left = 0;
      for (int k = 0; k < p.count; ++k) {
        const double side = (b_W - a_W).cross(p.points[k].p_W - a_W).z();
        right = std::min(right, side);
        left = std::max(left, side);
      }
      EXPECT_LT(right, -1e-6) << i << " " << j;  // [m^2], of an edge of about 8 mm: 0.1 mm beside it
      EXPECT_GT(left, 1e-6) << i << " " << j;
    }
  }
  EXPECT_GE(edges, 10);
}

// A ground face with many corners: those kept enclose most of it, and rocking by round-off changes none of them.
TEST_F(MeshAtRest, StandsSquarelyOnARoundBase) {
  const Mesh coin{SmoothMesh::build(cylinder(0.03, 0.01, 48, 4))};
  const PairPoints still = onGround(coin, {Quat::Identity(), {0, 0, 0.01}});
  ASSERT_EQ(still.count, 4);
  const auto inscribed = [&] {
    double area = 0;  // of the quadrilateral, from its diagonals
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
          const Vec3 ab = still.points[j].p_W - still.points[i].p_W;
          area = std::max(area, 0.5 * ab.cross(still.points[k].p_W - still.points[i].p_W).norm());
        }
      }
    }
    return area;
  };
  EXPECT_GE(inscribed(), 0.95 * 0.03 * 0.03);  // half the inscribed square, but for the corners' spacing
  for (int i = 0; i < 100; ++i) {
    const Quat rocked = Quat(Eigen::AngleAxisd(1e-10, Vec3(std::cos(i), std::sin(i), 0)));
    EXPECT_EQ(featuresOf(onGround(coin, {rocked, {0, 0, 0.01}})), featuresOf(still)) << i;
  }
}

}  // namespace
}  // namespace pincer::contact
