// frame_order: which of the frames that arrive is newer than all before, and what of the sender's clock on ours.
//
//   step = sequence - last (as a signed 32-bit number): > 0 newer, step - 1 are missing;  0 or come before:
//   a duplicate;  < 0 late missing and then late isn't lost: lost = gaps - late ones that filled them (of
//   the last 64 frames) offset = min over the frames of (arrival - sender's time), growing by 50 ppm of the
//   time passed;   sent = sender's time + offset
//
// The least offset belongs to the frame that travelled fastest: so the time given to a frame that was
// held up on its way is the time at which it was measured, and the gate sees how old it is. The growth
// lets a slower clock of the sender be followed.
#pragma once
#include <cstdint>

namespace pincer::devices::usb {

enum class FrameVerdict : std::uint8_t { kNewer, kDuplicate, kLate };

class FrameOrder {
 public:
  // The first frame after this is newer than all.
  void restart() { *this = FrameOrder{}; }

  FrameVerdict judge(std::uint32_t sequence) {
    const auto step = static_cast<std::int32_t>(sequence - last_);
    lost_ = 0;
    if (begun_ && step <= 0) {
      ++refused_in_a_row_;
      return judgeOld(-static_cast<std::int64_t>(step));
    }
    lost_ = begun_ ? step - 1 : 0;
    came_ = (begun_ && step < kWindow ? came_ << step : 0) | 1;
    since_first_ = begun_ ? since_first_ + step : 0;
    begun_ = true;
    last_ = sequence;
    refused_in_a_row_ = 0;
    return FrameVerdict::kNewer;
  }
  // How many more are lost since the frame judged last; -1: it had been counted, and is only late.
  std::int32_t lost() const { return lost_; }
  // So many refused frames one after the other mean that the sender began anew.
  int refusedInARow() const { return refused_in_a_row_; }

 private:
  static constexpr std::int64_t kWindow = 64;  // frames: bits of came_

  // `back` frames behind the newest.
  FrameVerdict judgeOld(std::int64_t back) {
    if (back >= kWindow || back > since_first_) return FrameVerdict::kLate;
    const std::uint64_t bit = std::uint64_t{1} << back;
    if ((came_ & bit) != 0) return FrameVerdict::kDuplicate;
    came_ |= bit;
    lost_ = -1;
    return FrameVerdict::kLate;
  }

  bool begun_ = false;
  std::uint64_t came_ = 0;  // bit i: the i-th before the newest
  std::uint32_t last_ = 0;
  std::int64_t since_first_ = 0;  // from the first frame to the newest
  std::int32_t lost_ = 0;
  int refused_in_a_row_ = 0;
};

class ClockMap {
 public:
  void restart() { *this = ClockMap{}; }

  // Our time [ns] at which the sender, by its clock `time_us`, sent what arrived at `now` [ns]; never after `now`.
  std::int64_t sentAt(std::uint64_t time_us, std::int64_t now) {
    const auto sender = static_cast<std::int64_t>(time_us * 1000);  // wraps where the sender's clock does
    const std::int64_t offset = now - sender;
    if (begun_) offset_ += (now - last_) / 20000;
    if (!begun_ || offset < offset_) offset_ = offset;
    begun_ = true;
    last_ = now;
    return sender + offset_;
  }

 private:
  bool begun_ = false;
  std::int64_t offset_ = 0, last_ = 0;  // [ns]
};

}  // namespace pincer::devices::usb
