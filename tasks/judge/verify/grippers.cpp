// Grippers made of joints: what they hold stays, slips when it must, and pushes back with what it weighs.
//
//   carry      the scene jaws_gripper with a box, a cylinder, a mug held by its handle, a part that is a mesh: each
//              tick the contact forces on it are m (a - g); no creep between the jaws afterwards, in ten minutes
//              with --thorough; the same asleep as awake
//   threshold  a cube between two geared jaws, F at the gear: it holds while mu >= m g/F, with ticks of 0.1 to 4 ms
//   objects    other shapes in the same jaws
//   worm       the scene worm_clamp at rest, its motor on or off: the jaw's
//              force is (motor + dry friction) over the lead
#include <fmt/format.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/pad_run.h"
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

// The scene with something else between its jaws.
Scene gripperWith(const engine::BodySpec& object, const engine::BodyStart& start) {
  Scene scene = readBuiltinScene("jaws_gripper");
  scene.expectations.clear();
  scene.bodies[kBox] = object;
  scene.starts[kBox] = start;
  return scene;
}

// A mug stands on its side of the jaws, its handle between them; their drive pulls four times
// as hard, for the mug's weight has a lever.
Scene gripperWithMug() {
  constexpr double kHandle = 0.067, kHigher = 0.03, kStronger = 4, kThinner = 0.014;  // [m], [m], times, [m]
  const Scene mug = readBuiltinScene("mug");
  const Quat turned = quatFromRotationVector({0, 0, std::numbers::pi / 2});
  Scene scene = gripperWith(mug.bodies[1], {Pose{turned, turned * Vec3(-kHandle, 0, 0)}});
  std::vector<TimedPoint> frames{{0.8, {0, 0, 0.075 + kHigher}, Vec3::Zero()},
                                 {1.8, {0, 0, 0.175 + kHigher}, Vec3::Zero()}};
  frames.push_back({2.8, {0.1, 0, 0.175 + kHigher}, Vec3::Zero()});
  scene.motions[0].place = Trajectory::throughKeyframes(frames);
  for (const std::size_t part : {kPalm, kLeft, kRight}) scene.starts[part].X_WB.p.z() += kHigher;
  for (const std::size_t jaw : {kLeft, kRight}) scene.bodies[jaw].material = mug.bodies[1].material;
  engine::DriveModel& drive = scene.drives[0].model;
  drive.stiffness *= kStronger;
  drive.damping *= 2;
  drive.lower_force *= kStronger;
  drive.upper_force *= kStronger;
  scene.drives[0].control =
      Trajectory::throughKeyframes({{0.1, Vec3::Zero(), Vec3::Zero()}, {0.6, {0.03 + kThinner, 0, 0}, Vec3::Zero()}});
  return scene;
}

// A cube of 40 mm with edges rounded to 6 mm, of 1e3 triangles.
contact::Shape meshPart() { return contact::Mesh{contact::SmoothMesh::build(contact::roundedCube(0.02, 0.006, 4))}; }

struct Carried {
  double imbalance = 0, slip = 0, creep = 0;  // [N], [m], [m]
  std::int64_t flagged = 0;
  std::uint64_t hash = 0;
};

// Runs the scene; `slip` is from when it is gripped until it is carried, `creep` after that.
Carried carried(Scene scene, double seconds, MeasureContext& context) {
  scene.duration = seconds;
  Simulation sim(std::move(scene));
  const double h = sim.scene().options.h, mass = sim.model().world.bodies[kBox].mass;
  Carried out;
  Vec3 before = Vec3::Zero();
  Pose gripped, held;
  for (std::int64_t n = 0; n < sim.scene().ticks() && !context.interrupted(); ++n) {
    const engine::StepReport report = sim.tick();
    out.flagged += report.status != engine::kStepOk;
    const Vec3 v_W = sim.state().world.bodies[kBox].v_W;
    // A tick that is cut reports the forces of its last part; one that sleeps those of the tick that it repeats.
    if (report.parts == 1 && sim.time() > 0.7) {
      const Vec3 needed = mass * ((v_W - before) / h + Vec3(0, 0, kVerifyG));
      out.imbalance = std::max(out.imbalance, (contactForce(sim) - needed).norm());
    }
    before = v_W;
    if (n == 700) gripped = inPalm(sim);
    if (n == 5000) held = inPalm(sim);
    if (n > 700) out.slip = std::max(out.slip, (inPalm(sim).p - gripped.p).norm());
    if (n > 5000) out.creep = std::max(out.creep, (inPalm(sim).p - held.p).norm());
    if (n % 4096 == 0) context.progress(static_cast<double>(n) / static_cast<double>(sim.scene().ticks()));
  }
  out.hash = engine::hashOf(sim.state().world);
  return out;
}

