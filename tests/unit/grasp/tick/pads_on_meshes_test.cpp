// Flat pads on meshes: the places on which they stand, seen from the smooth surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "pincer/contact/finger_query.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/lathe.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::contact {
namespace {

constexpr double kHalf = 9.5e-3, kThin = 1.5e-3, kRound = 5e-4;  // of the pad's core [m]
constexpr double kPressed = 1e-5;                                // [m]

// 20 mm wide; its faces look along z.
PadTip squarePad() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? kHalf : -kHalf, i & 2 ? kHalf : -kHalf, i & 4 ? kThin : -kThin});
  return {Polytope::hullOf(corners, "pad"), kRound};
}

Shape smooth(const TriangleMesh& mesh) { return Mesh{SmoothMesh::build(mesh)}; }

// Lowered from above onto what is `top` high under it, turned by `yaw`.
FingerContacts padOnTop(const Shape& body, double top, double yaw = 0, double x = 0) {
  FingerTracker tracker;
  PatchCache cache(256);
  return queryFinger(body, squarePad(), {tests::about(Vec3(0, 0, 1), yaw), Vec3(x, 0, top + kThin + kRound - kPressed)},
                     1e-3, tracker, cache);
}

// The contacts that are no deeper than they should be, and no shallower, by more than `off`.
int countAtDepth(const FingerContacts& found, double off) {
  int count = 0;
  for (int i = 0; i < found.count; ++i)
    count += std::abs(found.points[static_cast<std::size_t>(i)].phi + kPressed) < off;
  return count;
}

// Of the places across z: their least and largest x and y.
Eigen::AlignedBox2d spanOf(const FingerContacts& found) {
  Eigen::AlignedBox2d box;
  for (int i = 0; i < found.count; ++i) box.extend(Vec2(found.points[static_cast<std::size_t>(i)].p_BS.head<2>()));
  return box;
}

TEST(PadOnMesh, StandsOnTheCornersOfWhatItSharesWithAFace) {
  for (const double half : {0.02, 0.006}) {
    const FingerContacts found = padOnTop(smooth(gridBox(Vec3(half, half, 0.01), 5)), 0.01);
    EXPECT_GE(countAtDepth(found, 1e-12), 4) << half;
    EXPECT_EQ(countAtDepth(found, 1e-12), found.count) << half;
    const double reach = std::min(half, kHalf);
    EXPECT_NEAR(spanOf(found).max().x(), reach, 1e-9) << half;
    EXPECT_NEAR(spanOf(found).min().y(), -reach, 1e-9) << half;
  }
}

// Leaning by 2e-4 rad it touched a box of 10 x 8 mm at one place: the mesh's corners have the pad's normal, which was
// none of the face's. Pads without a patch_radius threw such a box out, in the first tick that it was nudged in.
TEST(PadOnMesh, StandsOnTheCornersOfAFaceThatIsSmallerThanThePadWhileItLeans) {
  const Vec3 half(0.005, 0.004, 0.01);
  for (const double lean : {0.0, 2e-4, 1e-3, 1e-2}) {
    const Pose X_BF{tests::about(Vec3(0.6, 0.8, 0), lean), Vec3(0, 0, half.z() + kThin + kRound - kPressed)};
    FingerTracker on_mesh, on_solid;
    PatchCache cache(256);
    const FingerContacts found = queryFinger(smooth(box(half)), squarePad(), X_BF, 1e-3, on_mesh, cache);
    const FingerContacts right = queryFinger(Box{half}, squarePad(), X_BF, 1e-3, on_solid, cache);
    ASSERT_EQ(found.count, 4) << lean;
    ASSERT_EQ(right.count, 4) << lean;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(found.points[k].phi, right.points[k].phi, lean * lean * 1e-3 + 1e-12) << lean << ' ' << k;
      EXPECT_LT((found.points[k].p_BS - right.points[k].p_BS).norm(), lean * 1e-3 + 1e-9) << lean << ' ' << k;
    }
  }
}

