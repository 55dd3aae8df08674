// rollout: many states stepped in parallel, each with its own row of controls, and what came of every tick in arrays.
//
//   controls  (rows x ticks x control_size)   device places of all fingers, x, y, z each [m], then what each
//                                             drive is told; NaN: as SceneInputs has it
//   state     (rows x ticks x state_size)     time [s], then per body x, y, z, qw, qx, qy, qz of X_WB, then per body
//                                             v_W, w_W, then the coordinates of pivots and sliders, then their rates
//   sensors   (rows x ticks x sensor_size)    the quantities that the scene records, in its order
//   status    (rows x ticks)                  engine::StepStatus
//
// Rows are handed to threads in chunks; each is computed by itself, so that neither threads nor chunks change a bit.
// After a tick whose state isn't finite a row repeats its last values, flagged.
// Source of the shapes: MuJoCo's `mujoco.rollout`; departure: beside drives, fingers are told places.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "pincer/tasks/run/rollout/scene_state.h"

namespace pincer::tasks {

std::size_t controlSize(const SceneModel& model);
std::size_t stateSize(const SceneModel& model);
std::size_t sensorSize(const SceneModel& model);

struct RolloutJob {
  std::vector<std::shared_ptr<const SceneModel>> models;  // one, or one per row; all with the same sizes
  std::vector<SceneState*> states;                        // one per row; at the end those after the last tick
  std::int64_t ticks = 0;
  std::span<const double> controls;  // or empty: the scene's trajectories
  std::span<double> state, sensors;  // or empty: not wanted
  std::span<std::int32_t> status;
  std::int64_t chunk = 0;  // rows handed out at once; 0: chosen
};

// Threads that wait for jobs; each keeps the working memory of the model that it stepped last.
class RolloutPool {
 public:
  explicit RolloutPool(int threads);  // 1 .. 256; where the system gives fewer, fewer do the work
  ~RolloutPool();
  RolloutPool(const RolloutPool&) = delete;
  RolloutPool& operator=(const RolloutPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()); }

  // Runs all rows and returns; asks `stop` some times a second, and ends within a thousand ticks once it says so (false
  // is returned). One job at a time. Throws what a row threw.
  bool run(const RolloutJob& job, const std::function<bool()>& stop);

 private:
  void work();
  struct Memory;  // of one worker
  void runRows(const RolloutJob& job, std::int64_t begin, std::int64_t end, Memory& memory);

  std::vector<std::thread> workers_;
  std::mutex mutex_;  // guards the rest
  std::condition_variable wake_, done_;
  const RolloutJob* job_ = nullptr;
  std::int64_t next_ = 0, busy_ = 0;
  std::exception_ptr failure_;
  bool ends_ = false;
  std::atomic<bool> stopped_{false};
};

}  // namespace pincer::tasks
