#include "pincer/tasks/view/view_run.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <thread>

#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

// The servo, beside the viewer; ends with it.
class ServoThread {
 public:
  ServoThread(const WatchedCycle& watched, const ServoOptions& servo, PaceControl& pace,
              const std::atomic<bool>& interrupted)
      : pace_(pace), paced_(watched.cycle, pace, servo.rate) {
    thread_ = std::thread([this, servo, &interrupted] {
      try {
        report_ = runServo(servo, paced_, interrupted);
      } catch (...) {
        failure_ = std::current_exception();
      }
      done_ = true;
    });
  }
  ~ServoThread() {
    pace_.stop = true;
    if (thread_.joinable()) thread_.join();
  }
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  bool done() const { return done_; }
  ServoReport finish() {
    pace_.stop = true;
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    return report_;
  }

 private:
  PaceControl& pace_;
  PacedCycle paced_;
  ServoReport report_;
  std::exception_ptr failure_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace

void addViewOptions(CLI::App& command, ViewOptions& options) {
  command.add_flag("--view", options.view, "Watch it in a window, in real time (docs/keys.md; F1 there)");
  command.add_flag("!--no-keys", options.keys, "In the window no key does anything but Esc");
  command.add_option("--screenshot", options.screenshot, "Write a picture (PNG) of the end; needs no display");
}

ServoReport runWatched(const WatchedCycle& watched, const ServoOptions& servo, const ViewOptions& options,
                       const std::atomic<bool>& interrupted, devices::Surface& surface) {
  PaceControl pace;
  Viewer viewer(surface, watched.model, watched.start, watched.channel, pace, watched.hand,
                {.title = options.title,
                 .keys = options.keys,
                 .choose_camera = watched.choose_camera,
                 .camera = watched.camera,
                 .pull = watched.pull,
                 .from_the_side = watched.from_the_side,
                 .verdict = watched.verdict,
                 .answer = watched.answer});
  ServoOptions by_the_clock = servo;
  if (servo.clock == ServoClock::kVirtual) by_the_clock.clock = ServoClock::kPaced;
  pace.linger = watched.linger;
  ServoThread thread(watched, by_the_clock, pace, interrupted);
  bool open = true;
  while (open && !interrupted && !thread.done()) open = viewer.update();
  if (!options.screenshot.empty()) writePng(viewer.picture(), options.screenshot);
  ServoReport report = thread.finish();
  report.interrupted = report.interrupted || !open;
  return report;
}

ServoReport runWatched(const WatchedCycle& watched, const ServoOptions& servo, const ViewOptions& options,
                       const std::atomic<bool>& interrupted) {
  const auto surface = devices::openWindow({"pincer " + options.title});
  return runWatched(watched, servo, options, interrupted, *surface);
}

}  // namespace pincer::tasks
