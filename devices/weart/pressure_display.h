// pressure_display: a display that presses the whole fingerpad, harder or softer, and knows no place on it.
//
// It is no contact location display (devices/cld/tactile_display.h) and never stands behind one: a
// place that it can't show would be a lie.
#pragma once
#include <string>

#include "pincer/devices/arm/arm.h"

namespace pincer::devices {

class PressureDisplay {
 public:
  virtual ~PressureDisplay() = default;
  virtual std::string identity() const = 0;
  virtual DeviceState state() const = 0;
  // The normal force that the finger feels [N]; the newest counts, and for a short time only.
  // From the tick: never blocks, never throws.
  virtual void press(double normal_force) noexcept = 0;
  // Nothing presses any more.
  virtual void stop() noexcept = 0;
};

}  // namespace pincer::devices
