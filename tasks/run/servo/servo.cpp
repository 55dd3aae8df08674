#include "pincer/tasks/run/servo/servo.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <stdexcept>
#include <thread>

#include "pincer/devices/gate/watchdog.h"

namespace pincer::tasks {
namespace {

std::int64_t nowNs() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

void sleepUntil(std::int64_t ns) {
  const timespec t{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
  }
}

std::atomic<int> g_report_requests{0};  // a signal handler reaches nothing but globals
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may take no lock");

// Asks for what real time needs for the time of a session, and gives it back.
class RealTimePriority {
 public:
  RealTimePriority() {
    const sched_param param{.sched_priority = 80};
    fifo_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
    locked_ = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    if (!fifo_) prctl(PR_SET_TIMERSLACK, 1UL);
  }
  ~RealTimePriority() {
    const sched_param param{.sched_priority = 0};
    if (fifo_) pthread_setschedparam(pthread_self(), SCHED_OTHER, &param);
    if (locked_) munlockall();
  }
  RealTimePriority(const RealTimePriority&) = delete;
  RealTimePriority& operator=(const RealTimePriority&) = delete;

  std::string note() const {
    std::string text;
    if (!fifo_)
      text += "Real-time priority (SCHED_FIFO) isn't permitted: ticks may be late. Allow rtprio 80 in limits.conf.";
    if (!fifo_ && !locked_) text += "\n";
    if (!locked_)
      text += "Locked memory (mlockall) isn't permitted: a page fault may delay a tick. Allow memlock in limits.conf.";
    return text;
  }

 private:
  bool fifo_ = false, locked_ = false;
};

// The second thread: shows how it goes, and with `guards` cuts the forces when the loop is silent.
class WatchdogThread {
 public:
  WatchdogThread(const ServoOptions& options, bool guards, ServoCycle& cycle)
      : dog_(static_cast<std::int64_t>(1e9 * options.watchdog)), guards_(guards), cycle_(cycle), show_(options.show) {
    dog_.arm(nowNs());
    // Four times per limit, and often enough that the end of a session needn't wait.
    const double period = guards ? std::min(0.25 * options.watchdog, kLook) : kLook;
    thread_ = std::thread([this, period_ns = static_cast<std::int64_t>(1e9 * period)] { watch(period_ns); });
  }
  ~WatchdogThread() {
    dog_.rest();
    stop_ = true;
    thread_.join();
  }
  WatchdogThread(const WatchdogThread&) = delete;
  WatchdogThread& operator=(const WatchdogThread&) = delete;

  void feed() { dog_.feed(nowNs()); }
  // From the servo thread, after a tick: copies what is asked for, allocates nothing.
  void offer(const ServoReport& report) {
    if (!show_ || g_report_requests.load(std::memory_order_relaxed) == answered_ ||
        copied_.load(std::memory_order_acquire))
      return;
    answered_ = g_report_requests.load(std::memory_order_relaxed);
    copy_.ticks = report.ticks;
    copy_.missed = report.missed;
    copy_.lateness = report.lateness;
    copy_.duration = report.duration;
    copied_.store(true, std::memory_order_release);
  }
  bool expired() const { return dog_.expired(); }

 private:
  static constexpr double kLook = 0.01;  // [s]

