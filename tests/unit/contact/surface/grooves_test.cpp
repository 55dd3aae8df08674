// Grooves, corners, pits and holes: the sum of the contacts' pushes and its direction move no faster than the finger
// does, however contacts come, go and meet.
//
//   f = sum max(-phi_i, 0) n_i,  the push per stiffness [m];  its place on the pad turns with f / |f|
#include <gtest/gtest.h>

#include <functional>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/notched_blocks.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::kFinger;
using tests::kMargin;
using tests::RandomNumbers;

constexpr double kMicrometre = 1e-6;  // [m]

Vec3 pushOf(const SurfaceContacts& contacts) {
  Vec3 f = Vec3::Zero();
  for (int i = 0; i < contacts.count; ++i) {
    const SurfaceContact& c = contacts.points[static_cast<std::size_t>(i)];
    f += std::max(-c.phi, 0.0) * c.n_B;
  }
  return f;
}

struct Tip {
  explicit Tip(const TriangleMesh& mesh) : surface(SmoothMesh::build(mesh)) {}
  SurfaceContacts at(const Vec3& C, double margin = kMargin) {
    return surface->querySphere(C, kFinger, margin, tracker, cache);
  }

  std::shared_ptr<const SmoothMesh> surface;
  SurfaceTracker tracker;
  PatchCache cache;
};

struct Steadiness {
  double push = 0;   // largest change of f per way of the centre [-]
  double place = 0;  // and of f's direction, times the finger's radius and |f| over the way [m]: |f| d(place) / d(way)
  int most = 0;      // contacts that overlap
  std::uint32_t status = 0;
};

Steadiness strokeAlong(const TriangleMesh& mesh, double way, const std::function<Vec3(double)>& path) {
  Tip tip(mesh);
  Steadiness felt;
  Vec3 C0 = path(0), f0 = Vec3::Zero();
  for (int i = 0; i * kMicrometre <= way; ++i) {
    const Vec3 C = path(i * kMicrometre);
    const SurfaceContacts contacts = tip.at(C);
    const Vec3 f = pushOf(contacts);
    if (i > 0) {
      const double moved = (C - C0).norm();
      felt.push = std::max(felt.push, (f - f0).norm() / moved);
      if (f.norm() > kMicrometre && f0.norm() > kMicrometre)
        felt.place = std::max(felt.place, kFinger * f.norm() * (f.normalized() - f0.normalized()).norm() / moved);
    }
    int overlaps = 0;
    for (int k = 0; k < contacts.count; ++k) overlaps += contacts.points[static_cast<std::size_t>(k)].phi < 0;
    felt.most = std::max(felt.most, overlaps);
    felt.status |= tip.tracker.status;
    C0 = C;
    f0 = f;
  }
  return felt;
}

// Walls at right angles: f's derivative is sum n n^T, whose largest eigenvalue is
// 1. Place moves by r / |f| of what f does.
constexpr double kRightAngle = 1 + 1e-6;

TEST(SurfaceGrooves, AcrossAGrooveOfRightAngles) {
  const double rest = std::sqrt(2.0) * kFinger;
  for (const double depth : {0.0005, 0.004}) {
    const Steadiness felt = strokeAlong(grooveBlock(M_PI / 4, 0.02, 0.04, 0.04), 0.016,
                                        [&](double s) { return Vec3(-0.008 + s, 0.001 + 0.1 * s, rest - depth); });
    EXPECT_LT(felt.push, kRightAngle) << depth;
    EXPECT_LT(felt.place, kFinger * kRightAngle) << depth;
    EXPECT_EQ(felt.most, 2);
    EXPECT_EQ(felt.status, kQueryOk);
  }
}

// The place on the pad in the middle of the groove, 4 mm deep: r / (2 depth / sqrt 2 * sqrt 2)
// um per um; contact.md's 2.2 is its figure.
TEST(SurfaceGrooves, ThePlaceOnThePadMovesByTwoMicrometresPerMicrometre) {
  Tip tip(grooveBlock(M_PI / 4, 0.02, 0.04, 0.04));
  const double rest = std::sqrt(2.0) * kFinger;
  Vec3 last = Vec3::Zero();
  double largest = 0;
  for (int i = -1000; i <= 1000; ++i) {
    const Vec3 n = pushOf(tip.at({i * kMicrometre, 0.001, rest - 0.004})).normalized();
    if (i > -1000) largest = std::max(largest, kFinger * (n - last).norm());
    last = n;
  }
  EXPECT_LT(largest, 2.2 * kMicrometre);
  EXPECT_GT(largest, 1.9 * kMicrometre);
}

