// Boxes on slopes and floors.
#include "pincer/tasks/judge/exact/sliding_rolling.h"
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

constexpr double kSlope = 20 * std::numbers::pi / 180;  // of the S3 scenes [rad]

std::vector<Record> stick(std::string_view scene, MeasureContext& context) {
  Simulation sim(readBuiltinScene(scene));
  const Vec3 start = sim.bodyPose(1).p;
  double swing = 0, first_second = 0;
  const RunCount run = runThrough(sim, context, [&] {
    const double offset = 1e6 * (sim.bodyPose(1).p - start).norm();
    swing = std::max(swing, offset);
    if (sim.ticks() == 1000) first_second = offset;
  });
  // The rest that the solver leaves at its tolerance makes the box swing about its anchor by a few
  // 1e-15 m for some ticks; that is bounded too.
  return {atMost("creep, after 1 s", first_second, "um", 1e-9),
          atMost("creep, after 10 s", 1e6 * (sim.bodyPose(1).p - start).norm(), "um", 1e-9),
          atMost("largest swing", swing, "um", 1e-8),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

std::vector<Record> slide(std::string_view scene, double v0, double heading, MeasureContext& context) {
  Simulation sim(readBuiltinScene(scene));
  const RunCount run = runThrough(sim, context, [] {});
  const Vec3 downhill(math::cos(heading), math::sin(heading), 0), p = sim.bodyPose(1).p;
  const double way = exact::Slope{kSlope, math::tan(kSlope) / 1.05, kVerifyG}.way(v0, sim.time());
  return {atMost("way, relative error", std::abs(p.dot(downhill) / way - 1), "-", 1e-9),
          atMost("sideways, relative to the way", std::abs(p.cross(downhill).z()) / way, "-", 1e-9),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Sticks if and only if tan th <= mu, and slides with the right acceleration, over many slopes and headings.
std::vector<Record> slopes(MeasureContext& context) {
  const Scene scene = readBuiltinScene("s3_incline_stick");
  double creep = 0, slide_error = 0;
  int done = 0;
  const auto run = [&](double theta, double mu, double heading, double seconds) {
    context.progress(done++ / 60.0);
    Scene trial = scene;
    trial.duration = seconds;
    trial.options.gravity_W = tiltedGravity(theta, heading);
    setFriction(trial, mu);
    Simulation sim(std::move(trial));
    MeasureContext quiet;
    runThrough(sim, quiet, [] {});
    return Vec3(sim.bodyPose(1).p - Vec3(0, 0, 0.0125));
  };
  for (const double theta : {0.05, 0.3, 0.7, 1.0}) {
    for (const double heading : {0.0, 0.4, 1.2}) {
      for (const double ratio : {0.5, 0.999})
        creep = std::max(creep, run(theta, math::tan(theta) / ratio, heading, 0.5).norm());
      for (const double ratio : {1.001, 1.1, 3.0}) {
        const double mu = math::tan(theta) / ratio, way = exact::Slope{theta, mu, kVerifyG}.way(0, 0.5);
        const Vec3 error = run(theta, mu, heading, 0.5) - way * Vec3(math::cos(heading), math::sin(heading), 0);
        slide_error = std::max(slide_error, error.norm() / way);
      }
    }
  }
  return {// 1e-11 m: what the solver leaves at its relative tolerance of 1e-10 while
          // the box comes to rest in its first ticks.
          atMost("creep where tan th < mu", 1e6 * creep, "um", 1e-5),
          atMost("way where tan th > mu, relative error", slide_error, "-", 1e-9)};
}

// A push in any direction ends at the same distance, in that direction, and lifts nothing.
std::vector<Record> isotropy(MeasureContext& context) {
  const Scene scene = readBuiltinScene("pushed_cube");
  const exact::Stopping exact{2, 0.5, kVerifyG};
  constexpr int kHeadings = 24;  // 15 degrees apart; chosen
  double distance = 0, aside = 0, lift = 0;
  for (int i = 0; i < kHeadings; ++i) {
    context.progress(static_cast<double>(i) / kHeadings);
    const double heading = 2 * std::numbers::pi * i / kHeadings;
    const Vec3 way(math::cos(heading), math::sin(heading), 0);
    Scene trial = scene;
    trial.duration = 0.5;
    trial.starts[1].v_W = exact.v0 * way;
    Simulation sim(std::move(trial));
    MeasureContext quiet;
    runThrough(sim, quiet, [&] { lift = std::max(lift, std::abs(sim.bodyPose(1).p.z() - 0.025)); });
    const Vec3 p = sim.bodyPose(1).p;
    distance = std::max(distance, std::abs(p.dot(way) / exact.way() - 1));
    aside = std::max(aside, std::abs(p.cross(way).z()) / exact.way());
  }
  // The tick in which it stops is taken as a whole: up to mu g h^2/8 = 0.6 um of 408 mm.
  return {atMost("stopping distance over 24 headings, relative error", distance, "-", 5e-6),
          atMost("heading, largest error", aside, "rad", 1e-9), atMost("lift", 1e6 * lift, "um", 1e-6)};
}

std::vector<Record> dilation(MeasureContext& context) {
  Simulation sim(readBuiltinScene("pushed_cube"));
  const exact::Stopping exact{6, 0.5, kVerifyG};
  double lift = 0, stopped = std::nan("");
  runThrough(sim, context, [&] {
    lift = std::max(lift, std::abs(sim.bodyPose(1).p.z() - 0.025));
    if (std::isnan(stopped) && sim.state().world.bodies[1].v_W.norm() < 1e-9) stopped = sim.time();
  });
  return {atMost("lift of a cube at 6 m/s", 1e6 * lift, "um", 1e-6),
          atMost("way until it stops, relative error", std::abs(sim.bodyPose(1).p.x() / exact.way() - 1), "-", 1e-6),
          atMost("time until it stops, error", 1e3 * std::abs(stopped - exact.time()), "ms", 1)};
}

}  // namespace

std::vector<Measurement> verifySliding() {
  constexpr double k30 = std::numbers::pi / 6;
  return {{"slide/stick", [](MeasureContext& c) { return stick("s3_incline_stick", c); }},
          {"slide/stick-30deg", [](MeasureContext& c) { return stick("s3_incline_stick_30deg", c); }},
          {"slide/incline", [](MeasureContext& c) { return slide("s3_incline_slide", 0, 0, c); }},
          {"slide/incline-30deg", [](MeasureContext& c) { return slide("s3_incline_slide_30deg", 0, k30, c); }},
          {"slide/incline-30deg-moving",
           [](MeasureContext& c) { return slide("s3_incline_slide_30deg_moving", 0.1, k30, c); }},
          {"slide/slopes", slopes},
          {"slide/isotropy", isotropy},
          {"slide/no-dilation", dilation}};
}

}  // namespace pincer::tasks
