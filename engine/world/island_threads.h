// island_threads: a few threads that wait for islands to solve. Which thread
// solves an island doesn't show in the result.
//
// A tick hands over by raising a counter and takes back by reading one: atomics, no lock, no allocation. The threads
// look for work for a while after each tick and then sleep in the kernel until they are woken.
#pragma once
#include <atomic>
#include <thread>
#include <vector>

namespace pincer::engine {

class IslandThreads {
 public:
  // `threads` >= 2 in all, the caller's among them.
  explicit IslandThreads(int threads);
  ~IslandThreads();
  IslandThreads(const IslandThreads&) = delete;
  IslandThreads& operator=(const IslandThreads&) = delete;

  // Calls task(k, thread) once for each k in [0, count), thread in [0, threads); returns when all are done.
  template <class Task>
  void run(int count, const Task& task) {
    task_ = &task;
    call_ = [](const void* t, int k, int thread) { (*static_cast<const Task*>(t))(k, thread); };
    handOver(count);
  }

 private:
  void handOver(int count);
  void work(int thread);
  void takeAll(int thread);

  const void* task_ = nullptr;
  void (*call_)(const void*, int, int) = nullptr;
  int count_ = 0;
  std::atomic<int> next_{0};        // the first k that nobody has taken
  std::atomic<unsigned> round_{0};  // raised once per run
  std::atomic<int> busy_{0};        // threads that haven't finished the round
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

}  // namespace pincer::engine
