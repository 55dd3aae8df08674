// Objects held, let slip, lifted and handed over by fingers.
#include <numbers>
#include <string>

#include "pincer/grasp/step.h"
#include "pincer/tasks/judge/exact/pinch.h"
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

// Held, it doesn't creep: farthest from its start over `seconds`.
std::vector<Record> hold(std::string_view scene_name, double seconds, MeasureContext& context) {
  Scene scene = readBuiltinScene(scene_name);
  scene.duration = seconds;
  Simulation sim(std::move(scene));
  const Pose start = sim.bodyPose(0);
  double slip = 0, turn = 0;
  const RunCount run = runThrough(sim, context, [&] {
    slip = std::max(slip, (sim.bodyPose(0).p - start.p).norm());
    turn = std::max(turn, angleBetween(start.q, sim.bodyPose(0).q));
  });
  return {atMost("slip in 60 s", 1e6 * slip, "um", 1e-6), atMost("rotation in 60 s", turn, "rad", 1e-9),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Time at which the body 0 has dropped by `depth` [s]; between ticks on a straight line, which errs by at most a h^2/8.
double measuredDropTime(Simulation& sim, double depth, MeasureContext& context) {
  const double start = sim.bodyPose(0).p.z(), h = sim.scene().options.h;
  double before = 0, time = std::nan("");
  runThrough(sim, context, [&] {
    const double dropped = start - sim.bodyPose(0).p.z();
    if (std::isnan(time) && dropped > depth) time = sim.time() - h * (dropped - depth) / (dropped - before);
    before = dropped;
  });
  return time;
}

std::vector<Record> slipOut(MeasureContext& context) {
  Simulation sim(readBuiltinScene("s4_pinch_098"));
  const exact::SlidingPinch exact{0.1, 0.02, 0.05, 0.008, 2, 0.98 * 0.1 * kVerifyG / 4, kVerifyG};
  constexpr double kDepth = 0.005;  // of the squeeze [m]
  return {atMost("time to drop 5 mm, relative",
                 std::abs(measuredDropTime(sim, kDepth, context) / exact.dropTime(kDepth) - 1), "-", 1e-4)};
}

std::vector<Record> flatSlide(MeasureContext& context) {
  Simulation sim(readBuiltinScene("flat_pinch_slide"));
  const double z0 = sim.bodyPose(0).p.z();
  double worst = 0;
  const double a = 0.02 * kVerifyG;
  const RunCount run = runThrough(sim, context, [&] {
    const double t = sim.time();
    worst = std::max(worst, std::abs(z0 - sim.bodyPose(0).p.z() - 0.5 * a * t * t));
  });
  const double whole = 0.5 * a * sim.time() * sim.time();
  return {atMost("way, largest error of the whole way", worst / whole, "-", 1e-9),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Bisection of the friction that just holds: a drop of 1 nm within 1 s counts as
// slipping, which 2e-10 below the limit causes.
std::vector<Record> holdThreshold(MeasureContext& context) {
  const Scene scene = readBuiltinScene("s4_pinch");
  const double limit = 0.1 * kVerifyG / 4;
  int done = 0;
  const auto holds = [&](double ratio) {
    context.progress(done++ / 34.0);
    Scene trial = scene;
    trial.duration = 1;
    setFriction(trial, ratio * limit);
    Simulation sim(std::move(trial));
    MeasureContext quiet;
    runThrough(sim, quiet, [] {});
    return std::abs(sim.bodyPose(0).p.z() - 0.1) < 1e-9;
  };
  return {atMost("friction that just holds over m g/(2 N), less 1", std::abs(threshold(0.9, 1.1, 34, holds) - 1), "-",
                 1e-8)};
}

std::vector<Record> lift(MeasureContext& context) {
  Simulation sim(readBuiltinScene("s5_lift"));
  const exact::StuckLift exact{0.3, 500, 2, 0.1, 1, 0.2};
  const std::vector<double> rises = exact.rises(static_cast<int>(sim.scene().ticks()), sim.scene().options.h);
  double error = 0, slip = 0;
  const RunCount run = runThrough(sim, context, [&] {
    const double z = sim.bodyPose(0).p.z();
    const auto& fingers = sim.state().world.points;
    error = std::max(error, std::abs(z - 0.1 - rises[static_cast<std::size_t>(sim.ticks() - 1)]));
    slip = std::max(slip, std::abs(z - 0.5 * (fingers[0].p_W.z() + fingers[1].p_W.z())));
  });
  return {atMost("trajectory, largest deviation", 1e6 * error, "um", 1e-2),
          atMost("slip against the fingers", 1e6 * slip, "um", 1e-6),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Bisection of the friction that holds a plate beside its centre of mass; a turn
// of 1e-6 rad within 1 s counts as slipping.
std::vector<Record> offsetPlate(MeasureContext& context) {
  const Scene scene = readBuiltinScene("plate_between_soft_fingers");
  const double exact = exact::leastFrictionOfOffsetPlate(0.08, 0.01, 0.005, 2, kVerifyG);
  int done = 0;
  const auto holds = [&](double mu) {
    context.progress(done++ / 30.0);
    Scene trial = scene;
    setFriction(trial, mu);
    Simulation sim(std::move(trial));
    MeasureContext quiet;
    runThrough(sim, quiet, [] {});
    return angleBetween(Quat::Identity(), sim.bodyPose(0).q) < 1e-6;
  };
  return {atMost("friction that just holds, relative",
                 std::abs(threshold(0.9 * exact, 1.1 * exact, 30, holds) / exact - 1), "-", 1e-6)};
}

std::vector<Record> slidingSpinningPlate(MeasureContext& context) {
  Simulation sim(readBuiltinScene("sliding_spinning_plate"));
  const double inertia = sim.model().world.bodies[0].mass * (0.2 * 0.2 + 0.2 * 0.2) / 12;
  const exact::PlateRest exact = exact::slidingSpinningPlate(0.1, inertia, 0.01, 2 * 0.4 * 1, {0.3, 0}, 20);
  double slid_until = 0, spun_until = 0;
  runThrough(sim, context, [&] {
    const auto& body = sim.state().world.bodies[0];
    if (body.v_W.norm() > 1e-9) slid_until = sim.time();
    if (engine::bodyAngularVelocity(sim.model().world, sim.state().world, 0).norm() > 1e-7) spun_until = sim.time();
  });
  const Pose rest = sim.bodyPose(0);
  const double angle = 2 * math::atan2(rest.q.x(), rest.q.w());
  // First order in the tick while the friction turns (it has the direction of the tick's end): over 14 rad of turning
  // the angle lags by 0.1, and the place, which goes round with it, by as much; a tenth of that at 0.1 ms.
  return {atMost("place of rest, error over way", (Vec2(rest.p.y(), rest.p.z()) - exact.p).norm() / exact.p.norm(), "-",
                 0.15),
          atMost("angle at rest, error over angle",
                 std::abs(std::remainder(exact.angle - angle, 2 * std::numbers::pi)) / exact.angle, "-", 1e-2),
          atMost("sliding ends before or after spinning by", 1e3 * std::abs(slid_until - spun_until), "ms", 4),
          atMost("time of rest, relative error", std::abs(slid_until / exact.time - 1), "-", 1e-2)};
}

std::vector<Record> handover(MeasureContext& context) {
  Simulation sim(readBuiltinScene("handover"));
  Pose start;
  double moved = 0, turned = 0;
  runThrough(sim, context, [&] {
    // the fingers begin 2 mm deep in the box, which slips until they are out
    if (sim.ticks() == 300) start = sim.bodyPose(0);
    if (sim.ticks() <= 300) return;
    moved = std::max(moved, (sim.bodyPose(0).p - start.p).norm());
    turned = std::max(turned, angleBetween(start.q, sim.bodyPose(0).q));
  });
  return {atMost("moved in the handover 2 -> 4 -> 2", 1e6 * moved, "um", 1), atMost("turned", turned, "rad", 1e-5)};
}

// Balls in a groove along x, pressed together by two fingers; one of them is heavier.
struct BallRow {
  int balls = 10, heavy = 0;
  double heavier = 100, mu = 0.5;
  double half_angle = std::numbers::pi / 4;  // of the groove, from the vertical [rad]
  double press = 5;                          // [N]
  double seconds = 10, settled = 1;
};
constexpr double kRowRadius = 0.008;  // of balls and fingertips [m]

grasp::FingerModel rowFinger(const char* name) {
  grasp::FingerModel finger;
  finger.name = name;
  finger.radius = kRowRadius;
  finger.coupling.stiffness.setZero();
  finger.coupling.damping = Vec3(5, 0, 0);
  finger.coupling.mass = 0.05;
  finger.coupling.locked = {false, true, true};
  return finger;
}

// Returns how far one of the balls, of 10 g, goes once it has settled at most [m]; adds to the ticks that were flagged.
double pressRow(const BallRow& row, std::int64_t& flagged) {
  const double up = kRowRadius / math::sin(row.half_angle);
  engine::WorldBuilder builder{engine::WorldOptions{}};
  std::vector<engine::BodyStart> starts;
  for (int i = 0; i < row.balls; ++i) {
    builder.addBody({"ball" + std::to_string(i),
                     contact::Sphere{kRowRadius},
                     true,
                     i == row.heavy ? 0.01 * row.heavier : 0.01,
                     {row.mu, row.mu}});
    starts.push_back({{Quat::Identity(), Vec3(2 * kRowRadius * i, 0, up)}});
  }
  std::vector<grasp::FingerInput> inputs(2);
  std::vector<Vec3> places;
  for (const int end : {0, 1}) {
    const double side = end == 0 ? -1 : 1;
    builder.addBody({end == 0 ? "near" : "far", contact::HalfSpace{}, false, 0, {row.mu, row.mu}});
    starts.push_back(
        {{quatFromRotationVector(Vec3(side * (0.5 * std::numbers::pi - row.half_angle), 0, 0)), Vec3::Zero()}});
    places.push_back(Vec3(2 * kRowRadius * (end == 0 ? -1 : row.balls), 0, up));
    inputs[static_cast<std::size_t>(end)].p_WF = places.back();
    inputs[static_cast<std::size_t>(end)].f_W = Vec3(-side * row.press, 0, 0);
  }
  const grasp::GraspModel model = grasp::buildGrasp(std::move(builder), {rowFinger("left"), rowFinger("right")});
  grasp::GraspState state = grasp::makeState(model, starts, places);
  const grasp::ScratchHandle scratch = grasp::makeScratch(model);
  std::vector<engine::BodyState> pressed;  // the press, which comes all at once, has been taken up
  double furthest = 0;
  Standstill rests;
  const int judged = static_cast<int>(1000 * row.settled);
  for (int tick = 0; tick < 1000 * row.seconds && !rests.noted(state.world); ++tick) {
    flagged += grasp::step(model, state, *scratch, inputs).status != engine::kStepOk;
    if (tick == judged) pressed = state.world.bodies;
    for (std::size_t i = 0; i < static_cast<std::size_t>(row.balls) && tick > judged; ++i)
      furthest = std::max(furthest, (state.world.bodies[i].X_WI.p - pressed[i].X_WI.p).norm());
  }
  return furthest;
}

std::vector<Record> row(MeasureContext&) {
  double moved = 0;
  std::int64_t flagged = 0;
  for (const int heavy : {0, 5, 9}) {
    for (const double press : {5.0, 50.0}) moved = std::max(moved, pressRow({.heavy = heavy, .press = press}, flagged));
  }
  return {atMost("furthest of any ball from 1 to 10 s", 1e6 * moved, "um", 1e-6),
          exactly("flagged ticks", static_cast<double>(flagged), "-", 0)};
}

// Rows of 3 to 30 balls, all presses and places of the heavy one with --long. Of 20 balls on rows have more contacts
// than are solved to round-off: balls settle by the accuracy of 1e-6 m/s, for some ticks. Of 40, the last a thousand
// times as heavy, pressed by 50 N with mu 1, one spins between its neighbours: the row arches.
std::vector<Record> rows(MeasureContext& context) {
  constexpr int kManyBalls = 20;
  const double settled = context.thorough ? 3 : 1;  // [s]
  double few = 0, many = 0, runs = 0;
  std::int64_t flagged = 0;
  for (const int balls :
       context.thorough ? std::vector<int>{3, 4, 5, 7, 10, 12, 15, 20, 30} : std::vector<int>{3, 10, 15, 20}) {
    double& furthest = balls < kManyBalls ? few : many;
    for (const double heavier : {1.0, 100.0, 1000.0}) {
      for (const double mu : {0.1, 0.3, 0.5, 1.0}) {
        for (const double degrees : {30.0, 45.0, 60.0}) {
          for (const bool hard : {true, false}) {
            for (int k = 0; k < (context.thorough ? 3 : hard) && !context.interrupted(); ++k, ++runs) {
              furthest = std::max(furthest,
                                  pressRow({balls, k * (balls - 1) / 2, heavier, mu, degrees * std::numbers::pi / 180,
                                            hard ? 50.0 : 5.0, context.thorough ? 60.0 : 2.0, settled},
                                           flagged));
            }
          }
        }
      }
    }
  }
  const std::string after = context.thorough ? " after 3 s" : " after 1 s";
  return {
      unbounded("rows", runs, "-"),
      atMost("furthest of any ball" + after + ", rows of up to 15", 1e6 * few, "um", context.thorough ? 1e-4 : 1e-5),
      atMost("furthest of any ball" + after + ", rows of 20 and more", 1e6 * many, "um", 1e-2),
      exactly("flagged ticks", static_cast<double>(flagged), "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyPinches() {
  return {{"pinch/hold", [](MeasureContext& c) { return hold("s4_pinch", 60, c); }},
          {"pinch/hold-1.02", [](MeasureContext& c) { return hold("s4_pinch_102", 60, c); }},
          {"pinch/slip-0.98", slipOut},
          {"pinch/flat-slide-0.98", flatSlide},
          {"pinch/threshold", holdThreshold},
          {"pinch/lift", lift},
          {"pinch/offset-plate", offsetPlate},
          {"pinch/sliding-spinning-plate", slidingSpinningPlate},
          {"pinch/handover", handover},
          {"pinch/row", row},
          {"pinch/rows", rows}};
}

}  // namespace pincer::tasks
