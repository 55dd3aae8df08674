#include "pincer/tasks/view/sim_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/io/counted.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

void captureSimulation(const Simulation& simulation, const engine::StepReport& report, Snapshot& snapshot) {
  captureGrasp(simulation.model(), simulation.state(), simulation.scratch(), report, snapshot);
}

// "3 of 4 expectations met".
std::string verdictOf(const ExpectationLog& log) {
  const auto met = std::count_if(log.outcomes().begin(), log.outcomes().end(),
                                 [](const Outcome& o) { return o.reached && o.holds(); });
  if (log.outcomes().empty()) return "nothing was expected";
  return fmt::format("{} of {} met", met, counted(static_cast<std::int64_t>(log.outcomes().size()), "expectation"));
}

}  // namespace

SceneCycle::SceneCycle(Simulation& simulation, SnapshotChannel& channel, devices::MouseHand* hand, BodyPull* pull)
    : simulation_(simulation),
      channel_(channel),
      hand_(hand),
      pull_(pull),
      inputs_(simulation.scene().fingers.size()),
      log_(hand ? std::vector<Expectation>{} : simulation.scene().expectations) {
  judge();
  const auto& bodies = simulation.model().world.bodies;
  for (std::size_t i = 0; i < bodies.size() && object_ < 0; ++i) {
    if (bodies[i].dynamic) object_ = static_cast<int>(i);
  }
}

bool SceneCycle::tick(double) {
  const double start = steadySeconds();
  const engine::StepReport report = hand_ ? handTick() : sceneTick();
  Snapshot& snapshot = channel_.writable();
  captureSimulation(simulation_, report, snapshot);
  snapshot.tick_seconds = steadySeconds() - start;
  channel_.publish();
  noteLift();
  judge();
  const bool broke = (report.status & engine::kStateNotFinite) != 0;
  return !broke && (hand_ || simulation_.ticks() < simulation_.scene().ticks());
}

engine::StepReport SceneCycle::handTick() {
  hand_->advance(simulation_.scene().options.h);
  for (int i = 0; i < hand_->fingers(); ++i) {
    grasp::FingerInput& input = inputs_[static_cast<std::size_t>(i)];
    input.p_WF = hand_->place_H(i);
    input.v_WF = hand_->velocity_H(i);
  }
  const engine::StepReport report = simulation_.tick(inputs_);
  for (int i = 0; i < hand_->fingers(); ++i) {
    hand_->commandForce_H(i, simulation_.fingers()[static_cast<std::size_t>(i)].f_user_W);
  }
  return report;
}

engine::StepReport SceneCycle::sceneTick() {
  if (!pull_) return simulation_.tick();
  const engine::AppliedForces applied = pull_->forces(simulation_.state().world, simulation_.scene().options.h);
  return simulation_.tick(simulation_.nextFingers(), applied);
}

// After a pull the run isn't that of the scene's file any more.
void SceneCycle::judge() {
  if (pull_ && pull_->wasUsed()) return;
  log_.observe(simulation_.ticks(), simulation_.time(), simulation_.moment());
}

void SceneCycle::noteLift() {
  if (object_ < 0) return;
  const double start = simulation_.scene().starts[static_cast<std::size_t>(object_)].X_WB.p.z();
  lift_ = std::max(lift_, simulation_.bodyPose(object_).p.z() - start);
}

Snapshot snapshotOf(const Simulation& simulation) {
  Snapshot snapshot = Snapshot::sizedFor(simulation.model());
  captureSimulation(simulation, {}, snapshot);
  return snapshot;
}

std::vector<devices::MouseMount> mouseMounts(const Scene& scene) {
  if (scene.fingers.empty() || scene.fingers.size() > 2) {
    throw InputError(
        fmt::format("{}: a mouse moves one or two fingers, and this scene has {}. Take a scene with one or two, or "
                    "watch it without --devices mouse.",
                    scene.file, scene.fingers.size()));
  }
  std::vector<devices::MouseMount> mounts;
  for (const SceneFinger& finger : scene.fingers) {
    devices::MouseMount mount;
    mount.start_H = finger.trajectory.start();
    mounts.push_back(mount);
  }
  return mounts;
}

Image pictureOf(const Simulation& simulation, bool as_operator) {
  const auto surface = devices::openOffscreen({});
  const Snapshot snapshot = snapshotOf(simulation);
  SnapshotChannel channel(snapshot);
  PaceControl pace;
  Viewer viewer(*surface, simulation.model(), snapshot, channel, pace, nullptr,
                {.choose_camera = !as_operator, .camera = simulation.scene().camera});
  viewer.choice().overlay = false;
  viewer.update();
  return viewer.picture();
}

WatchResult watchScene(Simulation& simulation, const ViewOptions& options, bool mouse,
                       const std::atomic<bool>& interrupted) {
  std::optional<devices::MouseHand> hand;
  if (mouse) hand.emplace(mouseMounts(simulation.scene()));
  const Snapshot start = snapshotOf(simulation);
  SnapshotChannel channel(start);
  BodyPull pull(simulation.model());
  SceneCycle cycle(simulation, channel, hand ? &*hand : nullptr, &pull);
  ServoOptions servo;
  servo.rate = 1 / simulation.scene().options.h;
  if (!(servo.rate >= 100 && servo.rate <= 4000)) {
    throw InputError(fmt::format(
        "{}: ticks of {} s can't be watched in real time, ticks of 0.25 to 10 ms can. Take --screenshot FILE.png.",
        simulation.scene().file, simulation.scene().options.h));
  }
  const ServoReport report =
      runWatched({.cycle = cycle,
                  .model = simulation.model(),
                  .start = start,
                  .channel = channel,
                  .hand = hand ? &*hand : nullptr,
                  .linger = true,
                  .choose_camera = !mouse && !options.as_operator,
                  .camera = simulation.scene().camera,
                  .pull = mouse ? nullptr : &pull,
                  .verdict =
                      [&cycle, &pull] {
                        return pull.wasUsed() ? std::string("pulled by hand, not judged") : verdictOf(cycle.log());
                      }},
                 servo, options, interrupted);
  return {report, cycle.lift(), cycle.log(), !mouse && simulation.ticks() >= simulation.scene().ticks(),
          pull.wasUsed()};
}

}  // namespace pincer::tasks