// Halfway between two ribs there is no surface: the pad was taken for one on a curved mesh, which stands on any places
// of the ribs' edges.
TEST(PadOnMesh, StandsOnTheCornersOfTwoRibs) {
  TriangleMesh ribs = transformed(box(Vec3(0.001, 0.005, 0.01)), {Quat::Identity(), Vec3(-0.004, 0, 0)});
  const TriangleMesh other = transformed(box(Vec3(0.001, 0.005, 0.01)), {Quat::Identity(), Vec3(0.004, 0, 0)});
  const auto shift = static_cast<std::int32_t>(ribs.vertices.size());
  ribs.vertices.insert(ribs.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) ribs.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  const FingerContacts found = padOnTop(smooth(ribs), 0.01);
  ASSERT_GE(found.count, 4);
  EXPECT_EQ(countAtDepth(found, 1e-12), found.count);
  EXPECT_NEAR(spanOf(found).max().x(), 0.005, 1e-9);
  EXPECT_NEAR(spanOf(found).min().x(), -0.005, 1e-9);
  EXPECT_NEAR(spanOf(found).max().y(), 0.005, 1e-9);
  EXPECT_NEAR(spanOf(found).min().y(), -0.005, 1e-9);
}

TEST(PadOnMesh, StandsOnALineOfAStraightWall) {
  const TriangleMesh upright = lathe({{0, -0.03}, {0.018, -0.03}, {0.018, 0.03}, {0, 0.03}}, 48);
  const Shape lying = smooth(transformed(upright, {tests::about(Vec3(0, 1, 0), M_PI / 2), Vec3::Zero()}));
  const FingerContacts found = padOnTop(lying, 0.018, 0.2);
  EXPECT_EQ(countAtDepth(found, 1e-7), found.count);
  const double along = kHalf / std::cos(0.2);
  EXPECT_NEAR(spanOf(found).max().x(), along, 2e-4);
  EXPECT_NEAR(spanOf(found).min().x(), -along, 2e-4);
  EXPECT_LT(spanOf(found).sizes().y(), 1e-4);
}

// The line was known where the pad's edges cross it only: at one place of a wall that ends under the pad.
TEST(PadOnMesh, StandsOnTheEndsOfAWallThatIsShorterThanThePad) {
  for (const int sides : {12, 24, 48}) {
    for (const double half : {0.002, 0.006}) {
      const TriangleMesh upright = lathe({{0, -half}, {0.018, -half}, {0.018, half}, {0, half}}, sides);
      for (const double roll : {0.0, 0.1, 0.26}) {
        const Quat q = tests::about(Vec3(1, 0, 0), roll) * tests::about(Vec3(0, 1, 0), M_PI / 2);
        const FingerContacts found = padOnTop(smooth(transformed(upright, {q, Vec3::Zero()})), 0.018, 0.2);
        ASSERT_EQ(found.count, 2) << sides << ' ' << half << ' ' << roll;
        EXPECT_NEAR(found.points[0].phi, found.points[1].phi, 1e-9);
        EXPECT_NEAR(spanOf(found).max().x(), half, 1e-9);
        EXPECT_NEAR(spanOf(found).min().x(), -half, 1e-9);
      }
    }
  }
}

