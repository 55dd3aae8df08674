// A person's session, replayed from what arms, displays and hands said to each tick.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "pincer/tasks/lab/experiments/live_hands.h"
#include "pincer/tasks/lab/experiments/mouse_hands.h"
#include "pincer/tasks/lab/sessions/manipulation_session.h"
#include "pincer/tasks/lab/sessions/replay.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tasks/run/session/input_codec.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

const std::atomic<bool> kNobodyStops{false};

ManipulationSessionOptions briefSession(int trials) {
  ManipulationSessionOptions options;
  options.study.participants = 1;
  options.study.tasks = {HandTask::kPickup};
  options.study.training.pickups = 0;
  options.study.conditions = {publishedHandConditions()[1]};
  options.study.pickup.frictions = {0.9};
  options.study.pickup.repetitions = trials;
  options.study.pickup.timeout = 4;
  options.devices = "mouse";
  return options;
}

// What a person does at the window, by the clock of the trial: down beside the sphere, squeeze,
// lift, wander about; let go near the end.
void gesture(devices::MouseHand& hand, const HandScene& scene, std::int64_t tick) {
  if (tick == 2000) hand.move({0, 0, scene.cues.place_W.z() - scene.homes_W[0].z()});
  if (tick == 2300) hand.squeeze(true);
  if (tick > 3300 && tick < 4300 && tick % 16 == 0)
    hand.move({0, 1e-4 * std::sin(0.01 * static_cast<double>(tick)), 1e-3});
  if (tick == 5200) hand.squeeze(false);
}

// A session at a mouse that nobody holds: the trials' ticks in virtual time, some of
// them late as in real time. `tell` each tick.
struct MouseSession {
  explicit MouseSession(ManipulationSessionOptions& options, std::function<void(std::int64_t)> tell = {}) {
    options.host.hands = [this](HandTrial& trial) {
      auto made = std::make_unique<MouseHands>(trial.scene());
      hands = made.get();
      return made;
    };
    options.host.serve = [this, tell](HandsCycle& cycle, std::size_t, std::size_t) {
      ServoReport report;
      for (std::int64_t tick = 0, late = 0;; ++tick) {
        late += tick % 701 == 700 ? 2 : 0;
        gesture(hands->hand(), cycle.trial().scene(), tick);
        if (tick == 5900) cycle.cutForces();  // the watchdog
        ++report.ticks;
        if (!cycle.tick(1e-9 * static_cast<double>(1'000'003 * (tick + late)))) return report;
        if (tell) tell(tick);
      }
    };
  }
  MouseHands* hands = nullptr;
};

double highest(const SessionReader& session) {
  double top = 0;
  session.forEachSample({}, [&](const SampleRecord& s) { top = std::max(top, s.p_WB[2]); });
  return top;
}

TEST(ReplayOfAPerson, AMouseSessionIsTheSameToTheBit) {
  const tests::TemporaryDirectory directory;
  auto options = briefSession(2);
  const MouseSession mouse(options);
  const auto done = runManipulationSession(options, directory / "s.db", kNobodyStops, {});
  const SessionReader session(directory / "s.db");
  EXPECT_GT(highest(session), 0.03) << "the sphere was lifted: there is something to be told apart";
  const ReplayResult replay = replaySession(session, {}, kNobodyStops);
  EXPECT_FALSE(replay.first) << replay.first->what;
  EXPECT_EQ(replay.trials, 2);
  EXPECT_EQ(replay.inputs, done.servo.ticks);
  EXPECT_GT(replay.samples, 2000);
  EXPECT_TRUE(replay.notes.empty());
  EXPECT_EQ(replaySession(session, {.trial = 1}, kNobodyStops).trials, 1);
}

