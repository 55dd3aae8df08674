// Bodies of several shapes: their mass, and that they move as one solid, whatever shapes it is made of.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::startAt;

constexpr double kOfRoundOff = 1e-14;  // relative: sums of a few terms

ColliderSpec shapeAt(const contact::Shape& shape, const Vec3& p_BS, const std::string& name = "part") {
  return {name, shape, Pose{Quat::Identity(), p_BS}};
}

BodySpec compound(const std::vector<ColliderSpec>& shapes, double mass = 0.1) {
  BodySpec spec{"compound", contact::Sphere{1}, true, mass, {}};
  spec.shapes = shapes;
  return spec;
}

BodySpec floor() { return {"floor", contact::HalfSpace{}, false, 0, {}}; }

// A box of 40 x 20 x 20 mm, of one piece or of two halves.
BodySpec boxOf(int pieces) {
  if (pieces == 1) return {"box", contact::Box{{0.02, 0.01, 0.01}}, true, 0.1, {}};
  const contact::Box half{{0.01, 0.01, 0.01}};
  return compound({shapeAt(half, {-0.01, 0, 0}, "left"), shapeAt(half, {0.01, 0, 0}, "right")});
}

// Two balls of radius 10 mm, 40 mm apart.
BodySpec dumbbell() {
  return compound({shapeAt(contact::Sphere{0.01}, {-0.02, 0, 0}), shapeAt(contact::Sphere{0.01}, {0.02, 0, 0})});
}

WorldModel worldOf(const std::vector<BodySpec>& bodies, const WorldOptions& options = {}) {
  WorldBuilder builder{options};
  for (const BodySpec& body : bodies) builder.addBody(body);
  return builder.build();
}

TEST(Compounds, TwoHalfBoxesWeighAsOneBox) {
  const BodyModel one = worldOf({boxOf(1)}).bodies[0], two = worldOf({boxOf(2)}).bodies[0];
  EXPECT_EQ(two.mass, one.mass);
  EXPECT_LT((two.moments - one.moments).norm(), kOfRoundOff * one.moments.norm());
  EXPECT_LT(two.X_BI.p.norm(), kOfRoundOff);
  EXPECT_NEAR(two.bounding_radius, 0.01 + std::sqrt(3) * 0.01, kOfRoundOff);
}

// Parallel axes: 2/5 m r^2 along the line of the centres, and m d^2 more across it, d half their distance.
TEST(Compounds, ADumbbellHasTheInertiaOfItsBallsAndTheirArms) {
  const BodyModel body = worldOf({dumbbell()}).bodies[0];
  const double own = 0.4 * 0.1 * 0.01 * 0.01, arms = 0.1 * 0.02 * 0.02;
  EXPECT_LT((body.moments - Vec3(own, own + arms, own + arms)).norm(), kOfRoundOff * arms);
}

TEST(Compounds, AShapesOwnMassMovesTheCentre) {
  BodySpec hammer = dumbbell();
  hammer.shapes[1].mass = 0.075;
  const BodyModel body = worldOf({hammer}).bodies[0];
  EXPECT_NEAR(body.X_BI.p.x(), 0.01, kOfRoundOff);  // (0.075 - 0.025) / 0.1 x 20 mm
  hammer.shapes[0].mass = 0.025;
  hammer.mass = 0;  // the sum of theirs
  EXPECT_NEAR(worldOf({hammer}).bodies[0].mass, 0.1, kOfRoundOff);
  hammer.mass = 0.2;
  EXPECT_EQ(tests::errorOf([&] { worldOf({hammer}); }),
            "body \"compound\": its shapes' masses come to 0.1 kg, its own is 0.2. Leave one of them out, or let what "
            "is left be positive for "
            "shapes without a mass.");
}

// Homogeneous shapes turned by a right angle: the inertia's axes turn with them.
TEST(Compounds, AShapeMayBeTurned) {
  BodySpec turned = compound(
      {{"rod", contact::Cylinder{0.005, 0.05}, Pose{quatFromRotationVector({0, 0.5 * tests::kPi, 0}), Vec3::Zero()}}});
  const WorldModel model = worldOf({turned});
  const BodyModel& body = model.bodies[0];
  const Mat3 R = body.X_BI.q.toRotationMatrix(), I = R * body.moments.asDiagonal() * R.transpose();
  EXPECT_NEAR(I(0, 0), 0.5 * 0.1 * 0.005 * 0.005, 1e-18);  // about its own axis, which now is x
  EXPECT_NEAR(I(2, 2), 0.1 * (0.005 * 0.005 / 4 + 0.1 * 0.1 / 12), 1e-18);
}

