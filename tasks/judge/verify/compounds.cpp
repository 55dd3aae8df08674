// Bodies of several shapes. The answers are those of the same body made of one shape, and closed forms:
//
//   halves     a box of two halves moves as the box
//   dumbbell   two balls, mass m/2 and radius r each, 2 d apart: I = 2/5 m r^2 along their line,
//              I + m d^2 across it; precesses regularly
//   inertia    an L of three cubes of edge a, mass m each: I_xx = I_yy = 7/6, I_zz = 11/6,
//              I_xy = 1/3 m a^2 about its centre of mass
//   jaws       of five boxes each, pressed by 20 N, hold a cube of 64 g as two flat faces would
#include <array>

#include "pincer/engine/step.h"
#include "pincer/tasks/judge/exact/rigid_body.h"
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

engine::ColliderSpec partAt(const contact::Shape& shape, const Vec3& p_BS) {
  return {"part", shape, Pose{Quat::Identity(), p_BS}};
}

engine::BodySpec bodyOfParts(std::vector<engine::ColliderSpec> parts, double mass) {
  engine::BodySpec body{"body", contact::Sphere{1}, true, mass, {}};
  body.shapes = std::move(parts);
  return body;
}

// 40 x 20 x 20 mm, 100 g.
engine::BodySpec boxOfHalves(bool is_split) {
  if (!is_split) return {"body", contact::Box{{0.02, 0.01, 0.01}}, true, 0.1, {}};
  const contact::Box half{{0.01, 0.01, 0.01}};
  return bodyOfParts({partAt(half, {-0.01, 0, 0}), partAt(half, {0.01, 0, 0})}, 0.1);
}

// The body over a floor.
struct OverFloor {
  engine::WorldModel model;
  engine::WorldState state;
  engine::ScratchHandle scratch;

  OverFloor(const engine::BodySpec& body, const engine::BodyStart& start) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
    builder.addBody(body);
    model = builder.build();
    state = engine::makeState(model, {engine::BodyStart{}, start}, {});
    scratch = engine::makeScratch(model);
  }
  bool tick() { return engine::step(model, state, *scratch).status == engine::kStepOk; }
  const Pose& place() const { return state.bodies[1].X_WI; }
};

// How far the two are apart at most [m], each corner counted, while both run.
double apart(const engine::BodyStart& start, int ticks) {
  OverFloor one(boxOfHalves(false), start), two(boxOfHalves(true), start);
  constexpr double kReach = 0.0245;  // of the box's corners [m]
  double furthest = 0;
  for (int i = 0; i < ticks; ++i) {
    if (!one.tick() || !two.tick()) return std::nan("");
    furthest = std::max(furthest,
                        (one.place().p - two.place().p).norm() + kReach * angleBetween(one.place().q, two.place().q));
  }
  return furthest;
}

std::vector<Record> twoHalves(MeasureContext&) {
  engine::BodyStart flight, slide, spin;
  flight.X_WB.p = Vec3(0, 0, 5);
  flight.w_W = Vec3(3, 20, 5);
  slide.X_WB.p = spin.X_WB.p = Vec3(0, 0, 0.01);
  slide.v_W = Vec3(0.3, 0.1, 0);
  spin.v_W = Vec3(0.2, 0, 0);
  spin.w_W = Vec3(0, 0, 10);
  return {atMost("in flight, 1 s", 1e6 * apart(flight, 1000), "um", 1e-6),
          atMost("sliding to rest", 1e6 * apart(slide, 400), "um", 1e-3),
          atMost("sliding and turning to rest", 1e6 * apart(spin, 400), "um", 1e-3)};
}