// The tick where a finger was a nanometre elsewhere, and where that led.
TEST(ReplayOfAPerson, NamesTheFirstTickThatDiffers) {
  const tests::TemporaryDirectory directory;
  auto options = briefSession(1);
  const MouseSession mouse(options);
  runManipulationSession(options, directory / "s.db", kNobodyStops, {});
  auto inputs = SessionReader(directory / "s.db").inputs(0);
  inputs.at(3456).fingers[1].p_DF[0] += 1e-9;
  InputPacker packer;
  for (const InputRecord& input : inputs) packer.add(input);
  const InputChunk chunk = packer.take();
  {
    Database database(directory / "s.db", Database::Mode::kWrite);
    database.run("DELETE FROM input");
    Statement insert(database, "INSERT INTO input VALUES (?, ?, ?, ?, ?)");
    for (int i = 0; const std::int64_t value : {chunk.trial, chunk.first_tick, chunk.ticks, chunk.check})
      insert.bind(i++, value);
    insert.bindBytes(4, chunk.data.value);
    insert.step();
  }
  const ReplayResult replay = replaySession(SessionReader(directory / "s.db"), {}, kNobodyStops);
  ASSERT_TRUE(replay.first);
  EXPECT_EQ(replay.first->tick, 3456);
  EXPECT_NE(replay.first->what.find("f_arm_D"), std::string::npos) << replay.first->what;
  EXPECT_NE(replay.first->what.find(", is "), std::string::npos) << replay.first->what;
}

TEST(ReplayOfAPerson, FindsAByteThatChangedInTheFile) {
  const tests::TemporaryDirectory directory;
  auto options = briefSession(1);
  const MouseSession mouse(options);
  runManipulationSession(options, directory / "s.db", kNobodyStops, {});
  Database(directory / "s.db", Database::Mode::kWrite)
      .run(
          "UPDATE input SET data = CAST(substr(data, 1, 40) || x'5a' || substr(data, 42) AS BLOB) WHERE first_tick > "
          "2000");
  const std::string error = tests::errorOf([&] { replaySession(SessionReader(directory / "s.db"), {}, kNobodyStops); });
  EXPECT_NE(error.find("s.db: the inputs of trial 1, ticks "), std::string::npos) << error;
}

