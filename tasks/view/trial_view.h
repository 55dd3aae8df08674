// trial_view: trials of an experiment in a window: a simulated participant's to watch, or one's own with the mouse.
#pragma once
#include <memory>
#include <string>

#include "pincer/tasks/lab/experiments/hands_cycle.h"
#include "pincer/tasks/lab/finger/answer_box.h"
#include "pincer/tasks/view/view_run.h"

namespace pincer::tasks {

// --view, --no-keys and --blind.
void addTrialViewOptions(CLI::App& command, ViewOptions& options);

class TrialStage {
 public:
  virtual ~TrialStage() = default;
  virtual TrialHost host() = 0;   // valid as long as this lives
  virtual AnswerBox& keys() = 0;  // that the window's keyboard fills
};

// Null when nobody watches. Throws InputError for devices that need a window and have none,
// devices::DisplayError where there is no display.
std::unique_ptr<TrialStage> hostOf(const std::string& devices, const ViewOptions& view, const ServoOptions& servo,
                                   const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
