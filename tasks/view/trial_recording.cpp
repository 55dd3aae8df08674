#include "pincer/tasks/view/trial_recording.h"

#include <limits>

#include "pincer/devices/window/surface.h"
#include "pincer/tasks/lab/sessions/trial_capture.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tasks/view/finger_view.h"
#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

class RecordedTrial final : public ServoCycle {
 public:
  RecordedTrial(HandsCycle& cycle, TrialCapture& capture, History& history)
      : cycle_(cycle),
        capture_(capture),
        history_(history),
        snapshot_(Snapshot::sizedFor(cycle.trial().scene().model.grasp)) {}

  bool tick(double now) override {
    const double start = steadySeconds();
    const bool more = cycle_.tick(now);
    snapshot_.tick_seconds = steadySeconds() - start;
    capture_.hear();
    capture_.fill(snapshot_);
    history_.add(snapshot_);
    return more;
  }
  void cutForces() noexcept override { cycle_.cutForces(); }

 private:
  HandsCycle& cycle_;
  TrialCapture& capture_;
  History& history_;
  Snapshot snapshot_;
};

class RecordedFingerTrial final : public ServoCycle {
 public:
  RecordedFingerTrial(FingerTrial& trial, History& history)
      : trial_(trial), history_(history), snapshot_(Snapshot::sizedFor(trial.pictured())) {}

  bool tick(double now) override {
    const double start = steadySeconds();
    const bool more = trial_.tick(now);
    snapshot_.tick_seconds = steadySeconds() - start;
    captureFinger(trial_, {}, false, snapshot_);
    snapshot_.trial.blind = false;
    snapshot_.trial.shows_pads = true;
    snapshot_.tick = ++ticks_;
    snapshot_.time = now;
    history_.add(snapshot_);
    return more;
  }
  void cutForces() noexcept override { trial_.cutForces(); }

 private:
  FingerTrial& trial_;
  History& history_;
  Snapshot snapshot_;
  std::int64_t ticks_ = 0;
};

}  // namespace

TrialRecording recordFinger(FingerTrial& trial, const std::atomic<bool>& interrupted) {
  TrialRecording recording{History(std::numeric_limits<std::size_t>::max()), {}};
  RecordedFingerTrial recorded(trial, recording.history);
  recording.report = runServo({}, recorded, interrupted);
  return recording;
}

TrialRecording recordTrial(HandsCycle& cycle, std::size_t trial, std::size_t trials,
                           const std::atomic<bool>& interrupted) {
  TrialRecording recording{History(std::numeric_limits<std::size_t>::max()), {}};
  TrialCapture capture(cycle, trial, trials);
  RecordedTrial recorded(cycle, capture, recording.history);
  recording.report = runServo({}, recorded, interrupted);
  return recording;
}

void showRecording(const grasp::GraspModel& model, History recording, double time, const ViewOptions& options,
                   const std::atomic<bool>& interrupted) {
  if (recording.size() == 0) return;  // interrupted before the first tick
  const auto surface = options.view ? devices::openWindow({"pincer " + options.title}) : devices::openOffscreen({});
  const Snapshot start = recording.at(recording.find(time));
  SnapshotChannel channel(start);
  PaceControl pace;
  pace.paused = !options.view;
  Viewer viewer(*surface, model, start, channel, pace, nullptr, {options.title, options.keys});
  viewer.showRecording(std::move(recording), time);
  viewer.update();  // panels fit their text from the second picture on
  while (options.view && viewer.update() && !interrupted) {
  }
  if (!options.screenshot.empty()) writePng(viewer.picture(), options.screenshot);
}

}  // namespace pincer::tasks