// The lines of a cone meet in its tip. A wall was followed along the edge beside the place, and ended where that left
// its quad. The patches of 12 sides lean by 1e-4 where the cone's lines are level.
TEST(PadOnMesh, StandsOnALineOfACone) {
  for (const int sides : {12, 24}) {
    for (const double top : {0.012, 0.016, 0.017}) {
      const TriangleMesh upright = lathe({{0, -0.03}, {0.018, -0.03}, {top, 0.03}, {0, 0.03}}, sides);
      const double lean = std::atan2(0.018 - top, 0.06), height = 0.5 * (0.018 + top) * std::cos(lean);
      for (const double roll : {0.0, 0.02, 0.1, 0.2}) {
        const Quat q = tests::about(Vec3(0, 1, 0), M_PI / 2 - lean) * tests::about(Vec3(0, 0, 1), roll);
        const FingerContacts found = padOnTop(smooth(transformed(upright, {q, Vec3::Zero()})), height);
        ASSERT_EQ(found.count, 2) << sides << ' ' << top << ' ' << roll;
        EXPECT_NEAR(found.points[0].phi, found.points[1].phi, 1e-4 * 2 * kHalf) << sides << ' ' << top << ' ' << roll;
        EXPECT_NEAR(spanOf(found).max().x(), kHalf, 1e-4) << sides << ' ' << top << ' ' << roll;
        EXPECT_NEAR(spanOf(found).min().x(), -kHalf, 1e-4) << sides << ' ' << top << ' ' << roll;
      }
    }
  }
}

TEST(PadOnMesh, TouchesABallAtOnePlace) {
  const FingerContacts found = padOnTop(smooth(geodesicSphere(0.018, 12)), 0.018);
  EXPECT_EQ(found.count, 1);
}

// Over a hollow 1.5 mm deep in the middle of a ring the pad stands on the ring's inner edges, or on its own.
TEST(PadOnMesh, StandsAcrossAHollow) {
  const Shape dish = smooth(lathe({{0, 0}, {0.008, 0.0015}, {0.02, 0.0015}, {0.02, -0.01}, {0, -0.01}}, 64));
  const FingerContacts found = padOnTop(dish, 0.0015);
  ASSERT_GE(found.count, 4);
  EXPECT_LT(spanOf(found).min().x(), -0.005);
  EXPECT_GT(spanOf(found).max().x(), 0.005);
  EXPECT_LT(spanOf(found).min().y(), -0.005);
  EXPECT_GT(spanOf(found).max().y(), 0.005);
}

TEST(PadOnMesh, KeepsItsPointsWhileItSlidesAndTilts) {
  const Shape face = smooth(box(Vec3(0.03, 0.03, 0.01)));
  FingerTracker tracker;
  PatchCache cache(256);
  std::vector<std::uint32_t> first;
  for (int i = 0; i < 200; ++i) {
    const Pose X_BF{tests::about(Vec3(1, 0.3, 0), 2e-5 * i), Vec3(1e-5 * i, 2e-5 * i, 0.01 + kThin + kRound)};
    const FingerContacts found = queryFinger(face, squarePad(), X_BF, 1e-3, tracker, cache);
    std::vector<std::uint32_t> names;
    for (int k = 0; k < found.count; ++k) names.push_back(found.points[static_cast<std::size_t>(k)].feature);
    std::sort(names.begin(), names.end());
    if (i == 0) first = names;
    ASSERT_EQ(names.size(), 4u) << i;
    EXPECT_EQ(names, first) << i;
  }
}

// The ball's triangles are far from the pad's edges, each of which would take six queries.
TEST(PadOnMesh, AsksNoEdgeThatIsFarFromABall) {
  const FingerContacts found = padOnTop(smooth(geodesicSphere(0.015, 8)), 0.015, 0.3, 1e-3);
  EXPECT_EQ(found.count, 1);
  EXPECT_LT(found.queries, 50);  // of the descents from nowhere and from four corners
}

}  // namespace
}  // namespace pincer::contact