TEST(Compounds, AGivenInertiaCountsInPlaceOfTheShapes) {
  BodySpec measured = boxOf(1);
  measured.inertia = GivenInertia{{0.001, 0, 0}, Vec3(1e-5, 2e-5, 2.5e-5).asDiagonal()};
  const BodyModel body = worldOf({measured}).bodies[0];
  EXPECT_EQ(body.moments, Vec3(1e-5, 2e-5, 2.5e-5));
  EXPECT_EQ(body.X_BI.p, Vec3(0.001, 0, 0));
  measured.inertia->I_BBcm(0, 1) = 1e-6;
  EXPECT_EQ(tests::errorOf([&] { worldOf({measured}); }),
            "body \"box\": its inertia isn't finite and symmetric. Give the full tensor about the centre of mass.");
  measured.inertia->I_BBcm = Vec3(1e-5, 2e-5, 4e-5).asDiagonal();
  EXPECT_EQ(tests::errorOf([&] { worldOf({measured}); }).substr(0, 39), "body \"box\": principal moments of inerti");
}

double distance(const BodyState& x, const BodyState& y) {
  return std::max((x.X_WI.p - y.X_WI.p).norm(), 0.02 * (x.X_WI.q.coeffs() - y.X_WI.q.coeffs()).norm());
}

// Steps the two worlds side by side; returns the largest distance of their last bodies [m].
double furthestApart(const WorldModel& x, const WorldModel& y, const BodyStart& start, int ticks) {
  WorldState sx = makeState(x, {startAt(Vec3::Zero()), start}, {}),
             sy = makeState(y, {startAt(Vec3::Zero()), start}, {});
  WorldScratch wx(x), wy(y);
  double furthest = 0;
  for (int i = 0; i < ticks; ++i) {
    step(x, sx, wx);
    step(y, sy, wy);
    furthest = std::max(furthest, distance(sx.bodies.back(), sy.bodies.back()));
  }
  return furthest;
}

TEST(Compounds, TwoHalfBoxesFallAndSlideAsOneBox) {
  const WorldModel one = worldOf({floor(), boxOf(1)}), two = worldOf({floor(), boxOf(2)});
  // Thrown flat along the floor, turning about z: it slides to rest on the same four corners, to the solver's 1e-10 of
  // the problem's speeds. On eight points, as long as contacts of one plane weren't thinned, the two were 0.9 mm apart.
  EXPECT_LT(furthestApart(one, two, startAt({0, 0, 0.01}, {0.3, 0.1, 0}, {0, 0, 5}), 400), 1e-9);
  // In flight there is nothing but the round-off of the moments, over 10 rad.
  EXPECT_LT(furthestApart(one, two, startAt({0, 0, 1}, {0.3, 0.1, 0}, {3, 20, 5}), 400), 1e-13);
}

TEST(Compounds, TwoHalvesOfAFloorCarryASlidingBoxOverTheirSeam) {
  BodySpec slab{"slab", contact::Box{{0.2, 0.1, 0.01}}, false, 0, {}}, halves = slab;
  const contact::Box half{{0.1, 0.1, 0.01}};
  halves.shapes = {shapeAt(half, {-0.1, 0, 0}), shapeAt(half, {0.1, 0, 0})};
  const WorldModel one = worldOf({slab, boxOf(1)}), two = worldOf({halves, boxOf(1)});
  EXPECT_LT(furthestApart(one, two, startAt({-0.03, 0, 0.02}, {0.7, 0, 0}), 300), 1e-9);
}

