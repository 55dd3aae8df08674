#include "tasks/app/trial_view.h"

#include <CLI/CLI.hpp>

#include "contact/error.h"
#include "devices/window/surface.h"
#include "tasks/experiments/mouse_hands.h"
#include "tasks/measure/timing.h"

namespace pincer::tasks {
namespace {

void captureMount(const HandsCycle& cycle, std::size_t i, const FingerInputs& sample, FingerSnapshot& finger) {
  const MountState& mount = cycle.trial().state().mounts[i];
  const FingerOutputs& output = cycle.trial().outputs()[i];
  finger.q_WF = cycle.trial().scratch().inputs[i].q_WF;
  finger.has_device = finger.has_display = true;
  finger.device = sample.arm.valid ? devices::DeviceState::kReady : devices::DeviceState::kFaulted;
  finger.trip = mount.gate.trip;
  finger.armed = mount.gate.armed;
  finger.tactor_L = sample.tactile.valid ? sample.tactile.place_L : std::nullopt;
  finger.tactor_wanted_L = output.tactile.place_L;
  finger.tactor_parked = output.tactile.parked;
}

// What the person is told, by the last tone.
struct TrialWords {
  const char* stage;
  const char* instruction;
};
TrialWords wordsAfter(Cue cue) {
  switch (cue) {
    case Cue::kStart:
      return {"go", "Pinch the object, lift it by 50 mm and hold it for a second"};
    case Cue::kSuccess:
      return {"success", "Done: let go"};
    case Cue::kEnd:
      return {"over", "The time is over: let go"};
    default:
      return {"get ready", "Wait for the start"};
  }
}

// A trial's ticks, each published.
class PublishedTrial final : public ServoCycle {
 public:
  PublishedTrial(HandsCycle& cycle, SnapshotChannel& channel, const TrialSnapshot& trial)
      : cycle_(cycle), channel_(channel), trial_(trial) {}

  bool tick(double now) override {
    const double start = steadySeconds();
    const bool more = cycle_.tick(now);
    if (cycle_.trial().cue() != Cue::kNone) {
      const TrialWords words = wordsAfter(cycle_.trial().cue());
      trial_.stage = words.stage;
      trial_.instruction = words.instruction;
    }
    fill(channel_.writable());
    channel_.writable().tick_seconds = steadySeconds() - start;
    channel_.publish();
    return more;
  }
  void cutForces() noexcept override { cycle_.cutForces(); }

  void fill(Snapshot& snapshot) {
    const HandTrial& trial = cycle_.trial();
    captureGrasp(trial.scene().model.grasp, trial.state().grasp, trial.scratch().grasp, {}, snapshot);
    const auto& samples = cycle_.hands().sample();
    for (std::size_t i = 0; i < snapshot.fingers.size(); ++i) captureMount(cycle_, i, samples[i], snapshot.fingers[i]);
    snapshot.trial = trial_;
  }

 private:
  HandsCycle& cycle_;
  SnapshotChannel& channel_;
  TrialSnapshot trial_;
};

class WindowStage final : public TrialStage {
 public:
  WindowStage(bool mouse, const ViewOptions& view, const ServoOptions& servo, const std::atomic<bool>& interrupted)
      : mouse_(mouse), view_(view), servo_(servo), interrupted_(interrupted), surface_(devices::openWindow({"pincer " + view.title})) {}

  TrialHost host() override {
    TrialHost host;
    if (mouse_) {
      host.hands = [this](HandTrial& trial) {
        auto hands = std::make_unique<MouseHands>(trial.scene());
        hand_ = &hands->hand();
        return hands;
      };
    }
    host.serve = [this](HandsCycle& cycle, std::size_t trial, std::size_t trials) { return serve(cycle, trial, trials); };
    return host;
  }

 private:
  ServoReport serve(HandsCycle& cycle, std::size_t trial, std::size_t trials) {
    const grasp::GraspModel& model = cycle.trial().scene().model.grasp;
    const TrialWords words = wordsAfter(Cue::kNone);
    TrialSnapshot told;
    told.stage = words.stage;
    told.instruction = words.instruction;
    told.condition = cycle.trial().scene().model.mounts[0].display_tactile ? "cld+force" : "force";
    told.trial = static_cast<std::int64_t>(trial) + 1;
    told.trials = static_cast<std::int64_t>(trials);
    told.blind = view_.blind;
    Snapshot start = Snapshot::sizedFor(model);
    SnapshotChannel channel(start);
    PublishedTrial published(cycle, channel, told);
    published.fill(start);
    channel.writable() = start;
    channel.publish();
    return runWatched({published, model, start, channel, mouse_ ? hand_ : nullptr}, servo_, view_, interrupted_, *surface_);
  }

  bool mouse_;
  ViewOptions view_;
  ServoOptions servo_;
  const std::atomic<bool>& interrupted_;
  std::unique_ptr<devices::Surface> surface_;
  devices::MouseHand* hand_ = nullptr;  // of the trial that runs
};

}  // namespace

void addTrialViewOptions(CLI::App& command, ViewOptions& options) {
  addViewOptions(command, options);
  command.add_flag("--blind", options.blind, "In the window show neither object nor fingers nor forces, as the protocol asks of a person");
}

std::unique_ptr<TrialStage> hostOf(const std::string& devices, const ViewOptions& view, const ServoOptions& servo,
                                   const std::atomic<bool>& interrupted) {
  if (devices == "mouse" && !view.view) {
    throw InputError("run: --devices mouse moves the fingers in the window that --view opens. Add --view, or leave --devices out.");
  }
  if (!view.view) return nullptr;
  return std::make_unique<WindowStage>(devices == "mouse", view, servo, interrupted);
}

}  // namespace pincer::tasks
