// Never late: a finger that is led from outside is told of every place that faces it within the margin, by brute force.
#include <gtest/gtest.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/notched_blocks.h"
#include "pincer/tests/support/place_judge.h"

namespace pincer::contact {
namespace {

using tests::kFinger;
using tests::LedFinger;
using tests::PlaceJudge;
using tests::PlaceVerdicts;

constexpr double kNear = 0.001;  // margin [m]

struct Case {
  TriangleMesh mesh;
  Vec3 home;
};

std::vector<Case> hollows() {
  return {{grooveBlock(M_PI / 4, 0.02, 0.04, 0.04), {0, 0, 0.012}},
          {noisy(grooveBlock(M_PI / 3, 0.01, 0.03, 0.03), 2e-5, 2), {0, 0, 0.01}},
          {tests::cornerBlock(0.03), {0.009, 0.009, 0.009}},
          {tests::pitBlock(0.02), {0.001, 0.001, 0.001}}};
}

PlaceVerdicts wander(const Case& c, const LedFinger& finger, int queries) {
  tests::RandomNumbers random(4);
  PlaceVerdicts verdicts;
  PlaceJudge(c.mesh).wander(finger, c.home, queries, random, verdicts);
  return verdicts;
}

// Steps from 2 mm/s to 1 m/s at 1 kHz.
TEST(SurfaceLookout, TellsALedFingerOfEveryPlaceInTime) {
  for (const Case& c : hollows()) {
    int several = 0;
    for (const double step : {2e-6, 3e-5, 2e-4, 1e-3}) {
      const PlaceVerdicts v = wander(c, {kFinger, kNear, step}, tests::draws(450, 40));
      several += v.several;
      EXPECT_EQ(v.missed + v.extra, 0) << c.mesh.source << ", steps of " << step << ": " << v.first;
      EXPECT_LT(v.off_place, 1e-8);  // a residual of 1e-9 m, in hollows
      EXPECT_LT(v.off_gap, 1e-9);
    }
    EXPECT_GT(several, 0) << c.mesh.source;
  }
}

TEST(SurfaceLookout, ItsJudgeSeesAPlaceThatIsLeftOut) {
  LedFinger finger{kFinger, kNear, 2e-4};
  finger.counted = 1;
  const PlaceVerdicts v = wander(hollows().front(), finger, 450);
  EXPECT_GT(v.several, 0);
  EXPECT_GE(v.missed, v.several) << "each has one more face that the finger touches";
}

// The block's top is on both sides of a groove of 3 mm, so its normal is like that of the contact with either edge: who
// takes an edge for the contact that its one side is beside misses it.
TEST(SurfaceLookout, TellsOfBothEdgesOfANarrowGroove) {
  constexpr double kEdge = 0.0015;  // [m]: half the groove's width, and its depth
  const auto block = SmoothMesh::build(grooveBlock(M_PI / 4, kEdge, 0.03, 0.03));
  for (const double step : {3e-5, 1e-4, 2e-4}) {
    for (const double y : {-0.021, 0.002, 0.013}) {
      SurfaceTracker tracker;
      PatchCache cache;
      int both = 0;
      for (double x = -0.004; x < 0.004; x += step) {
        const Vec3 C(x, y, kEdge + 0.0079);
        const SurfaceContacts found = block->querySphere(C, kFinger, kNear, tracker, cache);
        if (std::abs(x) > kEdge - 1e-6) continue;  // over one side of the top
        ++both;
        ASSERT_EQ(found.count, 2) << x << " step " << step;
        for (int k = 0; k < 2; ++k) {
          const SurfaceContact& c = found.points[static_cast<std::size_t>(k)];
          const Vec3 E(c.p_BS.x() < 0 ? -kEdge : kEdge, y, kEdge);
          EXPECT_LE((c.p_BS - E).norm(), 1e-12);
          EXPECT_NEAR(c.phi, (C - E).norm() - kFinger, 1e-12);
        }
      }
      EXPECT_GE(both, 14);
    }
  }
}

struct LedTogether {
  std::vector<double> phi;
  int looks = 0;
};

// Six fingers that share a cache are led over a plate's edge by turns, each with every `stride`-th of many trackers.
LedTogether ledTogether(std::size_t stride) {
  constexpr std::size_t kFingers = 6;
  const auto object = SmoothMesh::build(gridBox({0.03, 0.02, 0.0005}, 12));
  std::vector<SurfaceTracker> trackers(kFingers * stride);
  PatchCache cache;
  LedTogether led;
  for (int i = 0; i < 200; ++i) {
    for (std::size_t k = 0; k < kFingers; ++k) {
      SurfaceTracker& tracker = trackers[k * stride];
      tracker.memory = static_cast<std::uint32_t>(k);
      const Vec3 C(0.02 + 1e-4 * i, 0.003 * static_cast<double>(k), kFinger + 0.0006 - 1e-5 * static_cast<double>(k));
      const SurfaceContacts found = object->querySphere(C, kFinger, kNear, tracker, cache);
      led.phi.push_back(found.main().phi);
      led.looks += found.cost.looks;
    }
  }
  return led;
}

// The memory of what is near was found by the tracker's address: who shared one looked around in every query.
TEST(SurfaceLookout, WhereTrackersLieChangesNeitherAnswersNorCosts) {
  const LedTogether beside = ledTogether(1), apart = ledTogether(31);
  EXPECT_EQ(beside.phi, apart.phi);
  EXPECT_EQ(beside.looks, apart.looks);
  EXPECT_GT(beside.looks, 6);
  EXPECT_LT(beside.looks, 400);  // of 1,200 queries
}

}  // namespace
}  // namespace pincer::contact
