// The servo's clock. Nothing here asserts how punctual it is: that is the machine's affair.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "pincer/tasks/run/servo/servo.h"

namespace pincer::tasks {
namespace {

const std::atomic<bool> kNeverStop{false};

// Does `work` in every tick, keeps the ticks' times, counts cuts and by which thread.
class Cycle final : public ServoCycle {
 public:
  explicit Cycle(std::function<bool(double)> work) : work_(std::move(work)) {}
  bool tick(double now) override {
    times.push_back(now);
    return work_(now);
  }
  void cutForces() noexcept override {
    ++cuts;
    if (std::this_thread::get_id() != servo_thread_) ++cuts_by_another_thread;
  }

  std::vector<double> times;
  std::atomic<int> cuts{0}, cuts_by_another_thread{0};

 private:
  const std::function<bool(double)> work_;
  const std::thread::id servo_thread_ = std::this_thread::get_id();
};

ServoOptions realTime() {
  ServoOptions options;
  options.clock = ServoClock::kReal;
  options.watchdog = 10;  // s: only the tests of the watchdog want to meet it
  return options;
}

void sleepFor(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

TEST(ServoVirtual, TicksOneAfterTheOtherAtTheRate) {
  ServoOptions options;
  options.rate = 500;
  Cycle cycle([n = 0](double) mutable { return ++n < 1000; });
  const ServoReport report = runServo(options, cycle, kNeverStop);
  ASSERT_EQ(cycle.times.size(), 1000u);
  // no drift: not summed
  for (std::size_t k = 0; k < cycle.times.size(); ++k) ASSERT_EQ(cycle.times[k], static_cast<double>(k) / 500);
  EXPECT_EQ(report.ticks, 1000);
  EXPECT_EQ(report.missed, 0);
  EXPECT_EQ(report.duration.count(), 1000);
  EXPECT_EQ(report.lateness.count(), 0);
  EXPECT_EQ(cycle.cuts, 0);
  EXPECT_FALSE(report.interrupted);
  EXPECT_FALSE(report.watchdog_tripped);
  EXPECT_EQ(report.note, "");
}

TEST(ServoVirtual, StopsAfterTheTickInWhichItIsInterrupted) {
  std::atomic<bool> interrupted{false};
  Cycle cycle([&](double now) {
    if (now >= 0.01) interrupted = true;
    return true;
  });
  const ServoReport report = runServo({}, cycle, interrupted);
  EXPECT_TRUE(report.interrupted);
  EXPECT_EQ(report.ticks, 11);
}

TEST(ServoVirtual, DoesNothingWhenInterruptedBefore) {
  const std::atomic<bool> interrupted{true};
  Cycle cycle([](double) { return true; });
  EXPECT_TRUE(runServo({}, cycle, interrupted).interrupted);
  EXPECT_TRUE(cycle.times.empty());
}

// A trial that ended in the very tick of the interrupt counts.
TEST(ServoVirtual, IsNotInterruptedWhenTheCycleWasDone) {
  std::atomic<bool> interrupted{false};
  Cycle cycle([&](double) {
    interrupted = true;
    return false;
  });
  EXPECT_FALSE(runServo({}, cycle, interrupted).interrupted);
}

TEST(ServoVirtual, CutsForcesAndPassesAnExceptionOn) {
  Cycle cycle([](double now) {
    if (now >= 0.005) throw std::runtime_error("the cable is off");
    return true;
  });
  try {
    runServo({}, cycle, kNeverStop);
    FAIL() << "the exception was swallowed";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "the cable is off");
  }
  EXPECT_GE(cycle.cuts, 1);
  EXPECT_EQ(cycle.times.size(), 6u);
}

TEST(ServoVirtual, RefusesOptionsOutOfRange) {
  Cycle cycle([](double) { return false; });
  for (const double rate : {0.0, -1000.0, 99.0, 4001.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    ServoOptions options;
    options.rate = rate;
    EXPECT_THROW(runServo(options, cycle, kNeverStop), std::invalid_argument) << rate;
  }
  for (const double watchdog : {0.0, -1.0, std::nan("")}) {
    ServoOptions options;
    options.watchdog = watchdog;
    EXPECT_THROW(runServo(options, cycle, kNeverStop), std::invalid_argument) << watchdog;
  }
  EXPECT_TRUE(cycle.times.empty());
}

TEST(ServoRealTime, AccountsForEveryTickOf200Milliseconds) {
  Cycle cycle([](double now) { return now < 0.2; });
  const ServoReport report = runServo(realTime(), cycle, kNeverStop);
  ASSERT_FALSE(cycle.times.empty());
  // Every due tick was done or is counted as missed, up to the last one that was done.
  const auto last = std::llround(cycle.times.back() * 1000);
  EXPECT_GE(last, 200);
  EXPECT_EQ(report.ticks + report.missed, last + 1);
  EXPECT_EQ(report.ticks, static_cast<std::int64_t>(cycle.times.size()));
  EXPECT_EQ(report.lateness.count(), report.ticks);
  EXPECT_EQ(report.duration.count(), report.ticks);
  EXPECT_GE(report.wall, 0.2);  // no tick comes early
  EXPECT_FALSE(report.interrupted);
  EXPECT_FALSE(report.watchdog_tripped);
  EXPECT_EQ(cycle.cuts, 0);
}

TEST(ServoRealTime, SkipsTicksWhoseTimeHasPassedAndCountsThem) {
  Cycle cycle([](double now) {
    if (now == 0) sleepFor(20);
    return now < 0.04;
  });
  const ServoReport report = runServo(realTime(), cycle, kNeverStop);
  EXPECT_GE(report.missed, 19);
  ASSERT_GE(cycle.times.size(), 2u);
  EXPECT_GE(cycle.times[1], 0.020);
  for (std::size_t k = 1; k < cycle.times.size(); ++k) EXPECT_GT(cycle.times[k], cycle.times[k - 1]);
}

// A busy machine took the time of a simulated session's ticks, and its watchdog ended the trial.
TEST(ServoPaced, LosesNoTickToAStallAndWatchesNobody) {
  ServoOptions options;
  options.clock = ServoClock::kPaced;
  options.watchdog = 1e-3;
  Cycle cycle([n = 0](double) mutable {
    if (n % 10 == 5) sleepFor(30);
    return ++n < 40;
  });
  const ServoReport report = runServo(options, cycle, kNeverStop);
  ASSERT_EQ(cycle.times.size(), 40u);
  // to the bit
  for (std::size_t k = 0; k < cycle.times.size(); ++k) ASSERT_EQ(cycle.times[k], static_cast<double>(k) / 1000);
  EXPECT_EQ(cycle.cuts, 0);
  EXPECT_FALSE(report.watchdog_tripped);
  EXPECT_GE(report.missed, 4 * 29);
  EXPECT_GE(report.wall, 0.039 + 4 * 0.029);
  EXPECT_EQ(report.lateness.count(), report.ticks);
}

TEST(ServoPaced, BeginsNoTickEarly) {
  ServoOptions options;
  options.clock = ServoClock::kPaced;
  const auto start = std::chrono::steady_clock::now();
  Cycle cycle([&](double now) {
    EXPECT_GE(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), now);
    return now < 0.05;
  });
  runServo(options, cycle, kNeverStop);
}

TEST(ServoReport, ThatCanNotBeShownEndsNothing) {
  ServoOptions options = realTime();
  options.watchdog = 0.02;
  std::atomic<int> shown{0};
  options.show = [&](const ServoReport&) {
    ++shown;
    throw std::bad_alloc();
  };
  Cycle cycle([&](double now) {
    if (now > 0.005 && shown == 0) requestServoReport();
    return shown == 0 && now < 20;
  });
  EXPECT_FALSE(runServo(options, cycle, kNeverStop).watchdog_tripped);
  EXPECT_GE(shown, 1);
}

TEST(ServoRealTime, StopsWhenAnotherThreadInterrupts) {
  std::atomic<bool> interrupted{false};
  Cycle cycle([](double) { return true; });
  std::thread operator_thread([&] {
    sleepFor(20);
    interrupted = true;
  });
  EXPECT_TRUE(runServo(realTime(), cycle, interrupted).interrupted);
  operator_thread.join();
}

TEST(ServoRealTime, CutsForcesAndPassesAnExceptionOn) {
  Cycle cycle([](double) -> bool { throw std::runtime_error("the cable is off"); });
  EXPECT_THROW(runServo(realTime(), cycle, kNeverStop), std::runtime_error);
  EXPECT_GE(cycle.cuts, 1);
}

// Tells how many threads there are when forces are cut first.
class ThreadCount final : public ServoCycle {
 public:
  explicit ThreadCount(std::function<bool()> work) : work_(std::move(work)) {}
  bool tick(double) override {
    in_tick = threads();
    return work_();
  }
  void cutForces() noexcept override {
    if (at_first_cut == 0) at_first_cut = threads();
  }
  std::ptrdiff_t in_tick = 0, at_first_cut = 0;