// Walls that meet at an angle g: the derivative's largest eigenvalue is 1 + cos(angle between the normals).
TEST(SurfaceGrooves, SharpAndWideGrooves) {
  for (const double half_angle : {M_PI / 6, M_PI / 3}) {
    const double rest = kFinger / std::sin(half_angle);
    const double steepest = 1 + std::abs(std::cos(2 * half_angle)) + 1e-6;
    const Steadiness felt = strokeAlong(grooveBlock(half_angle, 0.02, 0.06, 0.04), 0.002, [&](double s) {
      return Vec3(-0.001 + s, 0.001 + 0.1 * s, rest - 0.0008 + 0.2 * s);
    });
    EXPECT_LT(felt.push, steepest) << half_angle;
    EXPECT_EQ(felt.most, 2);
    EXPECT_EQ(felt.status, kQueryOk);
  }
}

// Walls of unequal size and slope, from the one onto the other, over the short one's upper edge and back.
TEST(SurfaceGrooves, AVWithUnequalSides) {
  Mat3 short_wall = Mat3::Identity(), slanting = Mat3::Identity();
  short_wall(2, 2) = 0.3;
  slanting(0, 2) = 0.3;
  slanting(2, 0) = -0.1;
  const Steadiness high = strokeAlong(tests::mapped(tests::stepBlock(0.04), short_wall), 0.02,
                                      [](double s) { return Vec3(0.0079 - 0.9 * s, 0.001, 0.0075 + 1.1 * s); });
  EXPECT_LT(high.push, 1.5) << "over the edge f turns by depth / height of the way: at most 0.5 here";
  EXPECT_EQ(high.most, 2);
  const Steadiness slant = strokeAlong(tests::mapped(tests::stepBlock(0.04), slanting), 0.012,
                                       [](double s) { return Vec3(0.0095 - 0.3 * s, 0.001 + 0.1 * s, 0.018 - s); });
  EXPECT_LT(slant.push, 1.6);
  EXPECT_EQ(slant.most, 2);
  EXPECT_EQ((high.status | slant.status), kQueryOk);
}

TEST(SurfaceGrooves, IntoACornerOfThreeWallsAndAlongThem) {
  const TriangleMesh corner = tests::cornerBlock(0.03);
  const Steadiness in =
      strokeAlong(corner, 0.013, [](double s) { return Vec3(0.0152 - 0.8 * s, 0.0151 - 0.7 * s, 0.0149 - 0.75 * s); });
  EXPECT_LT(in.push, kRightAngle);
  EXPECT_EQ(in.most, 3);
  const Steadiness along_it =
      strokeAlong(corner, 0.012, [](double s) { return Vec3(0.003 + s, 0.0155 - s, 0.0055 + 0.3 * s); });
  EXPECT_LT(along_it.push, kRightAngle);
  EXPECT_LT(along_it.place, kFinger * kRightAngle);
  EXPECT_EQ((in.status | along_it.status), kQueryOk);
}

TEST(SurfaceGrooves, IntoAPitAndAroundInIt) {
  const TriangleMesh pit = tests::pitBlock(0.02);
  const Steadiness in =
      strokeAlong(pit, 0.0225, [](double s) { return Vec3(0.0004 + 0.1 * s, 0.0007 + 0.1 * s, 0.03 + kFinger - s); });
  EXPECT_LT(in.push, kRightAngle + 0.6) << "the pit's rim comes first: 1 + depth / height";
  const Steadiness around = strokeAlong(
      pit, 0.02, [](double s) { return Vec3(0.004 * std::cos(300 * s), 0.004 * std::sin(300 * s), 0.0165); });
  EXPECT_LT(around.push, kRightAngle);
  EXPECT_EQ(around.most, 3);
  EXPECT_EQ((in.status | around.status), kQueryOk);
}

