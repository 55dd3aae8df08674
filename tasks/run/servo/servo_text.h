// servo_text: how the clock of a session did, in plain words.
#pragma once
#include <string>

#include "pincer/tasks/run/servo/servo.h"

namespace pincer::tasks {

// A few lines without a newline at the end: ticks done and missed, how late they began and how long they took, what
// went wrong, and what the system didn't permit. `period`: of a tick [s].
std::string servoText(const ServoReport& report, double period);

// How much was simulated [s] in the processor time that the program has used so far, in one line.
std::string throughputText(double simulated);

}  // namespace pincer::tasks