 private:
  static std::ptrdiff_t threads() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"), std::filesystem::directory_iterator());
  }
  const std::function<bool()> work_;
};

// The forces of an arm lasted for milliseconds after the exception, until the watchdog's thread had ended.
TEST(ServoRealTime, CutsForcesBeforeItWaitsForTheWatchdogsThread) {
  ThreadCount cycle([]() -> bool { throw std::runtime_error("the cable is off"); });
  EXPECT_THROW(runServo(realTime(), cycle, kNeverStop), std::runtime_error);
  EXPECT_GE(cycle.in_tick, 2);
  EXPECT_EQ(cycle.at_first_cut, cycle.in_tick);
}

// Likewise after SIGTERM, until the force was 4 ms old.
TEST(ServoRealTime, CutsForcesAtOnceWhenInterrupted) {
  std::atomic<bool> interrupted{false};
  ThreadCount cycle([&] { return interrupted = true; });
  EXPECT_TRUE(runServo(realTime(), cycle, interrupted).interrupted);
  EXPECT_GE(cycle.in_tick, 2);
  EXPECT_EQ(cycle.at_first_cut, cycle.in_tick);
}

TEST(ServoRealTime, NamesWhatTheSystemDidNotPermit) {
  Cycle cycle([](double) { return false; });
  const std::string note = runServo(realTime(), cycle, kNeverStop).note;
  EXPECT_TRUE(note.empty() || note.find("limits.conf") != std::string::npos) << note;
}

TEST(ServoWatchdog, CutsForcesFromItsOwnThreadWhenATickStalls) {
  ServoOptions options = realTime();
  options.watchdog = 5e-3;
  const Cycle* self = nullptr;
  Cycle cycle([&](double) {
    sleepFor(50);
    for (int i = 0; i < 200 && self->cuts == 0; ++i) sleepFor(50);  // a busy machine may let the watchdog wait, too
    return false;
  });
  self = &cycle;
  const ServoReport report = runServo(options, cycle, kNeverStop);
  EXPECT_TRUE(report.watchdog_tripped);
  EXPECT_EQ(cycle.cuts, 1) << "latched: cut once, not at every check";
  EXPECT_EQ(cycle.cuts_by_another_thread, 1);
}

TEST(ServoReport, IsShownOnRequestWhileTheServoRuns) {
  ServoOptions options = realTime();
  options.watchdog = 0.02;  // it looks often
  std::atomic<std::int64_t> shown_ticks{0};
  options.show = [&](const ServoReport& report) { shown_ticks = report.ticks; };
  Cycle cycle([&](double now) {
    if (now > 0.005 && shown_ticks == 0) requestServoReport();
    return shown_ticks == 0 && now < 20;
  });
  runServo(options, cycle, kNeverStop);
  EXPECT_GT(shown_ticks, 0);
}

TEST(ServoReport, HoldsTheStagesOfTheCycleAndAddsThoseOfTheSameName) {
  class Staged final : public ServoCycle {
   public:
    bool tick(double now) override {
      times_.add(1e-6);
      return now < 0.0045;
    }
    void cutForces() noexcept override {}
    std::vector<StageTimes> stages() const override { return {{"physics", times_}}; }

   private:
    Histogram times_;
  };
  Staged first, second;
  ServoReport sum = runServo({}, first, kNeverStop);
  sum.add(runServo({}, second, kNeverStop));
  ASSERT_EQ(sum.stages.size(), 1u);
  EXPECT_EQ(sum.stages[0].times.count(), 12);
}

TEST(ServoReport, AddsAnotherAsIfTheTwoWereOneRun) {
  Cycle first([](double now) { return now < 0.02; }), second([](double now) { return now < 0.01; });
  const ServoReport a = runServo(realTime(), first, kNeverStop), b = runServo({}, second, kNeverStop);
  ServoReport sum = a;
  sum.add(b);
  EXPECT_EQ(sum.ticks, a.ticks + b.ticks);
  EXPECT_EQ(sum.missed, a.missed);
  EXPECT_EQ(sum.lateness.count(), a.ticks);
  EXPECT_EQ(sum.duration.count(), sum.ticks);
  EXPECT_EQ(sum.wall, a.wall + b.wall);
  EXPECT_EQ(sum.note, a.note);
  ServoReport other;
  other.watchdog_tripped = other.interrupted = true;
  sum.add(other);
  EXPECT_TRUE(sum.watchdog_tripped && sum.interrupted);
}

}  // namespace
}  // namespace pincer::tasks
