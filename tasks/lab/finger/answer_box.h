// answer_box: keys that a person pressed, from the thread that has the keyboard to the tick, one per tick. Neither
// waits for the other; keys beyond 16 that no tick has taken yet are dropped.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>

namespace pincer::tasks {

class AnswerBox {
 public:
  // From the keyboard's thread.
  void press(int key) {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == keys_.size()) return;
    keys_[end % keys_.size()] = key;
    end_.store(end + 1, std::memory_order_release);
  }
  // From the tick: the next key; 0: there is none.
  int take() {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return 0;
    const int key = keys_[begin % keys_.size()];
    begin_.store(begin + 1, std::memory_order_release);
    return key;
  }

 private:
  std::array<int, 16> keys_{};
  std::atomic<std::size_t> begin_{0}, end_{0};
};

}  // namespace pincer::tasks
