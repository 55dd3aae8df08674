// Promises of a session when the process or the disk dies.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::TemporaryDirectory;
using namespace std::chrono_literals;

SampleRecord sampleAt(std::int64_t trial, std::int64_t tick) {
  SampleRecord s;
  s.trial = trial;
  s.tick = tick;
  s.time = static_cast<double>(tick) * 1e-3;
  s.fingers[0].normal_force = 1.0 / 3;
  return s;
}

// A child that writes trials of 100 ticks at 1 kHz until it is killed, and tells through a pipe each tick that it is
// about to push (>= 0) and each trial that is finished (< 0).
[[noreturn]] void runChild(const std::string& path, int pipe) {
  const auto tell = [&](std::int64_t number) {
    if (::write(pipe, &number, sizeof number) != sizeof number) ::_exit(1);
  };
  auto writer = SessionWriter::create(path, {});
  for (std::int64_t tick = 0;; ++tick) {
    writer.pushSample(sampleAt(tick / 100, tick));
    tell(tick);
    if (tick % 100 == 99) {
      TrialRecord trial;
      trial.trial = tick / 100;
      writer.finishTrial(trial);
      tell(-1 - trial.trial);
    }
    std::this_thread::sleep_for(1ms);
  }
}

struct Told {
  std::int64_t last_tick = -1, finished_trials = 0;
};

// Reads what the child says until it has pushed `ticks`, kills it, and reads the rest.
Told killAfter(pid_t child, int pipe, std::int64_t ticks) {
  Told told;
  std::int64_t number = 0;
  bool killed = false;
  while (::read(pipe, &number, sizeof number) == sizeof number) {
    if (number >= 0) told.last_tick = number;
    if (number < 0) told.finished_trials = -number;
    if (!killed && told.last_tick >= ticks) {
      ::kill(child, SIGKILL);
      killed = true;
    }
  }
  ::waitpid(child, nullptr, 0);
  return told;
}

class SessionKilledAt : public testing::TestWithParam<int> {};

TEST_P(SessionKilledAt, KeepsEveryFinishedTrialAndSaysThatItWasNotCompleted) {
  const TemporaryDirectory dir;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::close(ends[0]);
    runChild(dir / "a.db", ends[1]);
  }
  ::close(ends[1]);
  const Told told = killAfter(child, ends[0], GetParam());
  ::close(ends[0]);

  const SessionReader reader(dir / "a.db");
  EXPECT_EQ(reader.state(), "running");
  EXPECT_NE(reader.warning().find("was not completed"), std::string::npos);
  const auto trials = reader.trials();
  ASSERT_GE(static_cast<std::int64_t>(trials.size()), told.finished_trials);
  for (std::size_t k = 0; k < trials.size(); ++k) EXPECT_EQ(trials[k].trial, static_cast<std::int64_t>(k));

  std::int64_t count = 0;
  reader.forEachSample({}, [&](const SampleRecord& s) { EXPECT_EQ(s.tick, count++); });
  EXPECT_GE(count, 100 * told.finished_trials);  // a finished trial has all its samples
}

INSTANTIATE_TEST_SUITE_P(AnyTick, SessionKilledAt, testing::Values(0, 57, 99, 100, 250, 333));

// Samples reach the file without anybody finishing a trial. The wait has a generous end, and no time is asserted.
TEST(KilledSession, KeepsTheSamplesOfAnUnfinishedTrial) {
  const TemporaryDirectory dir;
  const std::string path = dir / "a.db";
  SessionWriter::create(dir / "other.db", {}).close();  // the parent has used the store before it forks, as a study may
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto writer = SessionWriter::create(path, {});
    for (std::int64_t tick = 0; tick < 300; ++tick) writer.pushSample(sampleAt(0, tick));
    writer.addEvent({0, 0.3, "squeeze", ""});
    for (;;) ::pause();
  }
  const auto stored = [&]() -> std::size_t {
    try {
      const SessionReader reader(path);
      std::size_t samples = 0;
      reader.forEachSample({}, [&](const SampleRecord&) { ++samples; });
      return samples + reader.events().size();
    } catch (const InputError&) {
      return 0;  // the child is still making the file
    }
  };
  for (int k = 0; k < 1000 && stored() < 301; ++k) std::this_thread::sleep_for(10ms);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(stored(), 301u);
  EXPECT_EQ(SessionReader(path).state(), "running");
}

