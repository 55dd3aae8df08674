// threads: work shared among threads, the caller's among them.
#pragma once
#include <functional>
#include <system_error>
#include <thread>
#include <vector>

namespace pincer::tasks {

// Calls `work` on up to `threads` >= 1 threads at once, this one included, and returns when all have returned. Where
// the system gives no more (memory, or its limit of threads), fewer do the work. `work` keeps its exceptions to itself.
template <class Work>
void onThreads(int threads, const Work& work) {
  std::vector<std::thread> others;
  try {
    for (int t = 1; t < threads; ++t) others.emplace_back(std::cref(work));
  } catch (const std::bad_alloc&) {
  } catch (const std::system_error&) {
  }
  work();
  for (std::thread& thread : others) thread.join();
}

}  // namespace pincer::tasks