struct CarryBounds {
  double slip, creep;  // [um]
};
std::vector<Record> carryIt(const Scene& scene, const CarryBounds& most, MeasureContext& context) {
  const double seconds = context.thorough ? 600 : 60;
  const Carried asleep = carried(scene, seconds, context);
  Scene awake = scene;
  awake.options.sleep = false;
  return {atMost("sum of contact forces less m (a - g), largest", asleep.imbalance, "N", 1e-9),
          atMost("moved between the jaws while it was carried and turned", 1e6 * asleep.slip, "um", most.slip),
          atMost("creep between the jaws after that", 1e6 * asleep.creep, "um", most.creep),
          exactly("other bits awake than asleep", carried(awake, 20, context).hash != carried(scene, 20, context).hash,
                  "-", 0),
          exactly("flagged ticks", static_cast<double>(asleep.flagged), "-", 0)};
}

std::vector<Record> carry(MeasureContext& context) {
  return carryIt(readBuiltinScene("jaws_gripper"), {0.1, 1e-6}, context);
}
// Round between flat jaws, it turns after them by half a tick, h w/2 = 1.2 mrad, while they turn.
std::vector<Record> carryCylinder(MeasureContext& context) {
  engine::BodySpec object = readBuiltinScene("jaws_gripper").bodies[kBox];
  object.shape = contact::Cylinder{0.02, 0.02};
  return carryIt(gripperWith(object, {Pose{Quat::Identity(), {0, 0, 0.02}}}), {2, 1e-6}, context);
}
// Its middle, 63 mm beside the axis, goes by chords of ticks: h^2 w^2 r = 0.54 um at the 2.9 rad/s of the palm,
// and back on its arc afterwards.
std::vector<Record> carryMug(MeasureContext& context) { return carryIt(gripperWithMug(), {0.54, 1e-6}, context); }
// 1e-11 m in a minute: contact with it is led anew in each tick.
std::vector<Record> carryMesh(MeasureContext& context) {
  engine::BodySpec object = readBuiltinScene("jaws_gripper").bodies[kBox];
  object.shape = meshPart();
  return carryIt(gripperWith(object, {Pose{Quat::Identity(), {0, 0, 0.02}}}), {0.1, 1e-4}, context);
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
  constexpr double kForce = 15, kMass = 0.064, kLimit = kMass * kVerifyG / kForce;  // [N], [kg], [-]
  int done = 0;
  const double edge = threshold(0.9, 1.1, 30, [&](double ratio) {
    context.progress(done++ / 42.0);
    return dropped(heldInTheAir(kForce, ratio * kLimit)) < 1e-9;
  });
  double holds = 0, slides = 0;
  for (const double h : {1e-4, 5e-4, 1e-3, 2e-3, 4e-3}) {
    const auto dropAt = [&](double ratio) {
      Scene scene = heldInTheAir(kForce, ratio * kLimit);
      scene.options.h = h;
      return dropped(std::move(scene));
    };
    holds = std::max(holds, dropAt(1.001));
    slides = std::max(slides, std::abs(dropAt(0.999) / (0.5 * 0.001 * kVerifyG) - 1));
    context.progress((done += 2) / 42.0);
  }
  return {atMost("friction that just holds over m g/F, less 1", std::abs(edge - 1), "-", 1e-8),
          atMost("drop in 1 s at 1.001, ticks of 0.1 to 4 ms", 1e6 * holds, "um", 1e-6),
          atMost("drop in 1 s at .999, relative error, ticks of 0.1 to 4 ms", slides, "-", 1e-6)};
}