namespace pincer::grasp {
namespace {

constexpr double kFriction = 0.6;

struct Creep {
  double way, turn;  // in three seconds, from one second on [m, rad]
  int flagged;
  double wound;  // torsion of a pad at their end, of what friction carries at most [-]
};

// Of a part, nudged between two pads of the half width `half` whose centres are `touch` to either side of `X_WB`.
Creep creepBetweenPads(const contact::TriangleMesh& part, const Pose& X_WB, double touch, double half,
                       double patch_radius, const Vec3& w_W) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"part", contact::smooth(part), true, 0.1, {kFriction, kFriction, 0, 0}});
  std::vector<FingerModel> fingers = {tests::softFinger("left", 5000), tests::softFinger("right", 5000)};
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1.5e-3 : -1.5e-3, i & 2 ? half : -half, i & 4 ? half : -half});
  for (FingerModel& f : fingers) {
    f.shape = contact::PadTip{contact::Polytope::hullOf(corners, "pad"), 5e-4};
    f.pad.patch_radius = patch_radius;
  }
  const GraspModel model = buildGrasp(builder, fingers);
  engine::BodyStart start = tests::startAt(X_WB.p, Vec3::Zero(), w_W);
  start.X_WB.q = X_WB.q;
  GraspState state = makeState(model, {start}, {Vec3(-touch, 0, 0.1), Vec3(touch, 0, 0.1)});
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(2);
  for (int i = 0; i < 2; ++i)
    inputs[static_cast<std::size_t>(i)].p_WF = Vec3((i == 0 ? -1 : 1) * (touch - 3e-3), 0, 0.1);
  for (int i = 0; i < 1000; ++i) step(model, state, scratch, inputs);
  const Pose held = state.world.bodies[0].X_WI;
  int flagged = 0;
  for (int i = 0; i < 3000; ++i) flagged += step(model, state, scratch, inputs).status != engine::kStepOk;
  const Pose& now = state.world.bodies[0].X_WI;
  double wound = 0;
  for (int k = 0; k < state.world.contact_count; ++k) {
    const engine::ContactVector& r = state.world.contacts[static_cast<std::size_t>(k)].r;
    wound = std::max(wound, std::abs(r[engine::kTorsionRow]) / (kFriction * r[engine::kNormalRow]));
  }
  return {(now.p - held.p).norm(), angleBetween(now.q, held.q), flagged, wound};
}

// A turned part about the z axis.
Creep creepBetweenPads(const std::vector<Vec2>& profile, int sides, double touch, double half, double patch_radius,
                       const Vec3& w_W) {
  return creepBetweenPads(contact::lathe(profile, sides), {Quat::Identity(), Vec3(0, 0, 0.1)}, touch, half,
                          patch_radius, w_W);
}

// Its faces bulge by microns, so that the place of the load went 3 mm to and fro between two ticks: it rocked at
// 1 rad/s for ever, and crept by 12 um in a second.
TEST(PadOnMesh, DoesntRockACubeWithRoundEdges) {
  for (const double half : {0.0095, 0.0145}) {
    const Creep creep = creepBetweenPads(contact::roundedCube(0.02, 0.006, 4), {Quat::Identity(), Vec3(0, 0, 0.1)},
                                         0.022, half, 0.004, Vec3(0.2, -0.1, 0.2));
    EXPECT_EQ(creep.flagged, 0) << half;
    EXPECT_LT(creep.way, 1e-12) << half;
    EXPECT_LT(creep.turn, 1e-6) << half;
  }
}

// The gaps of several places asked for a way along the pad instead of a turn of what it holds, and the offsets of what
// sticks followed: it walked over the hills by 36 um in three seconds.
TEST(PadOnMesh, DoesntWalkOverHills) {
  const double height = 0.03;  // of the radius
  const Creep creep = creepBetweenPads(contact::bumpySphere(0.02, height, 20, 24), {Quat::Identity(), Vec3(0, 0, 0.1)},
                                       0.02 * (1 + height) + 2e-3, 0.0095, 0, Vec3(0.2, -0.1, 0.2));
  EXPECT_EQ(creep.flagged, 0);
  EXPECT_LT(creep.way, 1e-12);
  EXPECT_LT(creep.turn, 1e-9);
}

