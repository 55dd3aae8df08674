// haply_faults: the ways in which Haply's service, its devices or the wire may go wrong;
// the emulator does each of them on demand.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace pincer::devices::emulate {

enum class HaplyFault : std::uint8_t {
  kNone,
  // the answer's text
  kNoJson,
  kNoUtf8,
  kTooLong,
  kNotANumber,
  kInfinity,
  kBeyondDouble,
  kTextForNumber,
  kMissingComponent,
  kKeyTwice,
  kUnknownKey,
  kDeviceTwice,
  kOutOfRange,
  kEmptyObject,
  // the answers
  kTwice,
  kNever,
  // what they tell of the device
  kDeviceGone,
  kCalibrationLost,
  kPowerLost,
  kNotReady,
  kSettingsChanged,
  kTransformed,
  kEchoDoubled,
  kEchoStrong,
  kPlaceFrozen,
  kStaysIdle,
  kDeafToForces,
  kGripAsleep,
  kGripZero,
  // events
  kBusy,
  kStall,
  kStageChanged,
  kError,
  kUnreadableEvent,
  // the wire
  kPieces,
  kFragments,
  kPings,
  kHugeHeader,
  kReset,
  kHalfOpen,
  kLate,
  kEventsClosed,
  kCount
};

// How many there are, kNone with them.
inline constexpr auto kHaplyFaults = static_cast<std::size_t>(HaplyFault::kCount);
std::string_view nameOf(HaplyFault fault);  // "not a number"
// True where a sound driver goes on: nothing is wrong with what is told.
bool isHarmless(HaplyFault fault);

// The answer's text with the fault in it; unchanged for those that aren't in the text.
std::string spoilt(HaplyFault fault, std::string text);
// The event that tells of the fault of device `id`; empty for those that no event tells.
std::string eventOf(HaplyFault fault, std::string_view id);

}  // namespace pincer::devices::emulate
