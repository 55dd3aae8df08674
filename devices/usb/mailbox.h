// mailbox: hands the latest value from one thread to another; neither ever waits. One thread puts, one takes.
//
// Three copies: one that the writer fills, one that the reader reads, and one between them that changes hands by a single exchange.
#pragma once
#include <array>
#include <atomic>

namespace pincer::devices::usb {

template <typename T>
class Mailbox {
 public:
  void put(const T& value) {
    slots_[back_] = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kSlot;
  }
  // Whether something new has come since the last take; if so, latest() is it.
  bool take() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kSlot;
    return true;
  }
  // What was taken last; for the reader.
  const T& latest() const { return slots_[front_]; }

 private:
  static constexpr unsigned kFresh = 4, kSlot = 3;
  std::array<T, 3> slots_{};
  unsigned back_ = 0, front_ = 1;
  std::atomic<unsigned> middle_{2};
};

}  // namespace pincer::devices::usb
