// sim_view: a scene's simulation to look at: as a picture, or live in a window, with the fingers on their trajectories
// or on the mouse.
#pragma once
#include "pincer/tasks/run/expectation.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tasks/view/image.h"
#include "pincer/tasks/view/view_run.h"

namespace pincer::tasks {

// As it stands now, drawn in memory. Throws devices::DisplayError.
Image pictureOf(const Simulation& simulation, bool as_operator = false);

// The scene's ticks, each published, with what the mouse pulls at; fingers on their trajectories or, with `hand`, where
// it is. Ends where the scene does; with a hand, never.
class SceneCycle final : public ServoCycle {
 public:
  // All must outlive it; `hand` and `pull` may be null.
  SceneCycle(Simulation& simulation, SnapshotChannel& channel, devices::MouseHand* hand, BodyPull* pull = nullptr);

  bool tick(double now) override;
  void cutForces() noexcept override {}  // nobody feels any
  const ExpectationLog& log() const { return log_; }
  // How far the first body that moves has been over its start [m]. After the servo has returned.
  double lift() const { return lift_; }

 private:
  engine::StepReport handTick();
  engine::StepReport sceneTick();
  void noteLift();
  void judge();

  Simulation& simulation_;
  SnapshotChannel& channel_;
  devices::MouseHand* hand_;
  BodyPull* pull_;
  std::vector<grasp::FingerInput> inputs_;
  ExpectationLog log_;  // of a hand's none: it does as it likes
  int object_ = -1;
  double lift_ = 0;
};

// As the simulation stands now.
Snapshot snapshotOf(const Simulation& simulation);

// Where a mouse's fingers begin in the scene: where its own do. Throws InputError when it hasn't one or two.
std::vector<devices::MouseMount> mouseMounts(const Scene& scene);

struct WatchResult {
  ServoReport servo;
  double lift = 0;  // see SceneCycle [m]
  ExpectationLog log;
  bool ended = false;   // the scene did, rather than the window
  bool pulled = false;  // a body was, by the mouse: from then on nothing was judged
};

// In real time, until the window is closed. With `mouse` the scene's fingers (one or two) follow it from where they
// start, without end; else the scene stands still where it ends. Throws InputError when the scene's fingers can't
// follow a mouse.
WatchResult watchScene(Simulation& simulation, const ViewOptions& options, bool mouse,
                       const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