// In a hole of radius rho the contact turns around the finger by h / (rho - h) of its way:
// 1 contact, 4 at the most with rho 10 mm.
TEST(SurfaceGrooves, AroundInATorusHole) {
  for (const double hole : {0.018, 0.010}) {
    const double off = hole - kFinger + 0.0005, depth = 0.0005 + 1e-5;
    const Steadiness felt = strokeAlong(torus(hole + 0.012, 0.012, 48, 24), 0.02, [&](double s) {
      return Vec3(off * std::cos(s / off), off * std::sin(s / off), 0.001 * std::sin(200 * s));
    });
    EXPECT_LT(felt.push, 1.1 * depth / off + 0.1) << hole;
    EXPECT_EQ(felt.most, 1);
    EXPECT_EQ(felt.status, kQueryOk);
  }
}

// Where the finger doesn't fit there are folds: contacts come, go and swap while they overlap. What comes and goes is
// eased, by as much per micrometre as the finger moves; up to three contacts and what they replace.
TEST(SurfaceGrooves, ContactsThatComeAndGoInOverlapAreEased) {
  for (const TriangleMesh& mesh :
       {torus(0.02, 0.012, 48, 24), bumpySphere(0.03, 0.06, 9, 24), tests::pitBlock(0.015),
        noisy(icosphere(0.02, 2), 5e-4, 1), tests::mapped(tests::stepBlock(0.04), 0.5 * Mat3::Identity())}) {
    Tip tip(mesh);
    RandomNumbers random(5);
    SurfaceContacts last = tip.at({0.003, 0.004, 0.05});
    Vec3 C = last.main().p_BS + (kFinger - 1e-5) * last.main().n_B, v = Vec3::Zero(), f0 = Vec3::Zero();
    last = tip.at(C);
    f0 = pushOf(last);
    for (int i = 0; i < 20000; ++i) {
      v = 0.98 * v + 0.2 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} -
          0.01 * C / C.norm();
      Vec3 move = v;
      for (int k = 0; k < last.count; ++k) {
        const SurfaceContact& c = last.points[static_cast<std::size_t>(k)];
        if (c.phi < -5e-4) move += 1.2 * c.n_B;
      }
      const Vec3 step = 2 * kMicrometre * move / std::max(1.0, move.norm());
      C += step;
      last = tip.at(C);
      ASSERT_TRUE(last.count < 2 || last.points[0].feature != last.points[1].feature) << mesh.source << ' ' << i;
      const Vec3 f = pushOf(last);
      ASSERT_LT((f - f0).norm(), 6 * step.norm() + 1e-5 * kFinger) << mesh.source << ' ' << i;
      ASSERT_EQ(last.cost.held, 0) << mesh.source << ' ' << i;
      f0 = f;
    }
  }
}

// Beside the end of a groove, over the corner where the ends of its two walls meet: the contact with one wall's end
// slides to that corner and off it, down to where the finger touches the other's. It once took that one's place, while
// what it was taken for stood on as a lost one: the force doubled in one step, 679 times the finger's way.
TEST(SurfaceGrooves, AContactThatSlidesToWhereAnotherIsLeavesItsPlaceToThatOne) {
  for (const double side : {-1, 1}) {
    const Steadiness felt = strokeAlong(grooveBlock(M_PI / 4, 0.012, 0.03, 0.03), 0.0054,
                                        [&](double s) { return Vec3(side * (s - 0.0026), -0.03732, 0.0026); });
    EXPECT_LT(felt.push, kRightAngle) << "one contact, with an edge that it overlaps by less than its height";
    EXPECT_EQ(felt.status, kQueryOk);
  }
}

// The same where the one that slides off overlaps too: it fades, f changing by n_x for its plane and 1 for
// the ease, while the other stays, an edge's contact at first, whose push turns by its depth over its
// height of the way's part across the edge.
TEST(SurfaceGrooves, TheForceIsSteadyWhereAContactSlidesOffTheEndOfAGroove) {
  const double over_end = 0.00732;
  const Vec3 off_corner = Vec3(0.0013, -over_end, 0.0013).normalized();
  const Steadiness felt = strokeAlong(grooveBlock(M_PI / 4, 0.012, 0.03, 0.03), 0.0027,
                                      [&](double s) { return Vec3(-0.0013 + s, -0.03 - over_end, 0.0013); });
  EXPECT_LT(felt.push, std::hypot(1 + off_corner.x(), (kFinger - over_end) / over_end / std::sqrt(2.0)));
  EXPECT_EQ(felt.status, kQueryEased);
}

