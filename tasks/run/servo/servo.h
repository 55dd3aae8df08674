// servo: the clock of a session, which the cycle that it drives can't tell from another one.
//
//   virtual   ticks follow each other as fast as they go
//   paced     one every 1/rate of the system's monotonic clock at the most. The cycle's time is that of its ticks:
//             where the machine is late, it stands still, and what comes out is the same to the bit. For what has no
//             motors: simulated devices, a mouse, a recording
//   real      the wall clock's time: a tick whose time has passed is skipped. For motors that somebody feels: a second
//             thread watches, and no finished tick for `watchdog` seconds cuts the forces, latched
//
// Paced and real: clock_nanosleep to absolute times, SCHED_FIFO and mlockall when permitted (a note says so when not).
// Ticks that come too late are counted, never caught up. On SIGUSR1 (requestServoReport) a second thread shows how it
// has gone so far; the servo's only copies its numbers.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/run/servo/histogram.h"

namespace pincer::tasks {

// A stage of a tick.
struct StageTimes {
  std::string name;
  Histogram times;  // [s]
};

class ServoCycle {
 public:
  virtual ~ServoCycle() = default;
  // One tick at time `now` [s since the servo's start]. Returns false when there is no more to do.
  virtual bool tick(double now) = 0;
  // Zero force at every motor, latched until an operator arms again. Called from any thread.
  virtual void cutForces() noexcept = 0;
  // How long each stage of a tick took, of those that the cycle cares to time; asked for after the servo has returned.
  virtual std::vector<StageTimes> stages() const { return {}; }
};

struct ServoReport;

enum class ServoClock : std::uint8_t { kVirtual, kPaced, kReal };

struct ServoOptions {
  ServoClock clock = ServoClock::kVirtual;
  double rate = 1000;                                 // [Hz], 100 .. 4000
  double watchdog = 5e-3;                             // [s]; kReal only
  std::function<void(const ServoReport&)> show = {};  // what to do with a report on request; called from another thread
};

struct ServoReport {
  std::int64_t ticks = 0;
  std::int64_t missed = 0;  // ticks for which the wall clock didn't wait; always 0 in virtual time
  Histogram lateness;       // of a tick's start [s]; empty in virtual time
  Histogram duration;       // of a tick [s]
  std::vector<StageTimes> stages = {};
  double wall = 0;  // [s]
  bool watchdog_tripped = false;
  bool interrupted = false;  // before the cycle was done
  std::string note;          // a line for each thing that the system didn't permit; empty when all is well

  // As if the two runs were one.
  void add(const ServoReport& other);
};

// Asks every servo that runs by the wall clock to show how it goes; safe in a signal handler.
void requestServoReport() noexcept;

// Runs `cycle` until it is done or `interrupted` becomes true. An exception from a tick cuts the forces and is passed
// on. Throws std::invalid_argument for options out of range.
ServoReport runServo(const ServoOptions& options, ServoCycle& cycle, const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