TEST(ReplayOfAPerson, GoesUpToWhereInputsWereLost) {
  const tests::TemporaryDirectory directory;
  auto options = briefSession(1);
  const MouseSession mouse(options, [](std::int64_t tick) {  // not so fast that all is one packet
    if (tick % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  runManipulationSession(options, directory / "s.db", kNobodyStops, {});
  Database(directory / "s.db", Database::Mode::kWrite).run("DELETE FROM input WHERE rowid = 3");
  const SessionReader session(directory / "s.db");
  const ReplayResult replay = replaySession(session, {}, kNobodyStops);
  EXPECT_FALSE(replay.first) << replay.first->what;
  ASSERT_EQ(replay.notes.size(), 1u);
  EXPECT_GT(replay.inputs, 0);
  EXPECT_NE(replay.notes[0].find(std::to_string(replay.inputs) + " inputs of its first ticks are kept"),
            std::string::npos);
  EXPECT_EQ(replay.trials, 0);
  EXPECT_EQ(replay.cut_short, 1);
}

// Killed at three moments that the clock chooses: what survived is a whole beginning, and it can be done again.
TEST(ReplayOfAPerson, AKilledSessionIsReplayedUpToWhatSurvived) {
  for (const int after : {900, 3700, 9300}) {  // ticks: before the start tone, while lifting, in the second trial
    const tests::TemporaryDirectory directory;
    int told[2];
    ASSERT_EQ(pipe(told), 0);
    const pid_t child = fork();
    if (child == 0) {
      auto options = briefSession(100);
      std::int64_t ticks = 0;
      const MouseSession mouse(options, [&](std::int64_t) {
        if (++ticks % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (write(told[1], &ticks, sizeof ticks) != sizeof ticks) _exit(1);
      });
      runManipulationSession(options, directory / "s.db", kNobodyStops, {});
      _exit(0);
    }
    close(told[1]);
    std::int64_t ticks = 0;
    while (ticks < after && read(told[0], &ticks, sizeof ticks) == sizeof ticks) {
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(told[0]);
    const SessionReader session(directory / "s.db");
    const ReplayResult replay = replaySession(session, {}, kNobodyStops);
    EXPECT_FALSE(replay.first) << replay.first->what;
    EXPECT_TRUE(replay.notes.empty());
    EXPECT_EQ(replay.cut_short, 1);
    EXPECT_EQ(replay.trials, static_cast<std::int64_t>(session.trials().size()));
    EXPECT_GT(replay.inputs, after / 4) << "20 ms of a child that runs up to ten times faster than a person are lost";
  }
}

// Arms with bases that stand off, capabilities and displays of their own, driven by hands that follow a path.
class FakeDevices final : public HandDevices {
 public:
  FakeDevices() {
    for (const char* name : {"index", "thumb"}) {
      devices::SimArmSettings arm;
      arm.serial = name;
      arms_.emplace_back(arm);
      displays_.emplace_back(devices::SimCldSettings{});
    }
  }
  devices::Arm& arm(int finger) override { return arms_[static_cast<std::size_t>(finger)]; }
  devices::TactileDisplay* display(int finger) override { return finger == 0 ? &displays_[0] : nullptr; }
  void setEpoch(std::int64_t) override {}
  void advanceTo(double now) override {
    if (!(now > time_)) return;
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      devices::HandPull pull;
      pull.stiffness = 400;
      pull.damping = 4;
      pull.p_D = {0, 0, 0.03 * std::min(now / 4, 1.0)};
      arms_[i].setHand(pull);
      arms_[i].advance(now - time_);
      displays_[i].advance(now - time_);
    }
    time_ = now;
  }
  ArmBase base(int finger) const override { return {{finger == 0 ? 0.003 : 0, 0.001, 0}, finger == 0 ? 0.02 : -0.01}; }
  std::vector<std::string> describe() override { return {"fake"}; }

 private:
  std::vector<devices::SimArm> arms_;
  std::vector<devices::SimCld> displays_;
  double time_ = 0;
};

TEST(ReplayOfAPerson, ASessionOnArmsKeepsTheirCalibrationsAndLimits) {
  const tests::TemporaryDirectory directory;
  auto options = briefSession(1);
  options.devices = "usb";
  FakeDevices devices;
  options.host.hands = [&](HandTrial& trial) { return std::make_unique<LiveHands>(trial, devices, 2.5e-3); };
  runManipulationSession(options, directory / "s.db", kNobodyStops, {});
  const SessionReader session(directory / "s.db");
  const HandsRecord hands = session.hands().at(0);
  EXPECT_EQ(hands.passive, 1);
  EXPECT_EQ(hands.oldest_sample, 2.5e-3);
  EXPECT_EQ(hands.fingers[0].base_turn, 0.02);
  EXPECT_GT(hands.fingers[1].peak_force, 0);
  double felt = 0;
  session.forEachInput(0,
                       [&](const InputRecord& input) { felt = std::max(felt, std::abs(input.fingers[0].f_arm_D[2])); });
  EXPECT_GT(felt, 0.1) << "the fingers touched something";
  const ReplayResult replay = replaySession(session, {}, kNobodyStops);
  EXPECT_FALSE(replay.first) << replay.first->what;
  EXPECT_EQ(replay.trials, 1);
  Database(directory / "s.db", Database::Mode::kWrite).run("UPDATE hands SET f0_base_turn_rad = 0.03");
  EXPECT_TRUE(replaySession(SessionReader(directory / "s.db"), {}, kNobodyStops).first)
      << "a base that stands elsewhere feels otherwise";
}

TEST(ReplayOfAPerson, ASessionFromBeforeInputsWereKeptSaysSo) {
  const tests::TemporaryDirectory directory;
  auto options = briefSession(1);
  const MouseSession mouse(options);
  runManipulationSession(options, directory / "s.db", kNobodyStops, {});
  Database(directory / "s.db", Database::Mode::kWrite)
      .run("DROP TABLE input; DROP TABLE hands; PRAGMA user_version = 2");
  const std::string error = tests::errorOf([&] { replaySession(SessionReader(directory / "s.db"), {}, kNobodyStops); });
  EXPECT_NE(error.find("didn't keep what people's hands did"), std::string::npos) << error;
}

}  // namespace
}  // namespace pincer::tasks