  void watch(std::int64_t period_ns) noexcept {
    for (std::int64_t next = nowNs() + period_ns; !stop_; next += period_ns) {
      sleepUntil(next);
      if (guards_ && dog_.check(nowNs())) cycle_.cutForces();
      if (!copied_.load(std::memory_order_acquire)) continue;
      copy_.wall = 1e-9 * static_cast<double>(nowNs() - begun_ns_);
      showCopy();
      copied_.store(false, std::memory_order_release);
    }
  }
  // A figure that can't be shown (no memory) is no reason to let go of the motors.
  void showCopy() noexcept {
    try {
      show_(copy_);
    } catch (const std::exception&) {
    }
  }
  devices::Watchdog dog_;
  const bool guards_;
  ServoCycle& cycle_;
  const std::function<void(const ServoReport&)>& show_;
  const std::int64_t begun_ns_ = nowNs();
  int answered_ = g_report_requests.load();
  ServoReport copy_;
  std::atomic<bool> copied_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// Forces are cut where the exception is met, before the watchdog's thread is waited for, which takes up to kLook.
bool tickOrCut(ServoCycle& cycle, double now) {
  try {
    return cycle.tick(now);
  } catch (...) {
    cycle.cutForces();
    throw;
  }
}

bool timedTick(ServoCycle& cycle, double now, ServoReport& report) {
  const std::int64_t start = nowNs();
  const bool more = tickOrCut(cycle, now);
  report.duration.add(1e-9 * static_cast<double>(nowNs() - start));
  ++report.ticks;
  return more;
}

// Both return whether the cycle had more to do.
bool runVirtual(const ServoOptions& options, ServoCycle& cycle, const std::atomic<bool>& interrupted,
                ServoReport& report) {
  bool more = true;
  while (more && !interrupted) more = timedTick(cycle, static_cast<double>(report.ticks) / options.rate, report);
  return more;
}

bool runByTheClock(const ServoOptions& options, ServoCycle& cycle, const std::atomic<bool>& interrupted,
                   ServoReport& report) {
  const bool real = options.clock == ServoClock::kReal;
  const RealTimePriority priority;
  report.note = priority.note();
  WatchdogThread dog(options, real, cycle);
  const auto period = static_cast<std::int64_t>(1e9 / options.rate);
  const std::int64_t start = nowNs();
  bool more = true;
  for (std::int64_t slot = 0; more && !interrupted; ++slot) {
    sleepUntil(start + slot * period);
    const std::int64_t late = nowNs() - (start + slot * period);
    report.lateness.add(1e-9 * static_cast<double>(late));
    report.missed += late / period;
    slot += late / period;
    const double now =
        real ? 1e-9 * static_cast<double>(slot * period) : static_cast<double>(report.ticks) / options.rate;
    more = timedTick(cycle, now, report);
    dog.feed();
    dog.offer(report);
  }
  if (more && interrupted) cycle.cutForces();  // before the watchdog's thread is waited for, as in tickOrCut()
  report.watchdog_tripped = dog.expired();
  return more;
}

}  // namespace

void ServoReport::add(const ServoReport& other) {
  ticks += other.ticks;
  missed += other.missed;
  lateness.add(other.lateness);
  duration.add(other.duration);
  for (const StageTimes& stage : other.stages) {
    const auto same =
        std::find_if(stages.begin(), stages.end(), [&](const StageTimes& s) { return s.name == stage.name; });
    same == stages.end() ? stages.push_back(stage) : same->times.add(stage.times);
  }
  wall += other.wall;
  watchdog_tripped = watchdog_tripped || other.watchdog_tripped;
  interrupted = interrupted || other.interrupted;
  if (note.empty()) note = other.note;
}

void requestServoReport() noexcept { g_report_requests.fetch_add(1); }

ServoReport runServo(const ServoOptions& options, ServoCycle& cycle, const std::atomic<bool>& interrupted) {
  if (!(options.rate >= 100 && options.rate <= 4000))
    throw std::invalid_argument("servo rate out of range [100, 4000] Hz");
  if (!(options.watchdog > 0)) throw std::invalid_argument("servo watchdog must be positive");
  ServoReport report;
  const std::int64_t start = nowNs();
  try {
    const auto run = options.clock == ServoClock::kVirtual ? runVirtual : runByTheClock;
    report.interrupted = run(options, cycle, interrupted, report);
  } catch (...) {
    cycle.cutForces();  // for a failure between ticks too; after a tick's it changes nothing
    throw;
  }
  report.wall = 1e-9 * static_cast<double>(nowNs() - start);
  report.stages = cycle.stages();
  return report;
}

}  // namespace pincer::tasks
