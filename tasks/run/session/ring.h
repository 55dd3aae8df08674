// ring: how samples and inputs leave the 1 kHz tick. A single-producer single-consumer queue of fixed size,
// without lock, allocation or system call.
//
//   slot(k) = k mod capacity;   head = number of records pushed, tail = number taken;   0 <= head - tail <= capacity
//
// One thread may push, one other may drain. A push into a full ring is refused and counted: the tick never waits for
// the disk. Source: L. Lamport, "Proving the correctness of multiprocess programs", IEEE Trans. Softw. Eng. SE-3 (1977)
// 125-143, section III; the release/acquire pairs on head and tail are those of the C++ memory model.
#pragma once
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pincer/contact/assert.h"
#include "pincer/contact/error.h"
#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

template <class Record>
class Ring {
 public:
  // `capacity`: a power of two, >= 2. Throws InputError otherwise.
  explicit Ring(std::size_t capacity) : slots_(checked(capacity)), mask_(capacity - 1) {}

  // Producer. False, and one more drop counted, if the ring is full.
  bool push(const Record& record) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == slots_.size()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    slots_[head & mask_] = record;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // Consumer. Calls take(record) on all that had been pushed when the call began, oldest first; returns how many. A
  // record's slot is free again once `take` has returned from it.
  template <class Take>
  std::size_t drain(Take&& take) {
    const std::uint64_t end = head_.load(std::memory_order_acquire);
    const std::uint64_t begin = tail_.load(std::memory_order_relaxed);
    PINCER_ASSERT(begin <= end && end - begin <= slots_.size());
    for (std::uint64_t k = begin; k != end; ++k) {
      take(static_cast<const Record&>(slots_[k & mask_]));
      tail_.store(k + 1, std::memory_order_release);
    }
    return static_cast<std::size_t>(end - begin);
  }

  // Producer: whether the next push would be refused. Space never shrinks under the producer,
  // so a `false` stays true until it pushes.
  bool full() const noexcept {
    return head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_acquire) == slots_.size();
  }

  std::size_t capacity() const noexcept { return slots_.size(); }
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  static std::size_t checked(std::size_t capacity) {
    if (capacity >= 2 && std::has_single_bit(capacity)) return capacity;
    throw InputError("ring: capacity " + std::to_string(capacity) +
                     " is not a power of two >= 2. Use for example 4096.");
  }

  std::vector<Record> slots_;
  std::uint64_t mask_;
  alignas(64) std::atomic<std::uint64_t> head_{0};  // own cache lines: the tick's core doesn't wait for the writer's
  alignas(64) std::atomic<std::uint64_t> tail_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

using SampleRing = Ring<SampleRecord>;
using InputRing = Ring<InputRecord>;

}  // namespace pincer::tasks
