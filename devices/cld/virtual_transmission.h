// virtual_transmission: backlash, delay and stillness that an experiment puts between the place wanted and the place
// commanded, to learn how good a contact location display has to be.
//
//   play    y_k = clamp(y_(k-1), x_k - b/2, x_k + b/2)
//   delay   z_k = y_(k-n)
//   freeze  z_k = z_(k-1), while the two above go on unseen
//
// x place wanted, z place commanded [m, arc length on the pad]; b backlash from stop to stop [m]; n cells of a FIFO,
// one cell per call, so the caller calls once per millisecond for cells of 1 ms. The first place passes unchanged: the
// FIFO starts full of it. Source: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 2 and 3 (just
// noticeable backlash and delay on the 1-DOF CLD).
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace pincer::devices {

inline constexpr int kMaxDelayCells = 512;  // chosen: half a second in cells of 1 ms

struct VirtualTransmission {
  double backlash = 0;  // b [m], 0 .. 0.05
  int delay = 0;        // n, 0 .. kMaxDelayCells
  bool frozen = false;
};

// The mistake in `t`, as a sentence with field, value and range; absent if there is none.
std::optional<std::string> problemWith(const VirtualTransmission& t);

// A plain value; allocates nothing.
struct TransmissionState {
  bool begun = false;
  double played = 0;                             // y [m]
  double shown = 0;                              // z [m]
  std::array<double, kMaxDelayCells + 1> cells;  // the last y, as a ring [m]; all set by the first call
  std::size_t newest = 0;
};

// z_k for x_k = `wanted` [m]. `t` may change between calls: a shorter delay skips, a longer one repeats what was. A
// `wanted` that isn't finite counts as the last one that was.
double transmitted(const VirtualTransmission& t, double wanted, TransmissionState& state);

}  // namespace pincer::devices
