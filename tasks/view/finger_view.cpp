#include "pincer/tasks/view/finger_view.h"

#include <cmath>
#include <string_view>

#include "pincer/contact/error.h"
#include "pincer/devices/window/surface.h"
#include "pincer/tasks/lab/finger/mouse_finger.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tasks/view/page_view.h"

namespace pincer::tasks {
namespace {

// A trial's ticks, each published.
class PublishedFinger final : public ServoCycle {
 public:
  PublishedFinger(FingerTrial& trial, const TrialPlace& place, bool blind, SnapshotChannel& channel)
      : trial_(trial), place_(place), blind_(blind), channel_(channel) {}

  bool tick(double now) override {
    const double start = steadySeconds();
    const bool more = trial_.tick(now);
    Snapshot& snapshot = channel_.writable();
    captureFinger(trial_, place_, blind_, snapshot);
    snapshot.tick = ++ticks_;
    snapshot.time = now;
    snapshot.tick_seconds = steadySeconds() - start;
    channel_.publish();
    return more;
  }
  void cutForces() noexcept override { trial_.cutForces(); }

 private:
  FingerTrial& trial_;
  const TrialPlace& place_;
  const bool blind_;
  SnapshotChannel& channel_;
  std::int64_t ticks_ = 0;
};

class FingerWindow final : public FingerStage {
 public:
  FingerWindow(bool mouse, const ViewOptions& view, const ServoOptions& servo, const std::atomic<bool>& interrupted)
      : mouse_(mouse),
        view_(view),
        servo_(servo),
        interrupted_(interrupted),
        surface_(devices::openWindow({"pincer " + view.title})) {}

  FingerHost host() override {
    FingerHost host;
    if (mouse_) {
      host.finger = [this](const FingerPlace& place) {
        auto finger = std::make_unique<MouseFinger>(place, keys_);
        hand_ = &finger->hand();
        return finger;
      };
    }
    host.serve = [this](FingerTrial& trial, const TrialPlace& place) { return serve(trial, place); };
    host.show = [this](const StudyPage& page) { return showPage(*surface_, view_.title, page, interrupted_); };
    host.ask = [this](const AskedQuestion& question) {
      return askOnPage(*surface_, view_.title, question, interrupted_);
    };
    return host;
  }
  AnswerBox& keys() override { return keys_; }

 private:
  ServoReport serve(FingerTrial& trial, const TrialPlace& place) {
    const grasp::GraspModel& model = trial.pictured();
    Snapshot start = Snapshot::sizedFor(model);
    captureFinger(trial, place, view_.blind, start);
    SnapshotChannel channel(start);
    PublishedFinger published(trial, place, view_.blind, channel);
    channel.publish();
    WatchedCycle watched{published, model, start, channel, mouse_ ? hand_ : nullptr};
    watched.from_the_side = true;
    watched.answer = [this](int key) { keys_.press(key); };
    return runWatched(watched, servo_, view_, interrupted_, *surface_);
  }

  bool mouse_;
  ViewOptions view_;
  ServoOptions servo_;
  const std::atomic<bool>& interrupted_;
  std::unique_ptr<devices::Surface> surface_;
  AnswerBox keys_;
  devices::MouseHand* hand_ = nullptr;  // of the trial that runs
};

}  // namespace

const char* fingerHint(const FingerTrialSetup& asked, const FingerTold& told, const FingerSnapshot& finger) {
  const std::string_view stage = told.stage;
  const bool is_to_feel = stage == "first" || stage == "second" || stage == "feel";
  if (!is_to_feel || told.instruction != asked.texts.feel) return "";
  if (!finger.touching) return "In the air: lower the finger until it touches";
  if (!told.target || !finger.tactor_L) return "";
  const double over = finger.tactor_L->x() - *told.target;
  if (std::abs(over) <= asked.tolerance) return "There: hold still and press Enter";
  return over > 0 ? "The dot is above the ring: move to the right, away from you"
                  : "The dot is below the ring: move to the left, towards you";
}

void captureFinger(const FingerTrial& trial, const TrialPlace& place, bool blind, Snapshot& snapshot) {
  trial.fill(snapshot);
  const FingerTold told = trial.told();
  TrialSnapshot& shown = snapshot.trial;
  shown.instruction = told.instruction;
  shown.stage = told.stage;
  shown.condition = told.hidden ? "" : place.condition.c_str();
  shown.trial = place.trial;
  shown.trials = place.trials;
  shown.blind = blind || told.hidden;
  shown.shows_pads = told.shows_pad;
  shown.target = told.target;
  shown.hint = told.shows_pad ? fingerHint(trial.asked(), told, snapshot.fingers[0]) : "";
  if (shown.blind) snapshot.hidden_body = Snapshot::kAllBodies;
}

std::unique_ptr<FingerStage> fingerStageOf(const std::string& devices, const ViewOptions& view,
                                           const ServoOptions& servo, const std::atomic<bool>& interrupted) {
  if (devices == "mouse" && !view.view)
    throw InputError(
        "run: --devices mouse moves the finger in the window that --view opens. Add --view, or leave --devices out.");
  if (!view.view) return nullptr;
  return std::make_unique<FingerWindow>(devices == "mouse", view, servo, interrupted);
}

}  // namespace pincer::tasks
