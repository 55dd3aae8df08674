// A pickup study into a session file under the servo: which ticks are kept, what an
// interrupt leaves, and what a person is told.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/sessions/manipulation_session.h"
#include "pincer/tasks/run/servo/paced_cycle.h"
#include "pincer/tasks/run/servo/servo_text.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/session_samples.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::samplesOf;

const std::atomic<bool> kNobodyEnds{false};

ManipulationSessionOptions shortStudy(int repetitions = 1) {
  ManipulationSessionOptions options;
  options.study.participants = 1;
  options.study.tasks = {HandTask::kPickup};
  options.study.training.pickups = 0;
  options.study.conditions = {publishedHandConditions()[1]};
  options.study.pickup.frictions = {0.9};
  options.study.pickup.repetitions = repetitions;
  options.study.pickup.timeout = 3;
  return options;
}

TEST(PickupSession, KeepsEveryFifthTickByDefault) {
  const tests::TemporaryDirectory directory;
  const ManipulationSessionResult result = runManipulationSession(shortStudy(), directory / "thin.db", kNobodyEnds, {});
  EXPECT_EQ(result.trials, 1u);
  const SessionReader session(directory / "thin.db");
  const std::vector<SampleRecord> samples = samplesOf(session);
  EXPECT_EQ(static_cast<std::int64_t>(samples.size()), (result.servo.ticks + 4) / 5);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ASSERT_EQ(samples[k].tick, static_cast<std::int64_t>(5 * k));
    ASSERT_EQ(samples[k].time, static_cast<double>(samples[k].tick) / 1000);
  }
  EXPECT_NE(session.info().devices_json.find("\"sample_rate\": 200"), std::string::npos) << session.info().devices_json;
}

// The kept ticks are those of the full session, and everything else is the same.
TEST(PickupSession, IsThinnedWithoutChangingWhatHappens) {
  const tests::TemporaryDirectory directory;
  ManipulationSessionOptions options = shortStudy();
  runManipulationSession(options, directory / "thin.db", kNobodyEnds, {});
  options.sample_rate = 1000;
  const ManipulationSessionResult result = runManipulationSession(options, directory / "full.db", kNobodyEnds, {});
  const SessionReader thin(directory / "thin.db"), full(directory / "full.db");
  const std::vector<SampleRecord> few = samplesOf(thin), all = samplesOf(full);
  ASSERT_EQ(static_cast<std::int64_t>(all.size()), result.servo.ticks);
  ASSERT_EQ(few.size(), (all.size() + 4) / 5);
  for (std::size_t k = 0; k < few.size(); ++k) {
    ASSERT_EQ(few[k].tick, all[5 * k].tick);
    ASSERT_EQ(few[k].p_WB, all[5 * k].p_WB);
    ASSERT_EQ(few[k].fingers[0].f_arm_D, all[5 * k].fingers[0].f_arm_D);
  }
  ASSERT_EQ(thin.trials().size(), 1u);
  EXPECT_EQ(thin.trials()[0].duration, full.trials()[0].duration);
  EXPECT_EQ(thin.trials()[0].squeezes, full.trials()[0].squeezes);
  EXPECT_EQ(thin.events().size(), full.events().size());
}

TEST(PickupSession, RefusesASampleRateThatDoesNotDivideTheTickRate) {
  const tests::TemporaryDirectory directory;
  for (const int rate : {-200, 3, 300, 1001, 2000}) {
    ManipulationSessionOptions options = shortStudy();
    options.sample_rate = rate;
    try {
      runManipulationSession(options, directory / "bad.db", kNobodyEnds, {});
      FAIL() << rate;
    } catch (const InputError& e) {
      const std::string said = e.what();
      EXPECT_NE(said.find("sample_rate = " + std::to_string(rate)), std::string::npos) << said;
      EXPECT_NE(said.find("[1, 1000]"), std::string::npos) << said;
    }
    EXPECT_FALSE(std::filesystem::exists(directory / "bad.db"));
  }
  for (const int rate : {0, 1, 8, 125, 1000}) {
    ManipulationSessionOptions options = shortStudy();
    options.sample_rate = rate;
    EXPECT_NO_THROW(validate(options)) << rate;
  }
}

TEST(PickupSession, KeepsFinishedTrialsWhenInterrupted) {
  const tests::TemporaryDirectory directory;
  std::atomic<bool> interrupted{false};
  const auto after_two = [&](const TrialProgress& progress) { interrupted = progress.done == 2; };
  const ManipulationSessionResult result =
      runManipulationSession(shortStudy(4), directory / "s.db", interrupted, after_two);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.trials, 2u);
  const SessionReader session(directory / "s.db");
  EXPECT_EQ(session.trials().size(), 2u);
  EXPECT_EQ(session.state(), "aborted: interrupted by the user");
}

TEST(PickupSession, IsCompleteWhenTheInterruptComesAfterTheLastTrial) {
  const tests::TemporaryDirectory directory;
  std::atomic<bool> interrupted{false};
  const auto at_the_end = [&](const TrialProgress& progress) { interrupted = progress.done == progress.total; };
  EXPECT_FALSE(runManipulationSession(shortStudy(), directory / "s.db", interrupted, at_the_end).interrupted);
  EXPECT_TRUE(SessionReader(directory / "s.db").complete());
}

