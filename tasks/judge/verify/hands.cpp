// Hands that hold: what their fingers press with, and that forces are in balance while they are shaken.
//
//   hand     the scene robot_grip: its drive gives each finger (200 q - 0.03 u)/2, for several widths and controls
//   shaken   the scene three_finger_hand, its targets off by normal numbers drawn ten times a second: in each tick the
//            contact forces on the ball are m (a - g); of 0.005 rad it is held, of 0.025 rad also shaken out at times
#include <algorithm>

#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

std::size_t bodyOf(const Scene& scene, std::string_view name) {
  const auto found =
      std::find_if(scene.bodies.begin(), scene.bodies.end(), [&](const auto& body) { return body.name == name; });
  return static_cast<std::size_t>(found - scene.bodies.begin());
}

struct Grip {
  double force_error = 0, creep = 0;  // [N], [um]
};

// A cube of this width in the scene's hand, told u.
Grip grip(double width, double control, double seconds, MeasureContext& context) {
  Scene scene = readBuiltinScene("robot_grip");
  scene.expectations.clear();
  scene.duration = seconds;
  const std::size_t cube = bodyOf(scene, "cube"), palm = bodyOf(scene, "hand_palm");
  scene.bodies[cube].shape = contact::Box{Vec3(0.02, 0.5 * width, 0.02)};
  scene.drives[0].control =
      Trajectory::throughKeyframes({{0, {200, 0, 0}, Vec3::Zero()}, {0.5, {control, 0, 0}, Vec3::Zero()}});
  const Quantity left = quantityOf("cube|hand_left.normal_force", scene),
                 right = quantityOf("cube|hand_right.normal_force", scene);
  Simulation sim(std::move(scene));
  const double expected = 0.5 * (200 * 0.5 * width - 0.03 * control);
  Grip out;
  Pose held;
  const auto inPalm = [&] {
    return sim.bodyPose(static_cast<int>(palm)).inverse() * sim.bodyPose(static_cast<int>(cube));
  };
  const RunCount count = runThrough(sim, context, [&] {
    if (sim.ticks() == 5000) held = inPalm();
    if (sim.ticks() < 5000) return;
    out.creep = std::max(out.creep, 1e6 * (inPalm().p - held.p).norm());
    for (const Quantity& force : {left, right})
      out.force_error = std::max(out.force_error, std::abs(force.measure(sim.moment()) - expected));
  });
  return count.flagged > 0 ? Grip{std::nan(""), std::nan("")} : out;
}

std::vector<Record> hand(MeasureContext& context) {
  const double seconds = context.thorough ? 600 : 60;
  Grip worst;
  for (const auto& [width, control] : {std::pair(0.04, 0.0), std::pair(0.04, 60.0), std::pair(0.03, 0.0),
                                       std::pair(0.05, 0.0), std::pair(0.05, 120.0)}) {
    const Grip one = grip(width, control, seconds, context);
    worst.force_error = std::isnan(one.force_error) ? one.force_error : std::max(worst.force_error, one.force_error);
    worst.creep = std::max(worst.creep, one.creep);
  }
  return {atMost("force of each finger less (200 q - 0.03 u)/2", worst.force_error, "N", 1e-9),
          atMost("creep after 5 s", worst.creep, "um", 1e-6)};
}

// The same places, each off by a normal number of this deviation ten times a second from `from` on.
Trajectory shaken(const Trajectory& told, double from, double until, double deviation, Random& random) {
  constexpr double kEvery = 0.1;  // [s]
  std::vector<TimedPoint> points;
  for (int n = 0; n * kEvery < until + 0.5 * kEvery; ++n) {
    const double time = n * kEvery, off = time < from ? 0 : deviation * random.normal();
    points.push_back({time, told.at(time).p_W + Vec3(off, 0, 0), Vec3::Zero()});
  }
  return Trajectory::throughKeyframes(std::move(points));
}

Vec3 contactForceOn(int body, const Simulation& sim) {
  const engine::WorldScratch& world = grasp::worldOf(sim.scratch());
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < engine::contactCount(world); ++k) {
    const engine::ContactReport c = engine::contactAt(world, k);
    if (c.body == body) sum -= c.f_W;
    if (c.other_body == body) sum += c.f_W;
  }
  return sum;
}

struct ShakenHand {
  double imbalance = 0, lowest = 0;       // [N], [m]
  std::int64_t flagged = 0, pressed = 0;  // ticks; `pressed`: something pushed
};

ShakenHand shakeHand(double deviation, std::uint64_t seed, MeasureContext& context) {
  constexpr double kHeldFrom = 1.2;  // its stand is gone [s]
  Scene scene = readBuiltinScene("three_finger_hand");
  scene.expectations.clear();
  Random random(seed);
  for (SceneDrive& drive : scene.drives) {
    drive.control = shaken(drive.control, kHeldFrom, scene.duration, deviation, random);
    drive.moves = true;
  }
  const int ball = static_cast<int>(bodyOf(scene, "ball"));
  Simulation sim(std::move(scene));
  const double h = sim.scene().options.h, mass = sim.model().world.bodies[static_cast<std::size_t>(ball)].mass;
  Vec3 before = Vec3::Zero();
  ShakenHand out{.lowest = kInfinity};
  while (sim.ticks() < sim.scene().ticks() && !context.interrupted()) {
    const engine::StepReport report = sim.tick();
    const Vec3 v_W = sim.state().world.bodies[static_cast<std::size_t>(ball)].v_W;
    if (sim.time() > kHeldFrom) {
      out.flagged += report.status != engine::kStepOk;
      out.lowest = std::min(out.lowest, sim.bodyPose(ball).p.z());
      // a tick that is cut reports the forces of its last part
      const Vec3 needed = mass * ((v_W - before) / h + Vec3(0, 0, kVerifyG)), force = contactForceOn(ball, sim);
      if (report.parts == 1) out.imbalance = std::max(out.imbalance, (force - needed).norm());
      out.pressed += force.norm() > 0;
    }
    before = v_W;
  }
  return out;
}

ShakenHand worstShaken(double deviation, MeasureContext& context) {
  constexpr int kSeeds = 5;
  ShakenHand worst{.lowest = kInfinity};
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const ShakenHand one = shakeHand(deviation, static_cast<std::uint64_t>(seed), context);
    worst.imbalance = std::max(worst.imbalance, one.imbalance);
    worst.lowest = std::min(worst.lowest, one.lowest);
    worst.flagged += one.flagged;
    worst.pressed += one.pressed;
    context.progress(static_cast<double>(seed) / kSeeds);
  }
  return worst;
}

std::vector<Record> shakenHand(MeasureContext& context) {
  const ShakenHand held = worstShaken(0.005, context), hard = worstShaken(0.025, context);
  return {atMost("sum of contact forces less m (a - g), by 0.005 rad, largest", held.imbalance, "N", 1e-9),
          atMost("likewise, by 0.025 rad", hard.imbalance, "N", 1e-9),
          atLeast("lowest place of the ball, held at 104.6 mm, by 0.005 rad", 1e3 * held.lowest, "mm", 100),
          atLeast("ticks with forces, of 28,000", static_cast<double>(held.pressed + hard.pressed), "-", 14000),
          exactly("flagged ticks", static_cast<double>(held.flagged + hard.flagged), "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyHands() { return {{"tree/hand", hand}, {"tree/shaken-hand", shakenHand}}; }

}  // namespace pincer::tasks