// SQLite reports SQLITE_FULL at the page limit exactly as on a full disk.
TEST(FullSession, FailsWithTheCauseAndMarksTheFile) {
  const TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", {}, {.block_when_full = true, .max_pages = 40});
  std::string error;
  std::int64_t finished = 0;
  for (std::int64_t trial = 0; trial < 1000 && error.empty(); ++trial) {
    try {
      for (std::int64_t k = 0; k < 20; ++k) writer.pushSample(sampleAt(trial, k));
      TrialRecord record;
      record.trial = trial;
      writer.finishTrial(record);
      ++finished;
    } catch (const InputError& e) {
      error = e.what();
    }
  }
  EXPECT_NE(error.find(dir / "a.db"), std::string::npos) << error;
  EXPECT_NE(error.find("Free some space"), std::string::npos) << error;
  EXPECT_NE(error.find("marked as aborted"), std::string::npos) << error;
  EXPECT_FALSE(writer.pushSample({}));
  EXPECT_THROW(writer.addEvent({}), InputError);
  EXPECT_THROW(writer.close(), InputError);

  const SessionReader reader(dir / "a.db");
  EXPECT_EQ(reader.state().rfind("aborted: ", 0), 0u) << reader.state();
  EXPECT_NE(reader.warning().find("not completed"), std::string::npos);
  EXPECT_GT(finished, 0);
  EXPECT_EQ(static_cast<std::int64_t>(reader.trials().size()), finished);
}

// Samples alone can fill the disk too: the writer thread fails with nobody waiting, and close() says so.
TEST(FullSession, TellsAtCloseWhatTheWriterThreadMet) {
  const TemporaryDirectory dir;
  auto writer =
      SessionWriter::create(dir / "a.db", {}, {.block_when_full = true, .ring_capacity = 64, .max_pages = 40});
  std::int64_t taken = 0;
  while (taken < 100'000 && writer.pushSample(sampleAt(0, taken))) ++taken;
  EXPECT_LT(taken, 100'000);
  EXPECT_THROW(writer.close(), InputError);
}

TEST(FullSession, LeavesNothingWhenItCanNotEvenBegin) {
  const TemporaryDirectory dir;
  EXPECT_THROW(SessionWriter::create(dir / "a.db", {}, {.max_pages = 2}), InputError);
  EXPECT_THROW(SessionWriter::create(dir / "b.db", {}, {.ring_capacity = 3}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

// A tiny file system of its own, where the system lets the test make one.
class TinyDisk {
 public:
  TinyDisk() : mounted_(::mount("tmpfs", dir_.path().c_str(), "tmpfs", 0, "size=512k") == 0) {}
  ~TinyDisk() {
    if (mounted_) ::umount2(dir_.path().c_str(), MNT_DETACH);
  }
  bool mounted() const { return mounted_; }
  std::string operator/(const std::string& name) const { return dir_ / name; }

 private:
  TemporaryDirectory dir_;
  bool mounted_;
};

TEST(FullDisk, FailsWithTheCauseAndKeepsFinishedTrials) {
  const TinyDisk disk;
  if (!disk.mounted())
    GTEST_SKIP() << "may not mount a tmpfs here; FullSession covers the same path through SQLite's page limit";
  std::string error;
  std::size_t finished = 0;
  {
    auto writer = SessionWriter::create(disk / "a.db", {}, {.block_when_full = true});
    while (error.empty() && finished < 1000) {
      try {
        for (std::int64_t k = 0; k < 20; ++k) writer.pushSample(sampleAt(static_cast<std::int64_t>(finished), k));
        TrialRecord row;
        row.trial = static_cast<std::int64_t>(finished);
        writer.finishTrial(row);
        ++finished;
      } catch (const InputError& e) {
        error = e.what();
      }
    }
  }
  EXPECT_NE(error.find("full"), std::string::npos) << error;
  EXPECT_GT(finished, 0u);
  const SessionReader reader(disk / "a.db");
  EXPECT_GE(reader.trials().size(), finished);
  EXPECT_FALSE(reader.complete());
  EXPECT_FALSE(reader.warning().empty());
}

// SQLite repeats the file's own words: here a control character in the text of an index.
TEST(DamagedSession, ShowsControlCharactersOfItsSchemaAsText) {
  const TemporaryDirectory folder;
  const std::string path = folder / "session.db";
  SessionWriter::create(path, {}).close();
  std::string bytes = tests::readFile(path);
  const std::size_t at = bytes.find("ON response");
  ASSERT_NE(at, std::string::npos);
  bytes[at] = '\x01';
  std::ofstream(path, std::ios::binary) << bytes;
  std::string said;
  try {
    SessionReader(path).trials();
  } catch (const InputError& refusal) {
    said = refusal.what();
  }
  EXPECT_NE(said.find("malformed database schema"), std::string::npos) << said;
  EXPECT_TRUE(std::none_of(said.begin(), said.end(), [](unsigned char c) { return c < ' '; })) << said;
}

}  // namespace
}  // namespace pincer::tasks