// Past the axis of a hole that is too narrow the contact runs around it within micrometres: all three slots fade when
// the next one comes. The shallowest once yielded to it, whole: 8 times the finger's way.
TEST(SurfaceGrooves, ThreeContactsThatFadeMakeRoomForTheNextWithoutAJump) {
  const auto tight = SmoothMesh::build(torus(0.02, 0.015, 48, 32));
  for (const double beside : {1e-5, 3e-5, 1e-4, 3e-4}) {
    SurfaceTracker tracker;
    PatchCache cache;
    Vec3 f0 = Vec3::Zero();
    for (int i = -66; i <= 66; ++i) {
      const Vec3 f = pushOf(tight->querySphere({3e-5 * i, beside, -0.01}, kFinger, kMargin, tracker, cache));
      const double change = i > -66 ? (f - f0).norm() : 0;
      ASSERT_LT(change, 6 * 3e-5) << beside << ' ' << i;  // three planes, each pushed in and eased out
      f0 = f;
    }
  }
}

// Down into a square hole that the finger just fits into, or just not, its centre `beside` the hole's axis: five flat
// faces and four rims, from which the least gap follows by hand.
struct Hole {
  explicit Hole(double play) : half(kFinger + play), top(3 * half), floor(half), tip(tests::pitBlock(2 * half)) {}
  double gapAt(const Vec3& C) const {
    double gap = C.z() - floor - kFinger;
    for (const double wall : {half - C.x(), half + C.x(), half - C.y(), half + C.y()})
      gap = std::min(gap, std::hypot(wall, std::max(0.0, C.z() - top)) - kFinger);
    return gap;
  }
  // Moves down to `lowest`; the largest change of the push over the way.
  double comeDown(const Vec3& beside, double lowest) {
    constexpr double kStep = 1e-5;  // [m]
    double push = 0;
    Vec3 f0 = Vec3::Zero();
    for (double z = top + kFinger + kMargin; z > lowest; z -= kStep) {
      const Vec3 C = beside + Vec3(0, 0, z);
      const SurfaceContacts contacts = tip.at(C);
      // flat faces: to the solver's tolerance
      EXPECT_NEAR(contacts.main().phi, gapAt(C), 1e-9) << "half " << half << " z " << z;
      const Vec3 f = pushOf(contacts);
      push = std::max(push, (f - f0).norm() / kStep);
      f0 = f;
    }
    return push;
  }

  double half, top, floor;
  Tip tip;
};

// Four walls within the margin took all three slots, none of them touched, and the finger went through the floor.
TEST(SurfaceGrooves, AHoleHardlyWiderThanTheFingerHasAFloor) {
  for (const double play : {1e-3, 3e-4, 5e-5, 2e-5}) {
    for (const double aside : {0.0, 0.3, 0.9}) {
      Hole hole(play);
      const double push = hole.comeDown({aside * play, 0.5 * aside * play, 0}, hole.floor + kFinger - 5e-4);
      EXPECT_LT(push, kRightAngle) << play << ' ' << aside;  // the floor alone
      EXPECT_EQ(hole.tip.tracker.status & (kQueryHeldDirection | kQueryReseeded), 0u);
    }
  }
}

// Between the rims, then between the walls: opposite ones take up to twice the way, a rim's
// push turns by its depth over its height.
TEST(SurfaceGrooves, IntoAHoleHardlyNarrowerThanTheFinger) {
  for (const double play : {-1e-6, -5e-5, -3e-4, -1e-3}) {
    for (const Vec3& beside : {Vec3(0, 0, 0), Vec3(2e-5, 1e-5, 0), Vec3(2e-4, 1e-4, 0)}) {
      Hole hole(play);
      const double depth = beside.x() - play;
      EXPECT_LT(hole.comeDown(beside, hole.floor + kFinger), 2 + depth / (kFinger - depth))
          << play << ' ' << beside.x();
    }
  }
}

