// frame_order: which of the frames that arrive is newer than all before, and what of the sender's clock on ours.
//
//   step = sequence - last (as a signed 32-bit number): > 0 newer, step - 1 were lost;  0 a duplicate;  < 0 late
//   offset = min over the frames of (arrival - sender's time), growing by 50 ppm of the time passed;   sent = sender's time + offset
//
// The least offset belongs to the frame that travelled fastest: so the time given to a frame that was held up on its way is the time at
// which it was measured, and the gate sees how old it is. The growth lets a slower clock of the sender be followed.
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
      return step == 0 ? FrameVerdict::kDuplicate : FrameVerdict::kLate;
    }
    if (begun_) lost_ = step - 1;
    begun_ = true;
    last_ = sequence;
    refused_in_a_row_ = 0;
    return FrameVerdict::kNewer;
  }
  std::int32_t lost() const { return lost_; }  // just before the frame judged last
  // So many refused frames one after the other mean that the sender began anew.
  int refusedInARow() const { return refused_in_a_row_; }

 private:
  bool begun_ = false;
  std::uint32_t last_ = 0;
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
