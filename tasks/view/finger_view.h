// finger_view: trials with one finger in a window: a simulated participant's to watch, or one's own with the
// mouse; keys answer, pages are read there.
#pragma once
#include <memory>
#include <string>

#include "pincer/tasks/lab/finger/answer_box.h"
#include "pincer/tasks/lab/finger/finger_host.h"
#include "pincer/tasks/view/view_run.h"

namespace pincer::tasks {

class FingerStage {
 public:
  virtual ~FingerStage() = default;
  // Valid as long as this lives. Serves and shows; brings the finger where the mouse is one.
  virtual FingerHost host() = 0;
  virtual AnswerBox& keys() = 0;
};

// Null when nobody watches. Throws InputError for devices that need a window and have none,
// devices::DisplayError where there is no display.
std::unique_ptr<FingerStage> fingerStageOf(const std::string& devices, const ViewOptions& view,
                                           const ServoOptions& servo, const std::atomic<bool>& interrupted);

// A hint for somebody who sees the pad and is to feel something: how to touch, and where the ring is from the tactor's
// dot. Empty: there is none, as where the instruction itself says what to do.
const char* fingerHint(const FingerTrialSetup& asked, const FingerTold& told, const FingerSnapshot& finger);

// A trial's state as a snapshot sized for what it pictures. Allocates nothing. `blind`: whoever
// watches sees no more than a person who does it.
void captureFinger(const FingerTrial& trial, const TrialPlace& place, bool blind, Snapshot& snapshot);

}  // namespace pincer::tasks