// The fourth wall is left out, and looked for again once in a while: what the query says must not flicker.
TEST(SurfaceGrooves, OfAFourthWallThatIsTouchedEveryQueryTells) {
  Hole hole(-5e-5);
  int inside = 0;
  for (double z = hole.top + kFinger + kMargin; z > hole.floor + kFinger + 2 * kMargin; z -= 3e-5) {
    hole.tip.at({2e-6, 1e-6, z});
    if (z > hole.top - kMargin) continue;
    ASSERT_TRUE(hole.tip.tracker.status & kQueryContactsDropped) << z;
    ++inside;
  }
  EXPECT_GT(inside, 100);
}

// Beside the axis of that narrow hole of a torus, all three slots lost in one query: of the places tried for another
// contact each took a slot, by joining two that faded, and gave it back when one of them was chosen, so that one push
// was joined twice. 15 times the finger's way here, 68 on a rocker arm.
TEST(SurfaceGrooves, WhatFadesIsCountedOnceWhereAllContactsAreLostAtOnce) {
  const auto tight = SmoothMesh::build(torus(0.02, 0.015, 48, 32));
  const Vec3 step(1.1e-5, -1.3e-6, -3.4e-5);
  int reseeded = 0;
  for (const double beside : {-1e-6, 0.0, 1e-6}) {
    SurfaceTracker tracker;
    PatchCache cache;
    Vec3 f0 = Vec3::Zero();
    for (int i = 0; i < 40; ++i) {
      const Vec3 C = Vec3(2.1783e-5 + beside, -4.8864e-4, 1.0402e-2) + i * step;
      const Vec3 f = pushOf(tight->querySphere(C, kFinger, kMargin, tracker, cache));
      // three planes, each pushed in and eased out
      ASSERT_LT(i > 0 ? (f - f0).norm() : 0, 6 * step.norm()) << beside << ' ' << i;
      reseeded += (tracker.status & kQueryReseeded) != 0;
      f0 = f;
    }
  }
  EXPECT_GT(reseeded, 0) << "none was lost: this tests nothing";
}

// Most queries skip the look for further places, because the last one vouches for
// where the finger is. No answer depends on it.
TEST(SurfaceGrooves, WhatIsSkippedWouldHaveFoundNothing) {
  for (const TriangleMesh& mesh :
       {grooveBlock(M_PI / 3, 0.01, 0.04, 0.04), torus(0.03, 0.012, 48, 24), tests::pitBlock(0.02),
        tests::cornerBlock(0.03), geodesicSphere(0.03, 20), cylinderWithFlat(0.025, 0.03, 0.018, 18, 6)}) {
    Tip skipping(mesh), looking(mesh);
    RandomNumbers random(6);
    Vec3 C = skipping.at({0.003, 0.004, 0.05}).main().p_BS + Vec3(0, 0, kFinger), v = Vec3::Zero();
    looking = skipping;
    int skipped = 0;
    for (int i = 0; i < 5000; ++i) {
      const double margin = i % 2000 < 1000 ? kMargin : 0;
      const SurfaceContacts a = skipping.at(C, margin);
      looking.tracker.look = {};
      const SurfaceContacts b = looking.at(C, margin);
      skipped += skipping.tracker.look.p_BC != C;
      ASSERT_EQ(a.count, b.count) << mesh.source << ' ' << i;
      ASSERT_LT((pushOf(a) - pushOf(b)).norm(), 2e-8) << mesh.source << ' ' << i;
      v = 0.98 * v + 0.2 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} -
          0.01 * C / C.norm();
      Vec3 move = v;
      if (a.main().phi < -5e-4) move += 1.2 * a.main().n_B;
      C += 5e-5 * move / std::max(1.0, move.norm());
    }
    EXPECT_GT(skipped, 100) << mesh.source;
  }
}

bool areSame(const SurfaceLook& a, const SurfaceLook& b) {
  return a.p_BC == b.p_BC && a.reach == b.reach && a.horizon == b.horizon && a.is_alone == b.is_alone && a.n == b.n;
}

bool areSame(const SurfaceContacts& a, const SurfaceContacts& b) {
  bool same = a.count == b.count;
  for (std::size_t i = 0; same && i < static_cast<std::size_t>(a.count); ++i) {
    const SurfaceContact &c = a.points[i], &d = b.points[i];
    same = c.p_BS == d.p_BS && c.n_B == d.n_B && c.phi == d.phi && c.feature == d.feature;
  }
  return same;
}

