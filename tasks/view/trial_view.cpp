#include "pincer/tasks/view/trial_view.h"

#include <CLI/CLI.hpp>

#include "pincer/contact/error.h"
#include "pincer/devices/window/surface.h"
#include "pincer/tasks/lab/experiments/mouse_hands.h"
#include "pincer/tasks/lab/sessions/trial_capture.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tasks/view/page_view.h"

namespace pincer::tasks {
namespace {

// A trial's ticks, each published.
class PublishedTrial final : public ServoCycle {
 public:
  PublishedTrial(HandsCycle& cycle, SnapshotChannel& channel, TrialCapture& capture)
      : cycle_(cycle), channel_(channel), capture_(capture) {}

  bool tick(double now) override {
    const double start = steadySeconds();
    const bool more = cycle_.tick(now);
    capture_.hear();
    capture_.fill(channel_.writable());
    channel_.writable().tick_seconds = steadySeconds() - start;
    channel_.publish();
    return more;
  }
  void cutForces() noexcept override { cycle_.cutForces(); }

 private:
  HandsCycle& cycle_;
  SnapshotChannel& channel_;
  TrialCapture& capture_;
};

class WindowStage final : public TrialStage {
 public:
  WindowStage(bool mouse, const ViewOptions& view, const ServoOptions& servo, const std::atomic<bool>& interrupted)
      : mouse_(mouse),
        view_(view),
        servo_(servo),
        interrupted_(interrupted),
        surface_(devices::openWindow({"pincer " + view.title})) {}

  TrialHost host() override {
    TrialHost host;
    if (mouse_) {
      host.hands = [this](HandTrial& trial) {
        auto hands = std::make_unique<MouseHands>(trial.scene(), &keys_);
        hand_ = &hands->hand();
        return hands;
      };
    }
    host.serve = [this](HandsCycle& cycle, std::size_t trial, std::size_t trials) {
      return serve(cycle, trial, trials);
    };
    host.show = [this](const StudyPage& page) { return showPage(*surface_, view_.title, page, interrupted_); };
    host.ask = [this](const AskedQuestion& question) {
      return askOnPage(*surface_, view_.title, question, interrupted_);
    };
    return host;
  }
  AnswerBox& keys() override { return keys_; }

 private:
  ServoReport serve(HandsCycle& cycle, std::size_t trial, std::size_t trials) {
    const grasp::GraspModel& model = cycle.trial().scene().model.grasp;
    TrialCapture capture(cycle, trial, trials, view_.blind, mouse_);
    Snapshot start = Snapshot::sizedFor(model);
    capture.fill(start);
    SnapshotChannel channel(start);
    PublishedTrial published(cycle, channel, capture);
    channel.publish();
    WatchedCycle watched{published, model, start, channel, mouse_ ? hand_ : nullptr};
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

void addTrialViewOptions(CLI::App& command, ViewOptions& options) {
  addViewOptions(command, options);
  command.add_flag("--blind", options.blind,
                   "In the window show neither object nor fingers nor forces, as the protocol asks of a person");
}

std::unique_ptr<TrialStage> hostOf(const std::string& devices, const ViewOptions& view, const ServoOptions& servo,
                                   const std::atomic<bool>& interrupted) {
  if (devices == "mouse" && !view.view) {
    throw InputError(
        "run: --devices mouse moves the fingers in the window that --view opens. Add --view, or leave --devices out.");
  }
  if (!view.view) return nullptr;
  return std::make_unique<WindowStage>(devices == "mouse", view, servo, interrupted);
}

}  // namespace pincer::tasks
