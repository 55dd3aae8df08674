// Never late: a finger that is led from outside is told of every place that faces it within the margin, by brute force.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/notched_blocks.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/shell_oracle.h"

namespace pincer::contact {
namespace {

using tests::direction;
using tests::kFinger;
using tests::RandomNumbers;
using tests::ShellOracle;
using tests::ShellSolution;

constexpr double kNear = 0.001;  // margin [m]

// True if the solution moves with the centre, not against it: a minimum of the distance along the surface.
bool isStableAt(const ShellOracle& oracle, const Vec3& C, const ShellSolution& s) {
  constexpr double kWay = 1e-7;  // [m]
  const Vec3 t1 = s.n.unitOrthogonal(), t2 = s.n.cross(t1);
  Eigen::Matrix2d J;
  for (int k = 0; k < 2; ++k) {
    double nearest = 1e-4;  // [m]: further it is another one
    Vec3 moved = s.S;
    for (const ShellSolution& other : oracle.faceSolutions(C + kWay * (k == 0 ? t1 : t2))) {
      if ((other.S - s.S).norm() >= nearest) continue;
      nearest = (other.S - s.S).norm();
      moved = other.S;
    }
    J.col(k) = Eigen::Vector2d((moved - s.S).dot(t1), (moved - s.S).dot(t2)) / kWay;
  }
  return J.determinant() > 0 && J.trace() > 0;
}

// True if a flat triangle lies between the two.
bool isHidden(const TriangleMesh& mesh, const Vec3& a, const Vec3& b) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    const auto corner = [&](std::size_t i) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    Mat3 A;
    A << corner(1) - corner(0), corner(2) - corner(0), a - b;
    const Vec3 x = A.partialPivLu().solve(a - corner(0));
    return x[0] >= 0 && x[1] >= 0 && x[0] + x[1] <= 1 && x[2] >= 0 && x[2] <= 1;
  });
}

struct Missed {
  int judged = 0, with_several = 0, missed = 0;
  std::string first;
};

class Led {
 public:
  explicit Led(const TriangleMesh& mesh) : mesh_(mesh), oracle_(mesh), object_(SmoothMesh::build(mesh)) {}

  // Wanders about `home` by `step` [m] per query, pushed out of what it overlaps. Every 15th query is judged, by
  // as many of its contacts as are `counted`.
  Missed wander(const Vec3& home, int queries, double step, int counted = kMaxSurfaceContacts) {
    constexpr int kEach = 15;
    Vec3 C = home;
    RandomNumbers random(4);
    Vec3 heading = direction(random);
    Missed missed;
    for (int i = 0; i < queries; ++i) {
      const SurfaceContacts found = object_->querySphere(C, kFinger, kNear, tracker_, cache_);
      if (i % kEach == 0) judge(C, found, std::min(found.count, counted), missed);
      heading = (heading + 0.3 * direction(random) - 0.1 * (C - home) / kFinger).normalized();
      C += step * heading;
      for (int k = 0; k < found.count; ++k) {
        const SurfaceContact& c = found.points[static_cast<std::size_t>(k)];
        const double phi = (C - c.p_BS).dot(c.n_B) - kFinger;
        if (phi < 0) C -= phi * c.n_B;
      }
    }
    return missed;
  }

 private:
  void judge(const Vec3& C, const SurfaceContacts& found, int counted, Missed& missed) const {
    constexpr double kSame = 0.998;  // cosine of 3.6 degrees: contacts are one up to there
    constexpr double kSlack = 1e-6;  // [m] at the margin's end
    constexpr double kShort = 0.95;  // of the way to a place
    ++missed.judged;
    missed.with_several += found.count > 1;
    if (found.count == kMaxSurfaceContacts) return;  // more are left out
    for (const ShellSolution& s : oracle_.faceSolutions(C)) {
      if (!(s.h > 0 && s.h < kFinger + kNear - kSlack)) continue;
      const auto* const end = found.points.data() + counted;
      const bool is_told =
          std::any_of(found.points.data(), end, [&](const SurfaceContact& c) { return c.n_B.dot(s.n) > kSame; });
      if (is_told || !isStableAt(oracle_, C, s) || isHidden(mesh_, C, C + kShort * (s.S - C))) continue;
      ++missed.missed;
      if (missed.first.empty()) missed.first = ::testing::PrintToString(C.transpose()) + " h " + std::to_string(s.h);
    }
  }

  const TriangleMesh mesh_;
  const ShellOracle oracle_;
  std::shared_ptr<const SmoothMesh> object_;
  SurfaceTracker tracker_;
  PatchCache cache_;
};

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

// Steps from 2 mm/s to 1 m/s at 1 kHz.
TEST(SurfaceLookout, TellsALedFingerOfEveryPlaceInTime) {
  for (const Case& c : hollows()) {
    int with_several = 0;
    for (const double step : {2e-6, 3e-5, 2e-4, 1e-3}) {
      const Missed missed = Led(c.mesh).wander(c.home, tests::draws(450, 40), step);
      with_several += missed.with_several;
      EXPECT_EQ(missed.missed, 0) << c.mesh.source << ", steps of " << step << ": " << missed.first;
    }
    EXPECT_GT(with_several, 0) << c.mesh.source;
  }
}

TEST(SurfaceLookout, ItsJudgeSeesAPlaceThatIsLeftOut) {
  const Case groove = hollows().front();
  const Missed missed = Led(groove.mesh).wander(groove.home, 450, 2e-4, 1);
  EXPECT_GT(missed.with_several, 0);
  EXPECT_EQ(missed.missed, missed.with_several) << "each has one more face that the finger touches";
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
