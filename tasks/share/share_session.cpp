#include "pincer/tasks/share/share_session.h"

#include <fmt/format.h>

#include "pincer/tasks/share/share_scene.h"
#include "pincer/tasks/view/trial_recording.h"

namespace pincer::tasks {
namespace {

// Every so many ticks a picture, and the last tick.
PageRecording picturesOf(const std::string& title, const grasp::GraspModel& model, const History& history,
                         MeshTable& meshes) {
  PageRecording recording(title, model, history.at(0), meshes);
  const auto ticks = static_cast<std::int64_t>(history.size());
  const double seconds = history.at(history.size() - 1).time - history.at(0).time;
  const std::int64_t stride =
      ticks > 1 && seconds > 0 ? ticksPerPicture(ticks, seconds / static_cast<double>(ticks - 1)) : 1;
  for (std::int64_t i = 0; i < ticks; ++i) {
    if (i % stride == 0 || i + 1 == ticks) recording.add(history.at(static_cast<std::size_t>(i)));
  }
  return recording;
}

// How high the first body that moves is over its start.
void addHeight(PageRecording& recording, const grasp::GraspModel& model, const History& history) {
  const auto& bodies = model.world.bodies;
  std::size_t object = 0;
  while (object < bodies.size() && !bodies[object].dynamic) ++object;
  if (object == bodies.size()) return;
  const double start = history.at(0).X_WB[object].p.z();
  PageChart& chart = recording.chart("height of the object", "mm");
  for (const double time : recording.times())
    chart.values.push_back(1e3 * (history.at(history.find(time)).X_WB[object].p.z() - start));
}

}  // namespace

SharedSession recordSession(const SessionReader& session, const ReplayOptions& options, MeshTable& meshes,
                            const std::atomic<bool>& interrupted,
                            const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  SharedSession shared;
  const std::size_t trials = session.trials().size();
  const auto keep = [&](std::int64_t trial, const std::string& of, const grasp::GraspModel& model,
                        const TrialRecording& recorded) {
    if (recorded.history.size() == 0) return;  // interrupted before the first tick
    shared.recordings.push_back(
        picturesOf(fmt::format("trial {}: {}", trial + 1, of), model, recorded.history, meshes));
    shared.trials.push_back(trial);
    addHeight(shared.recordings.back(), model, recorded.history);
  };
  const auto hands = [&](HandsCycle& cycle, const TrialRecord& row) {
    const TrialRecording recorded = recordTrial(cycle, static_cast<std::size_t>(row.trial), trials, interrupted);
    keep(row.trial, fmt::format("{}, {}", row.task, row.condition), cycle.trial().scene().model.grasp, recorded);
    return recorded.report;
  };
  const auto finger = [&](FingerTrial& trial) {
    const TrialRecording recorded = recordFinger(trial, interrupted);
    const auto next = static_cast<std::int64_t>(shared.recordings.size());
    keep(options.trial.value_or(next), session.info().task, trial.pictured(), recorded);
    return recorded.report;
  };
  shared.replay = replaySession(session, options, interrupted, progress, hands, finger);
  return shared;
}

}  // namespace pincer::tasks