// A barrel between two pads buzzed, as each pad's edges and its middle took turns, and a spool rocked off.
TEST(PadOnMesh, HoldsABarrelAndASpool) {
  for (const double bulge : {0.003, -0.003}) {
    std::vector<Vec2> profile{{0, -0.02}};
    for (int i = 0; i <= 16; ++i) profile.push_back({0.018 + bulge * math::sin(M_PI * i / 16), -0.02 + 0.04 * i / 16});
    profile.push_back({0, 0.02});
    const double touch = std::max(0.018, 0.018 + bulge) + 2e-3;
    const Creep creep = creepBetweenPads(profile, 48, touch, 0.022, 0.004, Vec3(0, 0.3, 0));
    EXPECT_EQ(creep.flagged, 0) << bulge;
    EXPECT_LT(creep.way, 1e-9) << bulge;
    EXPECT_LT(creep.turn, 1e-7) << bulge;
  }
}

// Pads of 30 and 40 mm let go of one of 24 sides, 24 mm high, and one of 12 mm turned by 1e-6 rad per second.
TEST(PadOnMesh, HoldsAWallThatEndsUnderThePads) {
  for (const double half_height : {0.003, 0.012, 0.02}) {
    const std::vector<Vec2> profile{{0, -half_height}, {0.018, -half_height}, {0.018, half_height}, {0, half_height}};
    for (const int sides : {12, 24}) {
      for (const double half : {0.01, 0.015, 0.02}) {
        for (const Vec3& w_W : {Vec3(0, 0.3, 0), Vec3(0.2, -0.1, 0.2)}) {
          const Creep creep = creepBetweenPads(profile, sides, 0.02, half - 5e-4, 0, w_W);
          EXPECT_EQ(creep.flagged, 0) << half_height << ' ' << sides << ' ' << half;
          EXPECT_LT(creep.way, 1e-12) << half_height << ' ' << sides << ' ' << half;
          EXPECT_LT(creep.turn, 1e-9) << half_height << ' ' << sides << ' ' << half;
        }
      }
    }
  }
}

// A cone that lies with its wall on one pad touches the other with its rim, which was taken for the wall in every other
// tick: it went to and fro by 0.03 um for ever.
TEST(PadOnMesh, HoldsAConeThatLiesOnItsWall) {
  for (const double top : {0.012, 0.013}) {
    for (const int sides : {12, 24}) {
      const contact::TriangleMesh cone =
          contact::lathe({{0, -0.015}, {0.015, -0.015}, {top, 0.015}, {0, 0.015}}, sides);
      const Quat q = tests::about(Vec3(0, 1, 0), -std::atan2(0.015 - top, 0.03)) * tests::about(Vec3(0, 0, 1), 0.1);
      double low = 0, high = 0;  // of it along x
      for (const Vec3& v : cone.vertices) {
        low = std::min(low, (q * v).x());
        high = std::max(high, (q * v).x());
      }
      const Pose X_WB{q, Vec3(-0.5 * (low + high), 0, 0.1)};
      const Creep creep = creepBetweenPads(cone, X_WB, 0.5 * (high - low) + 2e-3, 0.0195, 0, Vec3(0, 0.3, 0));
      EXPECT_EQ(creep.flagged, 0) << top << ' ' << sides;
      EXPECT_LT(creep.way, 1e-11) << top << ' ' << sides;
      EXPECT_LT(creep.turn, 1e-8) << top << ' ' << sides;
    }
  }
}

// Two soft pads that don't turn remember two twists of what they hold, about normals that aren't quite parallel: their
// torsions wound each other up, by 6 % of what friction carries per second, until nothing of it was left.
TEST(PadOnMesh, DoesntWindABallUp) {
  for (const double half : {0.0145, 0.0195}) {
    const Creep creep = creepBetweenPads(contact::geodesicSphere(0.015, 8), {Quat::Identity(), Vec3(0, 0, 0.1)}, 0.017,
                                         half, 0.004, Vec3(0.2, -0.1, 0.2));
    EXPECT_EQ(creep.flagged, 0) << half;
    EXPECT_LT(creep.wound, 0.05) << half;
  }
}

}  // namespace
}  // namespace pincer::grasp
