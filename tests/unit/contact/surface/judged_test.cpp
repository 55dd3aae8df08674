// Every answer of the query judged by brute force (tests/support/shell_oracle.h), on tame meshes and on hostile ones.
#include <gtest/gtest.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/shell_oracle.h"

namespace pincer::contact {
namespace {

using tests::direction;
using tests::kFinger;
using tests::RandomNumbers;
using tests::ShellOracle;

int budget(int queries) { return tests::draws(queries, 50); }

struct Verdicts {
  int queries = 0, held = 0, touching = 0, wrong = 0;
  std::string first_complaint;
};

void judge(const ShellOracle& oracle, const Vec3& C, double r, const SurfaceContacts& answer, Verdicts& verdicts) {
  ++verdicts.queries;
  verdicts.held += answer.cost.held > 0;
  if (answer.cost.held > 0) return;
  verdicts.touching += answer.count > 0;
  for (int i = 0; i < answer.count; ++i) {
    const std::string complaint = oracle.complaint(C, r, answer.points[static_cast<std::size_t>(i)]);
    if (complaint.empty()) continue;
    ++verdicts.wrong;
    if (verdicts.first_complaint.empty()) {
      verdicts.first_complaint =
          ::testing::PrintToString(C.transpose()) + " contact " + std::to_string(i) + ": " + complaint;
    }
  }
}

// A finger that comes down somewhere and strokes for 40 ticks of 1 to 200 um, 0 to 5 mm deep, again
// and again; everything in units of `scale`.
Verdicts strokes(const TriangleMesh& mesh, double scale, int queries, std::uint64_t seed) {
  const ShellOracle oracle(mesh);
  const auto object = SmoothMesh::build(mesh);
  RandomNumbers random(seed);
  PatchCache cache;
  SurfaceTracker tracker;
  Verdicts verdicts;
  const double r = kFinger * scale;
  Vec3 C = Vec3::Zero(), heading = Vec3::UnitX();
  for (int i = 0; i < queries; ++i) {
    if (i % 40 == 0) {
      tracker = {};
      C = object->boundingRadius() * random.uniform(1.2, 2) * direction(random);
      const SurfaceContact c = object->querySphere(C, r, 0, tracker, cache).main();
      C = c.p_BS + (r - random.uniform(0, 0.005) * scale) * c.n_B;
      heading = direction(random);
    }
    const SurfaceContacts answer = object->querySphere(C, r, 0.001 * scale, tracker, cache);
    judge(oracle, C, r, answer, verdicts);
    const Vec3 n = answer.main().n_B;
    heading = (heading + 0.2 * direction(random)).normalized();
    C += random.uniform(1e-6, 2e-4) * scale * (heading - heading.dot(n) * n).normalized();
  }
  return verdicts;
}

void expectAllRight(const TriangleMesh& mesh, double scale = 1) {
  const Verdicts verdicts = strokes(mesh, scale, budget(200), 1);
  EXPECT_EQ(verdicts.held, 0) << mesh.source;
  EXPECT_GT(verdicts.touching, 0.9 * verdicts.queries) << mesh.source;
  EXPECT_EQ(verdicts.wrong, 0) << mesh.source << " x" << scale << ": " << verdicts.first_complaint;
}

TEST(SurfaceJudged, TheOracleSeesWhatIsWrong) {
  const TriangleMesh mesh = icosphere(0.02, 1);
  const ShellOracle oracle(mesh);
  const auto object = SmoothMesh::build(mesh);
  PatchCache cache;
  SurfaceTracker tracker;
  const Vec3 C(0.003, 0.005, 0.026);
  const SurfaceContact right = object->querySphere(C, kFinger, 0, tracker, cache).main();
  EXPECT_EQ(oracle.complaint(C, kFinger, right), "");
  SurfaceContact leaning = right;
  leaning.n_B = (right.n_B + 1e-4 * right.n_B.cross(Vec3::UnitX())).normalized();
  EXPECT_NE(oracle.complaint(C, kFinger, leaning), "") << "the centre is beside the normal";
  leaning.p_BS = C - (leaning.phi + kFinger) * leaning.n_B;
  EXPECT_NE(oracle.complaint(C, kFinger, leaning), "") << "the normal isn't the surface's";
  SurfaceContact shallow = right;
  shallow.phi += 1e-6;
  shallow.p_BS = C - (shallow.phi + kFinger) * shallow.n_B;
  EXPECT_NE(oracle.complaint(C, kFinger, shallow), "") << "the place isn't on the surface";
  SurfaceContact facet = right;
  facet.n_B = Vec3::UnitZ();
  facet.p_BS = C - (facet.phi + kFinger) * facet.n_B;
  EXPECT_NE(oracle.complaint(C, kFinger, facet), "");
}

TEST(SurfaceJudged, SmoothMeshes) {
  expectAllRight(icosphere(0.02, 1));
  expectAllRight(torus(0.03, 0.012, 16, 10));
  expectAllRight(ellipsoid({0.03, 0.02, 0.015}, 4));
  expectAllRight(bumpySphere(0.03, 0.02, 4, 5));
  expectAllRight(roundedCube(0.02, 0.005, 2));
}

TEST(SurfaceJudged, EdgesAndCorners) {
  expectAllRight(box({0.02, 0.015, 0.03}));
  expectAllRight(cylinderWithFlat(0.025, 0.03, 0.018, 14, 2));
  expectAllRight(cylinder(0.02, 0.02, 12, 1));
  expectAllRight(gridBox({0.03, 0.02, 0.0005}, 3));
  expectAllRight(grooveBlock(M_PI / 4, 0.012, 0.03, 0.03));
}

// Needles and a vertex of 60 triangles; slivers of 1 : 40.
TEST(SurfaceJudged, NeedlesFansAndSlivers) {
  expectAllRight(uvSphere(0.02, 5, 60));
  expectAllRight(cylinder(0.02, 0.06, 60, 1));
}

TEST(SurfaceJudged, AThousandTimesAsLargeAndAsSmall) {
  expectAllRight(icosphere(20, 1), 1e3);
  expectAllRight(cylinderWithFlat(25, 30, 18, 14, 2), 1e3);
  expectAllRight(icosphere(2e-5, 1), 1e-3);
  expectAllRight(cylinderWithFlat(2.5e-5, 3e-5, 1.8e-5, 14, 2), 1e-3);
}

// Where neighbouring normals differ by tens of degrees there may be no answer; there may not be a wrong one.
TEST(SurfaceJudged, RoughAndFoldedMeshes) {
  for (const TriangleMesh& mesh :
       {noisy(icosphere(0.02, 2), 5e-4, 1), noisy(icosphere(0.02, 1), 2e-3, 2), bumpySphere(0.03, 0.15, 9, 4)}) {
    const Verdicts verdicts = strokes(mesh, 1, budget(200), 2);
    EXPECT_EQ(verdicts.wrong, 0) << mesh.source << ": " << verdicts.first_complaint;
    EXPECT_LE(verdicts.held, verdicts.queries / 50) << mesh.source;
  }
}

// A finger that comes from nowhere is given the nearest place.
TEST(SurfaceJudged, InTheAirNothingIsNearer) {
  // [m] what the normals' lean over the geometric ones costs in distance, on meshes as coarse as these
  constexpr double kLean = 1e-4;
  for (const TriangleMesh& mesh :
       {icosphere(0.02, 1), torus(0.03, 0.012, 16, 10), cylinderWithFlat(0.025, 0.03, 0.018, 14, 2),
        noisy(icosphere(0.02, 1), 1e-3, 2), grooveBlock(M_PI / 4, 0.012, 0.03, 0.03)}) {
    const ShellOracle oracle(mesh);
    const auto object = SmoothMesh::build(mesh);
    RandomNumbers random(3);
    PatchCache cache;
    for (int i = 0; i < budget(100); ++i) {
      SurfaceTracker tracker;
      const Vec3 C = random.uniform(1.3, 2.5) * object->boundingRadius() * direction(random);
      const SurfaceContact c = object->querySphere(C, 0.002, 0, tracker, cache).main();
      ASSERT_NEAR(c.phi + 0.002, oracle.distance(C), kLean) << mesh.source << ' ' << C.transpose();
    }
  }
}

}  // namespace
}  // namespace pincer::contact
