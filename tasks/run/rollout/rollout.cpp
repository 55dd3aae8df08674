#include "pincer/tasks/run/rollout/rollout.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include "pincer/contact/assert.h"
#include "pincer/tasks/run/rollout/state_rows.h"

namespace pincer::tasks {
namespace {

// One row of a job: its places in the arrays.
class RolloutRow {
 public:
  RolloutRow(const RolloutJob& job, const SceneModel& model, std::int64_t row)
      : job_(job), model_(model), row_(row), inputs_(model) {}

  void run(SceneState& state, SceneStepper& stepper, const std::function<bool()>& stop) {
    bool broken = false;
    std::uint32_t status = engine::kStepOk;
    for (std::int64_t t = 0; t < job_.ticks; ++t) {
      if (t % 1000 == 999 && stop()) return;
      if (!broken) {
        tell(t);
        status = job_.controls.empty() ? stepper.step(state, 1).status : stepper.step(state, inputs_, 1).status;
        broken = (status & engine::kStateNotFinite) != 0;
      }
      record(t, state, stepper, status);
    }
  }

 private:
  template <class Number>
  std::span<Number> cell(std::span<Number> all, std::int64_t t, std::size_t size) const {
    return all.empty() ? all : all.subspan(static_cast<std::size_t>(row_ * job_.ticks + t) * size, size);
  }

  void tell(std::int64_t t) {
    const std::span<const double> row = cell(job_.controls, t, controlSize(model_));
    if (row.empty()) return;
    const std::size_t fingers = inputs_.finger_place.size();
    for (std::size_t i = 0; i < fingers; ++i)
      inputs_.finger_place[i] = Vec3(row[3 * i], row[3 * i + 1], row[3 * i + 2]);
    for (std::size_t i = 0; i < inputs_.drive_target.size(); ++i) inputs_.drive_target[i] = row[3 * fingers + i];
  }

  void record(std::int64_t t, const SceneState& state, const SceneStepper& stepper, std::uint32_t status) {
    if (const auto out = cell(job_.state, t, stateSize(model_)); !out.empty()) writeStateRow(model_, state, out);
    if (const auto out = cell(job_.sensors, t, sensorSize(model_)); !out.empty()) {
      const Moment moment{model_.grasp,        state.grasp,       stepper.fingers(),
                          model_.scene.starts, stepper.scratch(), model_.scene.frames};
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = model_.scene.record.quantities[i].measure(moment);
    }
    if (!job_.status.empty()) cell(job_.status, t, 1)[0] = static_cast<std::int32_t>(status);
  }

  const RolloutJob& job_;
  const SceneModel& model_;
  std::int64_t row_;
  SceneInputs inputs_;
};

// Some chunks per thread, so that none waits long for the last.
std::int64_t chunkOf(const RolloutJob& job, int threads) {
  const auto rows = static_cast<std::int64_t>(job.states.size());
  return job.chunk > 0 ? job.chunk : std::max<std::int64_t>(1, rows / (10 * std::max(threads, 1)));
}

}  // namespace

struct RolloutPool::Memory {
  std::shared_ptr<const SceneModel> model;
  std::unique_ptr<SceneStepper> stepper;  // of it
};

std::size_t controlSize(const SceneModel& model) { return 3 * model.scene.fingers.size() + model.scene.drives.size(); }
std::size_t stateSize(const SceneModel& model) { return 1 + 13 * model.scene.bodies.size() + 2 * model.joints.size(); }
std::size_t sensorSize(const SceneModel& model) { return model.scene.record.quantities.size(); }

RolloutPool::RolloutPool(int threads) {
  try {
    for (int t = 0; t < threads; ++t) workers_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    if (workers_.empty()) throw;
  }
}

RolloutPool::~RolloutPool() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

bool RolloutPool::run(const RolloutJob& job, const std::function<bool()>& stop) {
  PINCER_DEMAND(job.models.size() == 1 || job.models.size() == job.states.size(), "rollout: one model, or one per row");
  std::unique_lock lock(mutex_);
  PINCER_DEMAND(job_ == nullptr, "rollout: one job at a time");
  job_ = &job;
  next_ = 0;
  failure_ = nullptr;
  stopped_ = false;
  wake_.notify_all();
  const auto rows = static_cast<std::int64_t>(job.states.size());
  while (!done_.wait_for(lock, std::chrono::milliseconds(50), [&] { return busy_ == 0 && next_ >= rows; })) {
    lock.unlock();
    if (stop()) stopped_ = true;
    lock.lock();
    if (stopped_) next_ = rows;
  }
  job_ = nullptr;
  if (failure_) std::rethrow_exception(failure_);
  return !stopped_;
}

void RolloutPool::work() {
  Memory memory;
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [&] { return ends_ || (job_ && next_ < static_cast<std::int64_t>(job_->states.size())); });
    if (ends_) return;
    const RolloutJob& job = *job_;
    const auto rows = static_cast<std::int64_t>(job.states.size());
    const std::int64_t begin = next_, end = std::min(rows, begin + chunkOf(job, threads()));
    next_ = end;
    ++busy_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      runRows(job, begin, end, memory);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && !failure_) failure_ = failure;
    if (failure) next_ = rows;
    if (--busy_ == 0 && next_ >= rows) done_.notify_all();
  }
}

void RolloutPool::runRows(const RolloutJob& job, std::int64_t begin, std::int64_t end, Memory& memory) {
  for (std::int64_t row = begin; row < end && !stopped_; ++row) {
    const auto& model = job.models[job.models.size() == 1 ? 0 : static_cast<std::size_t>(row)];
    if (memory.model != model) {
      memory.stepper = std::make_unique<SceneStepper>(*model);
      memory.model = model;
    }
    RolloutRow(job, *model, row).run(*job.states[static_cast<std::size_t>(row)], *memory.stepper, [this] {
      return stopped_.load();
    });
  }
}

}  // namespace pincer::tasks