TEST(Compounds, ADumbbellStandsOnTwoContactsThatKeepTheirIdentities) {
  const WorldModel model = worldOf({floor(), dumbbell()});
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt({0, 0, 0.01})}, {});
  WorldScratch scratch(model);
  const auto shapes = [&] {
    std::set<std::pair<std::uint64_t, int>> found;
    for (int k = 0; k < contactCount(scratch); ++k)
      found.emplace(contactAt(scratch, k).id, contactAt(scratch, k).shape);
    return found;
  };
  step(model, state, scratch);
  const auto first = shapes();
  EXPECT_EQ(first.size(), 2u);
  EXPECT_EQ(first.begin()->second + first.rbegin()->second, 1) << "one contact of each shape";
  const std::int64_t allocated = tests::allocationCount();
  for (int i = 0; i < 200; ++i) step(model, state, scratch);
  EXPECT_EQ(tests::allocationCount(), allocated);
  EXPECT_EQ(shapes(), first);
  EXPECT_NEAR(state.bodies[1].X_WI.p.z(), 0.01, 1e-12);
}

// A level dumbbell bounces as one ball does: each flight reaches e^2 of the height before.
TEST(Compounds, ADumbbellBouncesToESquaredOfItsHeight) {
  BodySpec ground = floor(), bell = dumbbell();
  ground.material.restitution = bell.material.restitution = 0.5;
  const WorldModel model = worldOf({ground, bell});
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt({0, 0, 0.06})}, {});
  WorldScratch scratch(model);
  // times of the fall, and of the flight up after it
  const double fall = std::sqrt(2 * 0.05 / tests::kGravity), up = 0.5 * fall;
  const int ticks = static_cast<int>((fall + up) / 1e-3);
  for (int i = 0; i < ticks; ++i) step(model, state, scratch);
  const double left = fall + up - state.time;
  EXPECT_NEAR(state.bodies[1].X_WI.p.z() + 0.5 * tests::kGravity * left * left, 0.01 + 0.25 * 0.05, 1e-10);
  EXPECT_LT(state.bodies[1].L_W.norm(), 1e-12);
}

TEST(Compounds, ABallRollsInACornerOfOneBodysWalls) {
  BodySpec tray{"tray", contact::Sphere{1}, false, 0, {}};
  tray.shapes = {shapeAt(contact::Box{{0.1, 0.1, 0.01}}, {0, 0, -0.01}, "bottom"),
                 shapeAt(contact::Box{{0.01, 0.1, 0.02}}, {0.11, 0, 0.02}, "wall")};
  const WorldModel model = worldOf({tray, {"ball", contact::Sphere{0.01}, true, 0.05, {}}});
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt({0.05, 0, 0.01}, {0.5, 0, 0})}, {});
  WorldScratch scratch(model);
  double furthest = 0;
  for (int i = 0; i < 500; ++i) {
    step(model, state, scratch);
    furthest = std::max(furthest, state.bodies[1].X_WI.p.x());
  }
  EXPECT_NEAR(furthest, 0.09, 1e-9) << "it stops at the wall";
}

TEST(Compounds, BitsSayWhichShapesTouch) {
  BodySpec ground = floor(), bell = dumbbell();
  bell.shapes[0].bits = bell.shapes[1].bits = {2, 2};
  EXPECT_TRUE(worldOf({ground, bell}).pairs.empty()) << "no bit in common";
  bell.shapes[0].bits = {2, 1};
  EXPECT_EQ(worldOf({ground, bell}).pairs.size(), 1u);
  bell.shapes = {shapeAt(contact::Sphere{0.01}, Vec3::Zero()), shapeAt(contact::Sphere{0.03}, Vec3::Zero())};
  bell.shapes[1].bits = {0, 0};  // only seen
  const WorldModel model = worldOf({ground, bell});
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt({0, 0, 0.02})}, {});
  WorldScratch scratch(model);
  for (int i = 0; i < 200; ++i) step(model, state, scratch);
  EXPECT_NEAR(state.bodies[1].X_WI.p.z(), 0.01, 1e-12);
}

TEST(Compounds, EachShapeHasItsFriction) {
  BodySpec bell = dumbbell();
  bell.shapes[0].material = Material{0.2, 0.2};
  bell.shapes[1].material = Material{0.8, 0.8};
  BodySpec ground = floor();
  ground.material = {0.45, 0.45};
  WorldOptions options;
  for (const bool is_maximum : {false, true}) {
    options.combination = is_maximum ? Combination::kMaximum : Combination::kGeometricMean;
    const WorldModel model = worldOf({ground, bell}, options);
    WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt({0, 0, 0.01})}, {});
    WorldScratch scratch(model);
    step(model, state, scratch);
    ASSERT_EQ(contactCount(scratch), 2);
    EXPECT_NEAR(contactAt(scratch, 0).mu, is_maximum ? 0.45 : 0.3, kOfRoundOff);
    EXPECT_NEAR(contactAt(scratch, 1).mu, is_maximum ? 0.8 : 0.6, kOfRoundOff);
  }
}

