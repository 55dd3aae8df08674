#include <gtest/gtest.h>

#include "pincer/tasks/lab/experiments/manipulation_study.h"
#include "pincer/tasks/lab/experiments/simulated_trial.h"
#include "pincer/tasks/view/trial_recording.h"
#include "pincer/tasks/view/viewer.h"
#include "pincer/tests/support/memory_sink.h"

namespace pincer::tasks {
namespace {

using devices::InputKind;

constexpr devices::SurfaceSize kSize{640, 360};

// A trial of the study by its simulated participant, whole.
struct RecordedTask {
  explicit RecordedTask(HandTask task) {
    const ManipulationStudy study;
    const PickupObjects objects = makePickupObjects(study);
    for (const ManipulationTrial& spec : manipulationTrials(study)) {
      if (spec.task != task) continue;
      participant = makeParticipant(study, spec);
      trial.emplace(makeTrial(study, objects, spec, sink), *participant);
      recording = recordTrial(trial->cycle(), 2, 40, never);
      return;
    }
  }
  const grasp::GraspModel& model() { return trial->trial().scene().model.grasp; }
  const Snapshot& last() { return recording->history.at(recording->history.size() - 1); }

  tests::MemorySink sink;
  std::unique_ptr<Participant> participant;
  std::optional<SimulatedTrial> trial;
  std::optional<TrialRecording> recording;
  std::atomic<bool> never{false};
};

class RecordingViewer {
 public:
  explicit RecordingViewer(RecordedTask& task, double time = 0)
      : channel_(task.last()), viewer_(*surface_, task.model(), task.last(), channel_, pace_, nullptr, {}) {
    viewer_.showRecording(task.recording->history, time);
    pace_.paused = true;
  }
  void key(int code) { viewer_.handle({InputKind::kKey, code, true, 0, 0, {}}); }
  Viewer& viewer() { return viewer_; }

 private:
  std::unique_ptr<devices::Surface> surface_ = devices::openOffscreen(kSize);
  SnapshotChannel channel_;
  PaceControl pace_;
  Viewer viewer_;
};

// Share of the picture's pixels that are clearly more red than blue: objects, skin.
double warmShare(const Image& image) {
  int warm = 0;
  for (std::size_t i = 0; i < image.bytes.size(); i += 3) warm += image.bytes[i] > image.bytes[i + 2] + 40;
  return 3.0 * warm / static_cast<double>(image.bytes.size());
}

TEST(Recording, OfBothTasksShowsObjectAndHandsWithTheirWords) {
  for (const HandTask task : {HandTask::kPickup, HandTask::kAlignment}) {
    RecordedTask recorded(task);
    ASSERT_GT(recorded.recording->history.size(), 2000u);
    EXPECT_EQ(recorded.recording->report.ticks, static_cast<std::int64_t>(recorded.recording->history.size()));
    EXPECT_EQ(recorded.last().trial.trial, 3);
    bool told = false;
    for (std::size_t i = 0; i < recorded.recording->history.size(); ++i)
      told = told ||
             recorded.recording->history.at(i).trial.instruction == std::string(recorded.trial->trial().instruction());
    EXPECT_TRUE(told);
    RecordingViewer window(recorded, 1);
    window.viewer().choice().overlay = false;
    window.viewer().look();
    EXPECT_GT(warmShare(window.viewer().picture()), 0.01);  // sky, floor and dish are cold
  }
}

TEST(Recording, IsScrubbedByKeysAndByTheBar) {
  RecordedTask recorded(HandTask::kPickup);
  RecordingViewer window(recorded);
  Viewer& viewer = window.viewer();
  const double first = recorded.recording->history.at(0).time, last = recorded.last().time;
  EXPECT_EQ(viewer.shown().time, first);
  window.key(devices::kKeyRight);
  EXPECT_NEAR(viewer.shown().time, first + 1e-3, 1e-9);  // a tick
  window.key(devices::kKeyEnd);
  EXPECT_NEAR(viewer.shown().time, first + 1.001, 1e-9);
  window.key(devices::kKeyHome);
  window.key(devices::kKeyHome);
  EXPECT_EQ(viewer.shown().time, first);  // not before it
  window.key(devices::kKeyBackspace);
  EXPECT_EQ(viewer.shown().time, last);
  // it has a border of 14 pixels on either side
  const auto onBar = [](double share) { return 14 + share * (kSize.width - 28); };
  viewer.handle({InputKind::kMove, 0, false, onBar(0.25), kSize.height - 2.0, {}});
  viewer.handle({InputKind::kButton, devices::kButtonLeft, true, 0, 0, {}});
  EXPECT_NEAR(viewer.shown().time, first + 0.25 * (last - first), 2e-3);
  const double yaw = viewer.painter().camera().yaw;
  viewer.handle({InputKind::kMove, 0, false, onBar(0.75), kSize.height - 40.0, {}});  // held, it may leave the bar
  EXPECT_NEAR(viewer.shown().time, first + 0.75 * (last - first), 2e-3);
  EXPECT_EQ(viewer.painter().camera().yaw, yaw) << "the camera stays while the bar is held";
}

}  // namespace
}  // namespace pincer::tasks
