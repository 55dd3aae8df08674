// silence: how soon an arm of Haply's goes idle when its commands end, as nobody has documented. Nobody may hold it.
//
// One session pushes gently and falls silent, or closes its connection; a second one only looks. Where the arm moves by
// 30 mm first, or nothing happens for 2 s, the first one sends zeros and the time is a lower bound. A service that
// tells the second one nothing of the arm is an error after 0.25 s.
#pragma once
#include <atomic>
#include <string>

#include "pincer/devices/haply/haply_messages.h"
#include "pincer/devices/haply/haply_port.h"

namespace pincer::devices::haply {

struct SilenceFinding {
  bool went_idle = false;
  double seconds = 0;  // until it went idle, or until it was given up [s]
  double moved = 0;    // meanwhile [m]
};

enum class Ending : std::uint8_t { kSilence, kClose };

// Throws std::runtime_error with a sentence and the remedy. Ends early, with zeros, once `interrupted`.
SilenceFinding measureSilence(const ServicePlace& place, const std::string& arm, const ServiceVersion& version,
                              Ending ending, const std::atomic<bool>& interrupted);

}  // namespace pincer::devices::haply
