#include "pincer/engine/world/island_threads.h"

#include <exception>

#include "pincer/contact/functions/invariants.h"

namespace pincer::engine {
namespace {
constexpr int kLooks = 2000;  // for the next round, before a thread goes to sleep: some tens of microseconds
}

IslandThreads::IslandThreads(int threads) {
  PINCER_ASSERT(threads >= 2);
  try {
    for (int t = 1; t < threads; ++t) threads_.emplace_back([this, t] { work(t); });
  } catch (const std::exception&) {  // no memory, or no more threads: fewer do the same work
  }
}

IslandThreads::~IslandThreads() {
  stop_ = true;
  ++round_;
  round_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void IslandThreads::handOver(int count) {
  PINCER_ASSERT(busy_ == 0);  // one round at a time
  count_ = count;
  next_ = 0;
  busy_ = static_cast<int>(threads_.size());
  ++round_;
  round_.notify_all();
  takeAll(0);
  while (busy_.load(std::memory_order_acquire) > 0) std::this_thread::yield();
}

void IslandThreads::takeAll(int thread) {
  for (int k = next_.fetch_add(1); k < count_; k = next_.fetch_add(1)) call_(task_, k, thread);
}

void IslandThreads::work(int thread) {
  unsigned seen = 0;
  for (;;) {
    for (int look = 0; look < kLooks && round_.load(std::memory_order_acquire) == seen; ++look)
      std::this_thread::yield();
    round_.wait(seen);
    ++seen;
    if (stop_) return;
    takeAll(thread);
    busy_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace pincer::engine
