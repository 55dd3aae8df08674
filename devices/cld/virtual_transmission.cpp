#include "pincer/devices/cld/virtual_transmission.h"

#include <algorithm>
#include <cmath>

namespace pincer::devices {

std::optional<std::string> problemWith(const VirtualTransmission& t) {
  if (!(t.backlash >= 0 && t.backlash <= 0.05)) {
    return "backlash = " + std::to_string(t.backlash) + " is out of range [0, 0.05] m. It is in metres; 0.002 is 2 mm.";
  }
  if (t.delay >= 0 && t.delay <= kMaxDelayCells) return std::nullopt;
  return "delay = " + std::to_string(t.delay) + " is out of range [0, " + std::to_string(kMaxDelayCells) +
         "] cells of 1 ms.";
}

double transmitted(const VirtualTransmission& t, double wanted, TransmissionState& state) {
  if (!std::isfinite(wanted)) wanted = state.played;
  if (!state.begun) {
    state.played = state.shown = wanted;
    state.cells.fill(wanted);
    state.begun = true;
  }
  state.played = std::clamp(state.played, wanted - t.backlash / 2, wanted + t.backlash / 2);
  const std::size_t size = state.cells.size();
  state.newest = (state.newest + 1) % size;
  state.cells[state.newest] = state.played;
  if (!t.frozen) state.shown = state.cells[(state.newest + size - static_cast<std::size_t>(t.delay)) % size];
  return state.shown;
}

}  // namespace pincer::devices