// Knowledge of a look's parts depends on the way that the finger has come: it is scratch. To the last bit a query
// answers the same with a cache that never saw the finger, and after the finger was set back from another way.
TEST(SurfaceGrooves, AnswersDoNotDependOnWhatTheCacheHolds) {
  int looks = 0;  // that hold a list
  for (const TriangleMesh& mesh :
       {noisy(grooveBlock(M_PI / 3, 0.01, 0.04, 0.04), 2e-5, 2), noisy(geodesicSphere(0.03, 20), 1e-4, 4),
        tests::pitBlock(0.02), cylinderWithFlat(0.025, 0.03, 0.018, 18, 6)}) {
    Tip tip(mesh), elsewhere(mesh);
    RandomNumbers random(3);
    Vec3 C = tip.at({0.003, 0.004, 0.05}).main().p_BS + Vec3(0, 0, kFinger), v = Vec3::Zero();
    elsewhere.tracker = tip.tracker;
    for (int i = 0; i < tests::draws(1500, 20000); ++i) {
      const SurfaceTracker before = tip.tracker;
      for (int k = 0; k < i % 7; ++k)
        tip.at(C + 1e-4 * k * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
      tip.tracker = before;
      const SurfaceContacts a = tip.at(C);
      if (i % 5 == 0) elsewhere.cache = PatchCache();
      const SurfaceContacts b = elsewhere.at(C);
      ASSERT_TRUE(areSame(a, b)) << mesh.source << ' ' << i;
      ASSERT_TRUE(areSame(tip.tracker.look, elsewhere.tracker.look)) << i;
      ASSERT_EQ(tip.tracker.turn, elsewhere.tracker.turn) << i;
      looks += !tip.tracker.look.is_alone && tip.tracker.look.p_BC != before.look.p_BC;
      v = 0.98 * v + 0.2 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} -
          0.01 * C / C.norm();
      Vec3 move = v;
      if (a.main().phi < -5e-4) move += 1.2 * a.main().n_B;
      C += 1e-4 * move / std::max(1.0, move.norm());
    }
  }
  EXPECT_GT(looks, 50);
}

// Around a torus' tube in the plane of a row of edges: where the tube turns from convex to saddle the
// walk once stayed at a vertex of that row, for each face beside it saw the way out, along the edge
// between them, by round-off in the other.
TEST(SurfaceGrooves, AWayAlongARowOfEdgesIsFollowedThroughASaddle) {
  constexpr double kTube = 0.012, kDepth = 0.002;
  Tip tip(torus(0.03, kTube, 24, 12));
  double longest_step = 0;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 1200; ++i) {
    const double a = 0.0056 * i;
    const SurfaceContacts found =
        tip.at(Vec3(0.03, 0, 0) + (kTube + kFinger - kDepth) * Vec3(std::cos(a), 0, std::sin(a)));
    ASSERT_EQ(found.count, 1) << i;
    ASSERT_EQ(tip.tracker.status, 0u) << i;
    ASSERT_NEAR(found.main().phi, -kDepth, 3e-5) << i;  // segments of 30 degrees leave the torus by 20 um
    if (i > 0) longest_step = std::max(longest_step, (found.main().p_BS - last).norm());
    last = found.main().p_BS;
  }
  EXPECT_LT(longest_step, 1.2 * 0.0056 * kTube);
}

// More places than a query tries, twice in one query: the inside of a coarse bowl whose contact
// has been lost. It once wrote past its list.
TEST(SurfaceGrooves, ManyMinimaAtOnceAreNoHarm) {
  TriangleMesh bowl = noisy(geodesicSphere(0.0081, 12), 1e-4, 3);
  for (auto& t : bowl.triangles) std::swap(t[1], t[2]);
  Tip tip(bowl);
  RandomNumbers random(2);
  for (int i = 0; i < tests::draws(3000); ++i) {
    const SurfaceContacts contacts =
        tip.at(2e-4 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    ASSERT_GE(contacts.count, 1);
    ASSERT_TRUE(pushOf(contacts).allFinite());
  }
}

}  // namespace
}  // namespace pincer::contact
