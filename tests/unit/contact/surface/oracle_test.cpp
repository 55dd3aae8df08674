// The clever search judged by brute force, and the collection's real meshes
// (beside the checkout; skipped without them).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/surface_net.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/touch.h"

namespace pincer::contact {
namespace {

using tests::direction;
using tests::RandomNumbers;

constexpr int kSamples = 12;  // per patch edge

std::vector<Vec3> samplePatches(const SurfaceNet& net) {
  std::vector<Vec3> points;
  for (std::int32_t t = 0; t < net.size(); ++t) {
    const SurfaceCell cell = net.build(t);
    for (int i = 0; i <= kSamples; ++i) {
      for (int j = 0; i + j <= kSamples; ++j) {
        points.push_back(place(cell.patch, static_cast<double>(i) / kSamples, static_cast<double>(j) / kSamples));
      }
    }
  }
  return points;
}

struct OracleCase {
  TriangleMesh mesh;
  double slack;  // what the shading normals' lean over the geometric ones costs in distance [m]
};

// phi + r is the distance to the surface: the contact lies on it (a sample is as near as the samples are dense), and no
// sample is nearer to the centre by more than the normals' lean costs, h (1 - cos lean).
TEST(SurfaceOracle, NoSampleOfTheSurfaceIsNearer) {
  for (const OracleCase& c : {OracleCase{icosphere(0.02, 2), 2e-6},
                              {torus(0.03, 0.012, 24, 12), 20e-6},
                              {cylinderWithFlat(0.025, 0.03, 0.018, 20, 6), 2e-6},
                              {box({0.02, 0.015, 0.03}), 1e-9},
                              {roundedCube(0.02, 0.004, 3), 20e-6}}) {
    const std::vector<Vec3> samples = samplePatches(SurfaceNet(c.mesh, 0.7, true));
    const auto object = SmoothMesh::build(c.mesh);
    RandomNumbers random(7);
    SurfaceTracker tracker;
    for (int i = 0; i < 300; ++i) {
      const Vec3 C = random.uniform(0.045, 0.065) * direction(random);
      const SurfaceContact contact = touch(*object, C, 0.004, tracker);
      double nearest = std::numeric_limits<double>::infinity(), beside = nearest;
      for (const Vec3& p : samples) {
        nearest = std::min(nearest, (C - p).norm());
        beside = std::min(beside, (contact.p_BS - p).norm());
      }
      ASSERT_LT(contact.phi + 0.004, nearest + c.slack) << c.mesh.source << ' ' << C.transpose();
      ASSERT_LT(beside, 0.064 / kSamples) << c.mesh.source;  // the longest edge is a box's diagonal
    }
  }
}

TEST(SurfaceOracle, AFreshSearchAgreesWithAFollowedContact) {
  const auto object = SmoothMesh::build(cylinderWithFlat(0.025, 0.03, 0.018, 20, 6));
  RandomNumbers random(11);
  SurfaceTracker followed;
  Vec3 C(0.04, 0, 0), v = Vec3::Zero();
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    v = 0.99 * v + 1e-5 * direction(random);
    C += v;
    if (C.norm() > 0.06) v -= 1e-4 * C.normalized();
    const SurfaceContact c = touch(*object, C, 0.008, followed);
    if (c.phi < 0) {
      C += 0.004 * c.n_B;  // bounced off
      v.setZero();
      continue;
    }
    SurfaceTracker fresh;
    ++compared;
    ASSERT_NEAR(touch(*object, C, 0.008, fresh).phi, c.phi, 1e-8);  // both solved to 1e-9 m
  }
  EXPECT_GE(compared, 15'000);  // 19,991 today: the rest bounces off
}

std::filesystem::path realMesh(const std::string& name) {
  return std::filesystem::path(PINCER_SOURCE_DIR).parent_path() / "shared" / "data" / "meshes" / (name + ".obj");
}

// Scaled to a hand's 80 mm, the origin in the middle.
TriangleMesh handSized(TriangleMesh mesh) {
  const MeshReport report = inspect(mesh);
  const double scale = 0.08 / (report.box_max - report.box_min).maxCoeff();
  for (Vec3& v : mesh.vertices) v = scale * (v - 0.5 * (report.box_min + report.box_max));
  return mesh;
}

struct RealMesh {
  const char* name;
  int triangles, boundary_edges, nonmanifold_edges, nonmanifold_vertices, components;
};

class RealMeshes : public testing::TestWithParam<RealMesh> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(realMesh(GetParam().name)))
      GTEST_SKIP() << "the shared meshes aren't beside this checkout";
  }
};

