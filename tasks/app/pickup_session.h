// pickup_session: a sphere-pickup study into a session file.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "tasks/experiments/live_pickup.h"
#include "tasks/experiments/pickup_run.h"

namespace pincer::tasks {

struct PickupSessionOptions {
  SpherePickupOptions study;
  ServoOptions servo;
  LiveSession live;       // without devices: a simulated participant on simulated ones
  int sample_rate = 200;  // of the ticks that are kept [Hz], 1 .. 1000; divides the servo's rate. A trial's row always counts every tick.
};

// Throws InputError naming the first value out of range, its range and the remedy.
void validate(const PickupSessionOptions& options);

struct PickupSessionResult {
  std::size_t trials = 0;    // finished
  bool interrupted = false;  // the session says so; its finished trials are safe
  ServoReport servo;         // of all trials
};

// Runs the study and writes it to the new file `path`. Throws InputError for bad options, a bad object, or a file that can't be written.
PickupSessionResult runPickupSession(const PickupSessionOptions& options, const std::string& path, const std::atomic<bool>& interrupted,
                                     const std::function<void(const PickupProgress&)>& progress);

// The options as JSON, as the session keeps them.
std::string protocolJson(const SpherePickupOptions& options);

}  // namespace pincer::tasks