// 40 shapes take six bits: 512 bodies are left of 32,768.
TEST(Compounds, MoreShapesThanContactsCanTellApartAreRefused) {
  WorldBuilder builder{WorldOptions{}};
  BodySpec many{"many", contact::Sphere{1}, false, 0, {}};
  many.shapes.assign(40, shapeAt(contact::Sphere{0.01}, Vec3::Zero()));
  builder.addBody(many);
  for (int i = 0; i < 511; ++i) builder.addBody({"post", contact::Sphere{0.01}, false, 0, {}});
  EXPECT_EQ(builder.build().shape_bits, 6);
  builder.addBody({"one more", contact::Sphere{0.01}, false, 0, {}});
  EXPECT_EQ(tests::errorOf([&] { static_cast<void>(builder.build()); }),
            "513 bodies, of which one has 40 shapes: contacts can tell apart 512 bodies of so many shapes, 32768 in "
            "all. Use fewer shapes per "
            "body, or several worlds.");
}

// A stool of nine legs touches with its outermost four; one leg longer than the others by 10 um
// carries it, with those that it would rock onto.
TEST(Compounds, PointsInOnePlaneAreThinnedToFour) {
  std::vector<ColliderSpec> legs;
  for (int i = 0; i < 9; ++i)
    legs.push_back(shapeAt(contact::Sphere{0.005}, {0.01 * (i % 3 - 1), 0.01 * (i / 3 - 1), 0}));
  const auto touching = [&] {
    const WorldModel model = worldOf({floor(), compound(legs)});
    WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt({0, 0, 0.005})}, {});
    WorldScratch scratch(model);
    for (int i = 0; i < 300; ++i) step(model, state, scratch);
    std::set<int> found;
    for (int k = 0; k < contactCount(scratch); ++k) found.insert(contactAt(scratch, k).shape);
    EXPECT_LT(kineticEnergy(model, state), 1e-12);
    return found;
  };
  EXPECT_EQ(touching(), (std::set<int>{0, 2, 6, 8}));
  legs[4].X_BS.p.z() = -1e-5;
  EXPECT_EQ(touching().size(), 4u);
  EXPECT_TRUE(touching().contains(4));
  legs[4].material = Material{0.1, 0.1};
  legs[4].X_BS.p.z() = 0;
  EXPECT_EQ(touching(), (std::set<int>{0, 2, 4, 6, 8})) << "a material of its own";
}

// A heap of crosses, found by the broad phase: nothing falls through, nothing is dropped, and it comes to rest.
TEST(Compounds, AHeapOfCrossesComesToRest) {
  const contact::Box bar{{0.015, 0.004, 0.004}}, across{{0.004, 0.015, 0.004}};
  std::vector<BodySpec> bodies = {floor()};
  std::vector<BodyStart> starts = {startAt(Vec3::Zero())};
  for (int i = 0; i < 20; ++i) {
    bodies.push_back(compound({shapeAt(bar, Vec3::Zero()), shapeAt(across, Vec3::Zero())}, 0.02));
    starts.push_back(startAt({0.004 * (i % 3), 0.003 * (i % 4), 0.02 + 0.012 * i}));
  }
  const WorldModel model = worldOf(bodies);
  ASSERT_TRUE(model.has_broad_phase);
  WorldState state = makeState(model, starts, {});
  WorldScratch scratch(model);
  double lowest = 1;
  unsigned dropped = 0;
  for (int i = 0; i < 2500; ++i) {  // a pile of them topples after 1,400
    dropped += (step(model, state, scratch).status & kContactsDropped) != 0;
    for (std::size_t k = 1; k < state.bodies.size(); ++k) lowest = std::min(lowest, state.bodies[k].X_WI.p.z());
  }
  EXPECT_EQ(dropped, 0u);
  EXPECT_GT(lowest, 0.004 - 1e-4);
  EXPECT_LT(kineticEnergy(model, state), 1e-5);
}

}  // namespace
}  // namespace pincer::engine
