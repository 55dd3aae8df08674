// view_run: a servo on a thread of its own, a viewer on this one.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "pincer/devices/window/mouse_hand.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/servo/paced_cycle.h"
#include "pincer/tasks/run/tick/snapshot.h"
#include "pincer/tasks/view/body_pull.h"

namespace CLI {
class App;
}
namespace pincer::devices {
class Surface;
}

namespace pincer::tasks {

// Options and steps that commands with a window share.
struct ViewOptions {
  bool view = false;            // a window
  bool keys = true;             // do something in it
  bool blind = false;           // what a person must not see isn't shown
  bool as_operator = false;     // looks from where the operator stands, whatever is hidden from there
  std::string screenshot = {};  // file for a picture of the end; empty: none
  std::string title = {};
};

void addViewOptions(CLI::App& command, ViewOptions& options);

// A cycle whose ticks somebody watches.
struct WatchedCycle {
  ServoCycle& cycle;
  const grasp::GraspModel& model;
  const Snapshot& start;
  SnapshotChannel& channel;  // that the cycle publishes to
  devices::MouseHand* hand = nullptr;
  bool linger = false;                        // over, it is still to be looked at
  bool choose_camera = false;                 // see ViewerOptions
  SceneCamera camera = {};                    // likewise
  BodyPull* pull = nullptr;                   // likewise
  bool from_the_side = false;                 // what goes on is in the plane x = 0
  std::function<std::string()> verdict = {};  // said in the window once it is over; empty: none
  std::function<void(int key)> answer = {};   // gets the digits and Enter; empty: nobody does
};

// Runs the cycle in real time until it is over or the person closes the window (then the report says that it was
// interrupted), or `interrupted`; throws what the cycle throws.
ServoReport runWatched(const WatchedCycle& watched, const ServoOptions& servo, const ViewOptions& options,
                       const std::atomic<bool>& interrupted, devices::Surface& surface);

// In a window of its own, until the person closes it, or `interrupted`. Throws devices::DisplayError before anything
// runs where there is no display, and what the cycle throws.
ServoReport runWatched(const WatchedCycle& watched, const ServoOptions& servo, const ViewOptions& options,
                       const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
