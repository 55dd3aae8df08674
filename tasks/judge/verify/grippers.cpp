// Grippers made of joints: what they hold stays, slips when it must, and pushes back with what it weighs.
//
//   carry      the scene jaws_gripper: each tick the contact forces on the box are m (a - g); no creep between the jaws afterwards
//   threshold  a cube between two geared jaws, F at the gear: it holds while mu >= m g/F
//   objects    other shapes in the same jaws
#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kBox = 1, kPalm = 2, kLeft = 3, kRight = 4;  // bodies of jaws_gripper

Vec3 contactForce(const Simulation& sim) {
  const engine::WorldScratch& world = grasp::worldOf(sim.scratch());
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < engine::contactCount(world); ++k) {
    const engine::ContactReport c = engine::contactAt(world, k);
    if (c.body == static_cast<int>(kBox)) sum -= c.f_W;
    if (c.other_body == static_cast<int>(kBox)) sum += c.f_W;
  }
  return sum;
}

Pose inPalm(const Simulation& sim) { return sim.bodyPose(kPalm).inverse() * sim.bodyPose(kBox); }

std::vector<Record> carry(MeasureContext& context) {
  Scene scene = readBuiltinScene("jaws_gripper");
  scene.duration = context.thorough ? 600 : 60;
  Simulation sim(std::move(scene));
  const double h = sim.scene().options.h, mass = sim.model().world.bodies[kBox].mass;
  double imbalance = 0, creep = 0, slip = 0;
  Vec3 before = Vec3::Zero();
  Pose gripped, held;
  engine::StepReport report;
  RunCount count;
  for (std::int64_t n = 0; n < sim.scene().ticks() && !context.interrupted(); ++n) {
    report = sim.tick();
    count.flagged += report.status != engine::kStepOk;
    const Vec3 v_W = sim.state().world.bodies[kBox].v_W;
    // A tick that is cut reports the forces of its last part; one that sleeps those of the tick that it repeats.
    if (report.parts == 1 && sim.time() > 0.7) {
      const Vec3 needed = mass * ((v_W - before) / h + Vec3(0, 0, kVerifyG));
      imbalance = std::max(imbalance, (contactForce(sim) - needed).norm());
    }
    before = v_W;
    if (n == 700) gripped = inPalm(sim);
    if (n == 5000) held = inPalm(sim);
    if (n > 700) slip = std::max(slip, (inPalm(sim).p - gripped.p).norm());
    if (n > 5000) creep = std::max(creep, (inPalm(sim).p - held.p).norm());
    if (n % 4096 == 0) context.progress(static_cast<double>(n) / static_cast<double>(sim.scene().ticks()));
  }
  return {atMost("sum of contact forces less m (a - g), largest", imbalance, "N", 1e-9),
          atMost("moved between the jaws while it was carried and turned", 1e6 * slip, "um", 0.1),
          atMost("creep between the jaws after that", 1e6 * creep, "um", 1e-6),
          exactly("flagged ticks", static_cast<double>(count.flagged), "-", 0)};
}

// The scene's gripper at rest, closed on what it holds in the air, with `force` at the gear and friction `mu`.
Scene heldInTheAir(double force, double mu) {
  Scene scene = readBuiltinScene("jaws_gripper");
  scene.duration = 1;
  scene.expectations.clear();
  scene.motions[0] = {Trajectory::throughKeyframes({{0, {0, 0, 1.055}, Vec3::Zero()}}),
                      Trajectory::throughKeyframes({{0, Vec3::Zero(), Vec3::Zero()}})};
  setFriction(scene, mu);
  scene.starts[kBox].X_WB.p.z() = 1;
  scene.starts[kPalm].X_WB.p.z() = 1.055;
  for (const std::size_t jaw : {kLeft, kRight}) {
    scene.starts[jaw].X_WB.p.z() = 1.015;
    scene.starts[jaw].X_WB.p.x() = jaw == kLeft ? -0.025 : 0.025;
  }
  engine::DriveModel& drive = scene.drives[0].model;
  drive.control = engine::DriveModel::Control::kForce;
  drive.stiffness = drive.damping = 0;
  scene.drives[0].control = Trajectory::throughKeyframes({{0, {force, 0, 0}, Vec3::Zero()}});
  return scene;
}

// How far what is held has dropped after 1 s [m].
double dropped(Scene scene) {
  Simulation sim(std::move(scene));
  const double start = sim.bodyPose(kBox).p.z();
  MeasureContext quiet;
  const RunCount count = runThrough(sim, quiet, [] {});
  return count.flagged > 0 ? std::nan("") : start - sim.bodyPose(kBox).p.z();
}

std::vector<Record> gripThreshold(MeasureContext& context) {
  constexpr double kForce = 15, kMass = 0.064, kLimit = kMass * kVerifyG / kForce;
  int done = 0;
  const double edge = threshold(0.9, 1.1, 30, [&](double ratio) {
    context.progress(done++ / 32.0);
    return dropped(heldInTheAir(kForce, ratio * kLimit)) < 1e-9;
  });
  const double slides = dropped(heldInTheAir(kForce, 0.999 * kLimit)), exact = 0.5 * 0.001 * kVerifyG;
  return {atMost("friction that just holds over m g/F, less 1", std::abs(edge - 1), "-", 1e-8),
          atMost("drop in 1 s at 1.001", 1e6 * dropped(heldInTheAir(kForce, 1.001 * kLimit)), "um", 1e-6),
          atMost("drop in 1 s at .999, relative error", std::abs(slides / exact - 1), "-", 1e-6)};
}

// Creep in the last 55 s of a minute, of what fits between jaws 40 mm apart [um].
double creepOf(const contact::Shape& shape, MeasureContext& context) {
  Scene scene = heldInTheAir(15, 0.6);
  scene.bodies[kBox].shape = shape;
  scene.duration = 60;
  Simulation sim(std::move(scene));
  Pose held;
  double creep = 0;
  const RunCount count = runThrough(sim, context, [&] {
    if (sim.ticks() == 5000) held = inPalm(sim);
    if (sim.ticks() > 5000) creep = std::max(creep, (inPalm(sim).p - held.p).norm());
  });
  return count.flagged > 0 ? std::nan("") : 1e6 * creep;
}

std::vector<Record> objects(MeasureContext& context) {
  return {atMost("creep of an upright cylinder", creepOf(contact::Cylinder{0.02, 0.02}, context), "um", 1e-6),
          atMost("creep of a ball", creepOf(contact::Sphere{0.02}, context), "um", 1e-6),
          atMost("creep of an upright capsule", creepOf(contact::Capsule{0.02, 0.015}, context), "um", 1e-6)};
}

}  // namespace

std::vector<Measurement> verifyGrippers() {
  return {{"tree/gripper", carry}, {"tree/grip-threshold", gripThreshold}, {"tree/objects", objects}};
}

}  // namespace pincer::tasks
