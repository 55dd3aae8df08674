// pad_policy: where a contact location display's tactor should be.
//
// Parked: at the centre, still (the force-only condition). In contact: the mean of the contact places, weighted by
// their normal forces. Near an object (within `preposition_distance`): at the place of the nearest point, so that
// the tactor is there when contact begins. Otherwise at the centre. The place asked for moves no faster than
// `speed`, so a hand-over between these is a glide, never a jump. Source: A. J. Doxon, doctoral dissertation,
// University of Utah (2014), ch. 4 and 5 (pre-positioning within 30 mm, else centred). The weights and the glide are
// ours. Places in the fingerpad frame L (tactile_display.h).
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/math.h"

namespace pincer::devices {

struct PadPolicy {
  double preposition_distance = 0.030;  // [m], >= 0
  double speed = 0.1;                   // of the place asked for [m/s], > 0
};

struct PadContact {
  Vec2 place_L = Vec2::Zero();  // [m]
  double normal_force = 0;      // [N]
};

struct NearestPoint {
  Vec2 place_L = Vec2::Zero();  // where it would touch the pad [m]
  double distance = 0;          // from the fingertip's surface [m]
};

inline constexpr int kMaxPadContacts = 4;  // chosen; a tick gives one

struct PadInput {
  bool parked = false;
  std::array<PadContact, kMaxPadContacts> contacts;
  int contact_count = 0;                // 0..kMaxPadContacts
  std::optional<NearestPoint> nearest;  // absent: nothing within reach
};

enum class PadMode : std::uint8_t { kCentre, kPreposition, kContact, kParked };

struct PadState {
  Vec2 place_L = Vec2::Zero();  // last place asked for [m]
  PadMode mode = PadMode::kCentre;
};

// The command for this tick; `dt` since the last one [s], > 0. Contacts whose place or force isn't finite, or
// whose force isn't positive, don't count.
TactileCommand padCommand(const PadPolicy& policy, const PadInput& in, double dt, PadState& state);

}  // namespace pincer::devices