TEST_P(RealMeshes, AreReadAndJudged) {
  const RealMesh& expected = GetParam();
  const TriangleMesh mesh = readMesh(realMesh(expected.name));
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.triangles, expected.triangles);
  EXPECT_EQ(report.boundary_edges, expected.boundary_edges);
  EXPECT_EQ(report.nonmanifold_edges, expected.nonmanifold_edges);
  EXPECT_EQ(report.nonmanifold_vertices, expected.nonmanifold_vertices);
  EXPECT_EQ(report.components, expected.components);
  if (expected.boundary_edges + expected.nonmanifold_edges == 0) {
    EXPECT_NO_THROW(requireClosed(mesh));
  } else {
    EXPECT_THROW(requireClosed(mesh), InputError);
  }
}

// A finger dragged over the surface for 10 s at 100 mm/s, pressed 1 mm into whatever it follows, also where it doesn't
// fit. Solver failures that reach the caller: none in most runs, at most 2 in 1000 on the bunny, whose scanned noise
// the finger touches at up to three places at once (a contact is held for such a tick).
TEST_P(RealMeshes, AreTouchedWithoutFailure) {
  const RealMesh& mesh = GetParam();
  if (mesh.nonmanifold_edges + mesh.nonmanifold_vertices > 0) {
    EXPECT_THROW(SmoothMesh::build(readMesh(realMesh(mesh.name))), InputError);
    return;
  }
  const double r = 0.008;
  const auto object = SmoothMesh::build(handSized(readMesh(realMesh(mesh.name))));
  RandomNumbers random(3);
  SurfaceTracker tracker;
  Vec3 C(0.08, 0.01, 0.02), along(0, 1, 0);
  SurfaceContact c = touch(*object, C, r, tracker);
  C = c.p_BS + (r - 0.001) * c.n_B;
  int held = 0;
  const int ticks = 10000;
  for (int i = 0; i < ticks; ++i) {
    along += 0.04 * direction(random);
    along = (along - along.dot(c.n_B) * c.n_B).normalized();
    C += 1e-4 * along + std::clamp(-0.001 - c.phi, -2e-4, 2e-4) * c.n_B;
    c = touch(*object, C, r, tracker);
    held += (tracker.status & kQueryHeldDirection) != 0;
    ASSERT_TRUE(c.n_B.allFinite() && c.p_BS.allFinite() && std::isfinite(c.phi)) << i;
    // The centre lies on the normal over the place, at the gap; a contact that came or went
    // in overlap is answered with a larger one.
    const Vec3 miss = C - c.p_BS - (c.phi + r) * c.n_B;
    const double ease = (tracker.status & kQueryEased) != 0 ? -miss.dot(c.n_B) : 0;
    ASSERT_LT((miss + ease * c.n_B).norm(), 1e-14) << i;
    ASSERT_GE(ease, -1e-14) << i;
  }
  EXPECT_LE(held, ticks / 500);
}

INSTANTIATE_TEST_SUITE_P(Collection, RealMeshes,
                         testing::Values(RealMesh{"fandisk", 12946, 0, 0, 0, 1},
                                         RealMesh{"rocker-arm", 20088, 0, 0, 0, 1}, RealMesh{"spot", 5856, 0, 0, 0, 1},
                                         RealMesh{"stanford-bunny", 69451, 223, 0, 0, 1},
                                         RealMesh{"suzanne", 968, 42, 1, 0, 3},
                                         RealMesh{"teapot", 6320, 1036, 0, 38, 19}),
                         [](const auto& mesh) {
                           std::string name = mesh.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace pincer::contact
