// tactile_display: a contact location display (CLD), a tactor that touches the fingerpad where the virtual contact is.
//
// A place on the pad is (proximal-distal, radial-ulnar) arc length [m] from the pad's centre, in the fingerpad frame L:
// first axis positive towards the fingertip (distal), second positive towards the radial side.
#pragma once
#include <optional>
#include <string>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/math.h"

namespace pincer::devices {

struct TactileCapabilities {
  double resolution = 0;      // at the tactor [m]
  double speed = 0;           // largest tactor speed [m/s]
  double rate = 500;          // of position commands [Hz]
  Vec2 reach = Vec2::Zero();  // largest |place| per axis [m]
};

struct TactileSample {
  double time = 0;  // device clock [s]
  bool valid = false;
  std::optional<Vec2> place_L;  // measured tactor place [m]; absent where the device doesn't measure it
};

// A command to the tactor.
struct TactileCommand {
  bool parked = false;          // true: hold still at the centre, whatever place_L says (the force-only condition)
  Vec2 place_L = Vec2::Zero();  // [m]
};

class TactileDisplay {
 public:
  virtual ~TactileDisplay() = default;
  virtual std::string identity() const = 0;
  virtual const TactileCapabilities& capabilities() const = 0;
  virtual DeviceState state() const = 0;
  virtual TactileSample sample() = 0;
  // A place outside the reach is moved to the nearest reachable one; returns whether it was.
  virtual bool command(const TactileCommand& command) = 0;
};

}  // namespace pincer::devices
