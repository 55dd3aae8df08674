#include "tasks/app/sim_view.h"

#include <fmt/format.h>

#include "tasks/measure/timing.h"
#include "tasks/view/painter.h"

namespace pincer::tasks {
namespace {

void captureSimulation(const Simulation& simulation, const engine::StepReport& report, Snapshot& snapshot) {
  captureGrasp(simulation.model(), simulation.state(), simulation.scratch(), report, snapshot);
}

// The scene's ticks, each published; fingers from the scene or from the hand.
class SceneCycle final : public ServoCycle {
 public:
  SceneCycle(Simulation& simulation, SnapshotChannel& channel, devices::MouseHand* hand)
      : simulation_(simulation), channel_(channel), hand_(hand), inputs_(simulation.scene().fingers.size()) {}

  bool tick(double) override {
    const double start = steadySeconds();
    const engine::StepReport report = hand_ ? handTick() : simulation_.tick();
    Snapshot& snapshot = channel_.writable();
    captureSimulation(simulation_, report, snapshot);
    snapshot.tick_seconds = steadySeconds() - start;
    channel_.publish();
    const bool broke = (report.status & engine::kStateNotFinite) != 0;
    return !broke && (hand_ || simulation_.ticks() < simulation_.scene().ticks());
  }
  void cutForces() noexcept override {}  // nobody feels any

 private:
  engine::StepReport handTick() {
    hand_->advance(simulation_.scene().options.h);
    for (int i = 0; i < hand_->fingers(); ++i) {
      grasp::FingerInput& input = inputs_[static_cast<std::size_t>(i)];
      input.p_WF = hand_->place_H(i);
      input.v_WF = hand_->velocity_H(i);
    }
    const engine::StepReport report = simulation_.tick(inputs_);
    for (int i = 0; i < hand_->fingers(); ++i) {
      hand_->commandForce_H(i, simulation_.scratch().fingers[static_cast<std::size_t>(i)].f_user_W);
    }
    return report;
  }

  Simulation& simulation_;
  SnapshotChannel& channel_;
  devices::MouseHand* hand_;
  std::vector<grasp::FingerInput> inputs_;
};

std::vector<devices::MouseMount> mouseMountsOf(const Scene& scene) {
  if (scene.fingers.empty() || scene.fingers.size() > 2) {
    throw InputError(fmt::format("{}: a mouse moves one or two fingers, and this scene has {}. Take a scene with one or two, or watch it without --devices mouse.",
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

}  // namespace

Image pictureOf(const Simulation& simulation) {
  const auto surface = devices::openOffscreen({});
  Snapshot snapshot = Snapshot::sizedFor(simulation.model());
  captureSimulation(simulation, {}, snapshot);
  Painter painter(*surface, simulation.model(), snapshot);
  painter.draw(snapshot, {});
  return painter.picture();
}

ServoReport watchScene(Simulation& simulation, const ViewOptions& options, bool mouse, const std::atomic<bool>& interrupted) {
  std::optional<devices::MouseHand> hand;
  if (mouse) hand.emplace(mouseMountsOf(simulation.scene()));
  Snapshot start = Snapshot::sizedFor(simulation.model());
  captureSimulation(simulation, {}, start);
  SnapshotChannel channel(start);
  SceneCycle cycle(simulation, channel, hand ? &*hand : nullptr);
  ServoOptions servo;
  servo.rate = 1 / simulation.scene().options.h;
  return runWatched({cycle, simulation.model(), start, channel, hand ? &*hand : nullptr}, servo, options, interrupted);
}

}  // namespace pincer::tasks
