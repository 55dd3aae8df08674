// pickup_session: a sphere-pickup study into a session file.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "tasks/experiments/pickup_run.h"

namespace pincer::tasks {

struct PickupSessionResult {
  std::size_t trials = 0;    // finished
  bool interrupted = false;  // the session says so; its finished trials are safe
};

// Runs the study and writes it to the new file `path`. Throws InputError for bad options, a bad object, or a file that can't be written.
PickupSessionResult runPickupSession(const SpherePickupOptions& options, const ServoOptions& servo, const std::string& path,
                                     const std::atomic<bool>& interrupted, const std::function<void(const PickupProgress&)>& progress);

// The options as JSON, as the session keeps them.
std::string protocolJson(const SpherePickupOptions& options);

}  // namespace pincer::tasks
