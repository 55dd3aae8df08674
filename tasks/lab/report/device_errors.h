// device_errors: how far a contact location display was from what it was told, beside what people notice.
//
//   error  |p_wanted - p_shown| on the pad while the finger touches and the tactor isn't parked
//   lag    the shift in 0 .. 200 ms for which mean |p_wanted(t - lag) - p_shown(t)|^2 is least,
//          over kept samples; its root is what remains
//
// Limits: place 1.3 mm (mean absolute error of localisation), delay 61 ms (whole travel) and
// 132 ms (front end): A. J. Doxon, doctoral dissertation, University of Utah, 2014. A kept
// sample's period is the resolution of the lag.
#pragma once
#include <cstdint>
#include <string>

#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

struct DeviceErrors {
  std::int64_t samples = 0;               // of either finger
  double median = 0, high = 0;            // of the error; high: 95 % lie below [m]
  double noticed = 0;                     // share of samples beyond the limit of place [-]
  double lag = 0, step = 0, remains = 0;  // the lag and its resolution [s]; what remains after it, root mean square [m]
};

// Of a session with samples; `samples` is 0 where no tactor was ever in use.
DeviceErrors deviceErrors(const SessionReader& session);

// A section of the report's page; empty where there is nothing to say.
std::string deviceErrorsHtml(const DeviceErrors& errors);

}  // namespace pincer::tasks