// Creep after 5 s, for a minute or, of meshes, 3 s without --long, of what fits between jaws 40 mm apart [um].
double creepOf(const contact::Shape& shape, MeasureContext& context) {
  Scene scene = heldInTheAir(15, 0.6);
  constexpr double kTorsionRadius = 0.0027;  // of jaws padded with rubber [m]
  const bool is_mesh = std::holds_alternative<contact::Mesh>(shape);
  scene.bodies[kBox].shape = shape;
  if (is_mesh) scene.bodies[kBox].material.torsion_radius = kTorsionRadius;
  scene.duration = is_mesh && !context.thorough ? 8 : 60;
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
  std::vector<Record> records = {
      atMost("creep of an upright cylinder", creepOf(contact::Cylinder{0.02, 0.02}, context), "um", 1e-6),
      atMost("creep of a ball", creepOf(contact::Sphere{0.02}, context), "um", 1e-6),
      atMost("creep of an upright capsule", creepOf(contact::Capsule{0.02, 0.015}, context), "um", 1e-6)};
  for (const HeldMesh& held : heldMeshes())
    records.push_back(atMost("creep of a " + held.name, creepOf(held.shape, context), "um", 1e-4));
  return records;
}

// The largest difference between the force of the clamp's jaw and (motor + dry friction)/lead [N], once it
// is closed, with the motor on or off again.
double clampImbalance(bool stays_on, double torque, MeasureContext& context) {
  constexpr double kLead = 1.5915494309189535e-4;  // [m/rad]
  constexpr std::size_t kBlock = 1, kJaw = 2;      // places of the scene's bodies
  Scene scene = readBuiltinScene("worm_clamp");
  const double off = stays_on ? torque : 0;
  scene.drives[0].control = Trajectory::throughKeyframes({{0, Vec3::Zero(), Vec3::Zero()},
                                                          {0.1, {torque, 0, 0}, Vec3::Zero()},
                                                          {1, {torque, 0, 0}, Vec3::Zero()},
                                                          {1.1, {off, 0, 0}, Vec3::Zero()}});
  Simulation sim(std::move(scene));
  double worst = 0;
  const RunCount count = runThrough(sim, context, [&] {
    if (sim.time() < 1.9) return;
    const engine::WorldScratch& world = grasp::worldOf(sim.scratch());
    double normal = 0;
    for (int k = 0; k < engine::contactCount(world); ++k) {
      const engine::ContactReport c = engine::contactAt(world, k);
      if (std::min(c.body, c.other_body) == kBlock && std::max(c.body, c.other_body) == kJaw)
        normal += c.f_W.dot(c.n_W);
    }
    const double torques =
        engine::driveAt(world, 0).force + engine::jointAt(sim.model().world, world, 0).friction_force;
    worst = std::max(worst, std::abs(normal - torques / kLead));
  });
  return count.flagged > 0 ? std::nan("") : worst;
}

std::vector<Record> wormClamp(MeasureContext& context) {
  std::vector<Record> records;
  for (const double torque : {0.021, 0.03, 0.1}) {
    for (const bool stays_on : {true, false})
      records.push_back(atMost(fmt::format("motor of {} N m {}: jaw's force less that of the worm, largest", torque,
                                           stays_on ? "on" : "off"),
                               clampImbalance(stays_on, torque, context), "N", 1e-6));
  }
  return records;
}

}  // namespace

std::vector<Measurement> verifyGrippers() {
  return {{"tree/gripper", carry},          {"tree/gripper-cylinder", carryCylinder}, {"tree/gripper-mug", carryMug},
          {"tree/gripper-mesh", carryMesh}, {"tree/grip-threshold", gripThreshold},   {"tree/objects", objects},
          {"tree/worm-clamp", wormClamp}};
}

}  // namespace pincer::tasks
