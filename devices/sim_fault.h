// sim_fault: what a simulated device can be told to suffer, so that everything above it meets the faults of real ones.
#pragma once
#include <cstdint>

namespace pincer::devices {

enum class SimFault : std::uint8_t {
  kNone,
  kFrozenSamples,      // the last sample again and again, its time stamp too: a cable that hangs
  kInvalidSamples,     // samples say of themselves that they can't be used: a failed checksum
  kNotFinitePosition,  // a valid sample whose position is NaN: a broken driver
  kStuckMotor,         // the motors keep what they do; commands are ignored
  kUnplugged,          // no samples, no motors; the state is kFaulted
};

}  // namespace pincer::devices
