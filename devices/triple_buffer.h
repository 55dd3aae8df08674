// triple_buffer: hands the latest value from one thread to one other; neither ever waits.
//
// Three places: the writer fills one, the reader looks at another, the third holds the latest finished one;
// handing over is one atomic exchange. A value that is overtaken before it was looked at is lost. All
// memory is taken when the buffer is made.
#pragma once
#include <array>
#include <atomic>

namespace pincer::devices {

template <typename Value>
class TripleBuffer {
 public:
  explicit TripleBuffer(const Value& first = {}) : places_{first, first, first} {}

  // The writer's: fill it in, then publish it. What it holds before is some older value.
  Value& writable() { return places_[writing_]; }
  void publish() { writing_ = latest_.exchange(writing_ | kFresh, std::memory_order_acq_rel) & kPlace; }

  // The reader's: takes the latest value if there is one that it hasn't seen; returns whether there was.
  bool update() {
    if ((latest_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reading_ = latest_.exchange(reading_, std::memory_order_acq_rel) & kPlace;
    return true;
  }
  const Value& current() const { return places_[reading_]; }

 private:
  static constexpr unsigned kPlace = 3, kFresh = 4;  // bits of latest_: the place, 0 to 2; not yet read
  std::array<Value, 3> places_;
  unsigned writing_ = 0, reading_ = 1;
  std::atomic<unsigned> latest_{2};
};

}  // namespace pincer::devices