std::vector<Record> dumbbellSpins(MeasureContext& context) {
  constexpr double kRadius = 0.01, kHalf = 0.02, kMass = 0.1;  // [m], [m], [kg]
  const contact::Sphere ball{kRadius};
  engine::WorldOptions options;
  options.gravity_W.setZero();
  engine::WorldBuilder builder{options};
  builder.addBody(bodyOfParts({partAt(ball, {0, 0, -kHalf}), partAt(ball, {0, 0, kHalf})}, kMass));
  const engine::WorldModel model = builder.build();
  const double along = 0.4 * kMass * kRadius * kRadius, across = along + kMass * kHalf * kHalf;
  engine::BodyStart start;
  start.w_W = Vec3(15, -4, 90);
  engine::WorldState state = engine::makeState(model, {start}, {});
  const engine::ScratchHandle scratch = engine::makeScratch(model);
  double worst = 0;
  while (state.tick < 10000 && !context.interrupted()) {
    engine::step(model, state, *scratch);
    const Quat q = engine::bodyPose(model, state, 0).q;
    worst = std::max(worst, angleBetween(exact::symmetricTop(across, along, start.w_W, state.time), q));
  }
  return {atMost("angle over 10 s, largest error", worst, "rad", 1e-10)};
}

// Cubes at (0, 0), (a, 0), (0, a): the centre of mass at (a, a)/3; 3 x m a^2/6 of their own, and of the arms
// I_xx = I_yy = 2/3 m a^2, I_xy = 1/3 m a^2.
std::vector<Record> inertiaOfAnL(MeasureContext&) {
  constexpr double kEdge = 0.02, kMass = 0.03;  // [m], [kg]
  const contact::Box cube{Vec3::Constant(kEdge / 2)};
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody(
      bodyOfParts({partAt(cube, Vec3::Zero()), partAt(cube, {kEdge, 0, 0}), partAt(cube, {0, kEdge, 0})}, 3 * kMass));
  const engine::BodyModel body = builder.build().bodies[0];
  const double unit = kMass * kEdge * kEdge;
  Mat3 exact = Vec3(3.0 / 6 + 2.0 / 3, 3.0 / 6 + 2.0 / 3, 3.0 / 6 + 4.0 / 3).asDiagonal();
  exact(0, 1) = exact(1, 0) = 1.0 / 3;
  const Mat3 R = body.X_BI.q.toRotationMatrix(), I = R * body.moments.asDiagonal() * R.transpose();
  return {atMost("tensor, error", (I / unit - exact).norm(), "-", 1e-14),
          atMost("centre of mass, error", (body.X_BI.p - Vec3(kEdge, kEdge, 0) / 3).norm() / kEdge, "-", 1e-15)};
}

std::vector<Record> fiveBoxJaws(MeasureContext& context) {
  Scene scene = readBuiltinScene("five_box_jaws");
  scene.duration = 60;
  Simulation sim(std::move(scene));
  double slip = 0, turn = 0, creep = 0;
  Pose held, carried;
  const RunCount count = runThrough(sim, context, [&] {
    const Pose in_jaw = sim.bodyPose(2).inverse() * sim.bodyPose(1);
    if (sim.ticks() == 700) held = in_jaw;  // gripped, and not lifted yet
    if (sim.ticks() == 5000) carried = in_jaw;
    if (sim.ticks() > 700) slip = std::max(slip, (in_jaw.p - held.p).norm());
    if (sim.ticks() > 700) turn = std::max(turn, angleBetween(in_jaw.q, held.q));
    if (sim.ticks() > 5000) creep = std::max(creep, (in_jaw.p - carried.p).norm());
  });
  return {atMost("moved in the jaw while it was lifted", 1e6 * slip, "um", 0.1),
          atMost("turned in the jaw", turn, "rad", 1e-6), atMost("creep in the jaw in 55 s", 1e6 * creep, "um", 1e-6),
          exactly("flagged ticks", static_cast<double>(count.flagged), "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyCompounds() {
  return {{"compounds/two-halves", twoHalves},
          {"compounds/dumbbell", dumbbellSpins},
          {"compounds/inertia", inertiaOfAnL},
          {"compounds/five-box-jaws", fiveBoxJaws}};
}

}  // namespace pincer::tasks