// Interrupts after so many ticks, however long a session takes to set up.
class InterruptingCycle final : public ServoCycle {
 public:
  InterruptingCycle(ServoCycle& inner, int ticks, std::atomic<bool>& interrupted)
      : inner_(inner), left_(ticks), interrupted_(interrupted) {}
  bool tick(double now) override {
    if (--left_ == 0) interrupted_ = true;
    return inner_.tick(now);
  }
  void cutForces() noexcept override { inner_.cutForces(); }

 private:
  ServoCycle& inner_;
  int left_;
  std::atomic<bool>& interrupted_;
};

TEST(PickupSession, AccountsForTheTicksOfAnInterruptedTrialInRealTime) {
  const tests::TemporaryDirectory directory;
  ManipulationSessionOptions options = shortStudy();
  options.servo.clock = ServoClock::kPaced;
  std::atomic<bool> interrupted{false};
  options.host.serve = [&](HandsCycle& cycle, std::size_t, std::size_t) {
    InterruptingCycle interrupting(cycle, 100, interrupted);
    return runServo(options.servo, interrupting, interrupted);
  };
  const ManipulationSessionResult result = runManipulationSession(options, directory / "s.db", interrupted, {});
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.servo.ticks, 100);
  EXPECT_EQ(result.servo.lateness.count(), result.servo.ticks);
  EXPECT_EQ(SessionReader(directory / "s.db").state(), "aborted: interrupted by the user");
}

// A machine that is busy with much else.
class StallingCycle final : public ServoCycle {
 public:
  explicit StallingCycle(ServoCycle& inner) : inner_(inner) {}
  bool tick(double now) override {
    if (++ticks_ % 500 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(25));
    return inner_.tick(now);
  }
  void cutForces() noexcept override { inner_.cutForces(); }

 private:
  ServoCycle& inner_;
  int ticks_ = 0;
};

// The trial was lost: "The servo loop stalled for 25 ms (limit 5)".
TEST(WatchedSession, IsTheSameToTheBitOnABusyMachine) {
  const tests::TemporaryDirectory directory;
  ManipulationSessionOptions options = shortStudy();
  options.sample_rate = 1000;
  runManipulationSession(options, directory / "alone.db", kNobodyEnds, {});
  options.servo.clock = ServoClock::kPaced;
  options.host.serve = [&](HandsCycle& cycle, std::size_t, std::size_t) {
    StallingCycle stalling(cycle);
    PaceControl pace;
    PacedCycle paced(stalling, pace, options.servo.rate);  // as the window has it (tasks/view/view_run.cpp)
    return runServo(options.servo, paced, kNobodyEnds);
  };
  const ManipulationSessionResult result = runManipulationSession(options, directory / "watched.db", kNobodyEnds, {});
  EXPECT_FALSE(result.servo.watchdog_tripped);
  EXPECT_GT(result.servo.missed, 24);
  const SessionReader alone(directory / "alone.db"), watched(directory / "watched.db");
  const std::vector<SampleRecord> a = samplesOf(alone), b = samplesOf(watched);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].time, b[k].time);
    ASSERT_EQ(a[k].status, b[k].status);
    ASSERT_EQ(a[k].p_WB, b[k].p_WB);
    for (std::size_t i = 0; i < a[k].fingers.size(); ++i) ASSERT_EQ(a[k].fingers[i].f_arm_D, b[k].fingers[i].f_arm_D);
  }
  EXPECT_EQ(watched.samplesDropped(), 0);
  ASSERT_EQ(watched.trials().size(), 1u);
  EXPECT_EQ(watched.trials()[0].outcome, alone.trials()[0].outcome);
  EXPECT_EQ(watched.trials()[0].duration, alone.trials()[0].duration);
}

// The operator ended the session; it was "complete", and couldn't be gone on with.
TEST(RefusedSession, IsNotComplete) {
  const tests::TemporaryDirectory directory;
  ManipulationSessionOptions options = shortStudy();
  options.host.arm = [](const std::string&) { return false; };
  EXPECT_TRUE(runManipulationSession(options, directory / "s.db", kNobodyEnds, {}).interrupted);
  EXPECT_EQ(SessionReader(directory / "s.db").state(), "aborted: interrupted by the user");
}

TEST(ServoText, SaysHowTheClockDidAndWhatWentWrong) {
  ServoReport report;
  report.ticks = 990;
  report.missed = 10;
  report.wall = 1;
  for (int i = 0; i < 990; ++i) {
    report.lateness.add(20e-6);
    report.duration.add(5e-6);
  }
  report.lateness.add(8e-3);
  const std::string good = servoText(report, 1e-3);
  EXPECT_NE(good.find("990 ticks of 1000 us in 1.0 s; 10 missed (1 %)"), std::string::npos) << good;
  EXPECT_NE(good.find("largest 8000.0 us"), std::string::npos) << good;
  EXPECT_EQ(good.find("watchdog"), std::string::npos) << good;
  report.watchdog_tripped = true;
  report.note = "Locked memory isn't permitted.";
  const std::string bad = servoText(report, 1e-3);
  EXPECT_NE(bad.find("watchdog cut the forces"), std::string::npos) << bad;
  EXPECT_NE(bad.find("\nLocked memory isn't permitted."), std::string::npos) << bad;
}

TEST(ServoText, SpeaksOfARunWithoutATick) { EXPECT_EQ(servoText({}, 1e-3).find("nan"), std::string::npos); }

}  // namespace
}  // namespace pincer::tasks
