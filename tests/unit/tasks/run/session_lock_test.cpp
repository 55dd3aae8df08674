// One program writes a session at a time, and a session is there whole or not at all.
#include "pincer/tasks/run/session/session_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/killed_at_call.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;
using tests::TemporaryDirectory;

TrialRecord trialOf(std::int64_t number) {
  TrialRecord trial;
  trial.trial = number;
  return trial;
}

// A process that writes one trial and then holds the session until it is killed.
class OtherProgram {
 public:
  explicit OtherProgram(const std::string& path) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    child_ = ::fork();
    if (child_ == 0) hold(path, ends[1]);
    ::close(ends[1]);
    char said = 0;
    EXPECT_EQ(::read(ends[0], &said, 1), 1);  // it has written
    ::close(ends[0]);
  }
  ~OtherProgram() { kill(); }
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = 0;
  }
  pid_t id() const { return child_; }

 private:
  [[noreturn]] static void hold(const std::string& path, int pipe) {
    SessionWriter writer = SessionWriter::create(path, {});
    writer.finishTrial(trialOf(0));
    if (::write(pipe, "w", 1) != 1) ::_exit(1);
    for (;;) ::pause();
  }
  pid_t child_ = 0;
};

TEST(SessionStore, TwoProgramsOnOneSessionAreRefused) {
  const TemporaryDirectory dir;
  OtherProgram other(dir / "a.db");
  const std::string error = errorOf([&] { SessionWriter::resume(dir / "a.db"); });
  EXPECT_TRUE(contains(error, "is being written by process " + std::to_string(other.id()) + " on ")) << error;
  EXPECT_TRUE(contains(error, "--resume")) << error;
  {
    const SessionReader reader(dir / "a.db");  // reading needs no lock
    EXPECT_EQ(reader.trials().size(), 1u);
    EXPECT_TRUE(contains(reader.warning(), "it still runs (process " + std::to_string(other.id()))) << reader.warning();
  }
  other.kill();
  EXPECT_TRUE(contains(SessionReader(dir / "a.db").warning(), "its program was killed"))
      << SessionReader(dir / "a.db").warning();
  SessionWriter writer = SessionWriter::resume(dir / "a.db");  // kill -9 frees it
  writer.finishTrial(trialOf(1));
  writer.close();
  EXPECT_EQ(SessionReader(dir / "a.db").trials().size(), 2u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1) << "the lock's file is left";
}

// By another name of the file, and in the same process.
TEST(SessionStore, TwoWritersOfOneProcessAreRefusedByAnyName) {
  const TemporaryDirectory dir;
  SessionWriter writer = SessionWriter::create(dir / "a.db", {});
  std::filesystem::create_symlink(dir / "a.db", dir / "link.db");
  EXPECT_TRUE(contains(errorOf([&] { SessionWriter::resume(dir / "a.db"); }), "is being written by process"));
  EXPECT_TRUE(contains(errorOf([&] { SessionWriter::resume(dir / "link.db"); }), "is being written by process"));
  writer.finishTrial(trialOf(0));  // what was refused took nothing from the first
  writer.close();
  EXPECT_TRUE(contains(errorOf([&] { SessionWriter::resume(dir / "a.db"); }), "there is nothing to go on with"));
}

TEST(SessionStore, ATrialIsNeverWrittenTwice) {
  const TemporaryDirectory dir;
  SessionWriter writer = SessionWriter::create(dir / "a.db", {});
  writer.finishTrial(trialOf(4));
  const std::string error = errorOf([&] { writer.finishTrial(trialOf(4)); });
  EXPECT_TRUE(contains(error, "A trial of that number is there already")) << error;
  EXPECT_EQ(SessionReader(dir / "a.db").trials().size(), 1u);
}

// As a pincer before format 5 could leave it.
void doubleTrials(const std::string& path) {
  Database old(path, Database::Mode::kWrite);
  old.run(
      "DROP INDEX one_row_per_trial_of_trial; INSERT INTO trial SELECT * FROM trial WHERE trial < 2; PRAGMA "
      "user_version = 4");
  old.close();
}

TEST(SessionStore, ReadersSayThatTrialsAreThereTwice) {
  const TemporaryDirectory dir;
  SessionWriter writer = SessionWriter::create(dir / "a.db", {});
  for (std::int64_t k = 0; k < 3; ++k) writer.finishTrial(trialOf(k));
  writer.abort("interrupted");
  doubleTrials(dir / "a.db");
  const SessionReader reader(dir / "a.db");
  EXPECT_EQ(reader.trials().size(), 3u);
  EXPECT_TRUE(
      contains(reader.warning(), "Two programs wrote this session at once: trials 1, 2 are there more than once"))
      << reader.warning();
  EXPECT_TRUE(contains(reader.warning(), "It holds 3 finished trials")) << reader.warning();
  const std::string error = errorOf([&] { SessionWriter::resume(dir / "a.db"); });
  EXPECT_TRUE(contains(error, "can't be gone on with. Two programs wrote")) << error;
}

// Goes on with the session, or makes it anew if there is none. Nothing else may be left beside it.
void expectMended(const TemporaryDirectory& dir, int call) {
  const bool is_there = std::filesystem::exists(dir / "a.db");
  if (is_there) {
    EXPECT_EQ(errorOf([&] { SessionReader reader(dir / "a.db"); }), "");
  }
  EXPECT_EQ(errorOf([&] {
              (is_there ? SessionWriter::resume(dir / "a.db") : SessionWriter::create(dir / "a.db", {})).close();
            }),
            "");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1) << "killed at system call " << call;
}

// Killed at each system call: there is nothing, or a session that can be read and gone on with.
TEST(KilledSession, IsThereWholeOrNotAtAll) {
  int whole = 0, calls = 0;
  for (auto ended = tests::Ended::kKilled; ended == tests::Ended::kKilled && !HasFailure(); ++calls) {
    const TemporaryDirectory dir;
    ended = tests::killedAtCall(calls, [&] {
      SessionWriter writer = SessionWriter::create(dir / "a.db", {});
      ::_exit(0);
    });
    if (ended == tests::Ended::kNotTraced) GTEST_SKIP() << "this machine lets no program trace its own children";
    whole += std::filesystem::exists(dir / "a.db");
    expectMended(dir, calls);
  }
  EXPECT_GT(whole, 1);
  EXPECT_GT(calls - whole, 10);
}

// As a file system leaves it that has no renaming in one step.
TEST(KilledSession, BetweenItsTwoNamesKeepsOne) {
  const TemporaryDirectory dir;
  SessionWriter::create(dir / "a.db", {}).abort("killed");
  std::filesystem::create_hard_link(dir / "a.db", dir / ".a.db.0123456789abcdef.part");
  expectMended(dir, -1);
}

// Remains of a session that was killed while it was made: pincers before format 5 made it at its place.
TEST(KilledSession, BeforeItWasMadeIsSaidToHoldNothing) {
  const TemporaryDirectory dir;
  std::ofstream(dir / "empty.db").close();
  std::ofstream(dir / "named.db").close();
  Database(dir / "named.db", Database::Mode::kWrite).run("PRAGMA application_id = 1347306322");
  std::ofstream(dir / "log.db").close();
  Database(dir / "log.db", Database::Mode::kWrite).text("PRAGMA journal_mode = WAL");
  std::ofstream(dir / ".part.db.0123456789abcdef.part").close();  // as this one leaves it
  for (const char* name : {"empty.db", "named.db", "log.db", "part.db"}) {
    const std::string read = errorOf([&] { SessionReader reader(dir / name); });
    EXPECT_TRUE(contains(read, "killed while it was being made and holds no trial. Delete it")) << name << ": " << read;
    EXPECT_EQ(errorOf([&] { SessionWriter::resume(dir / name); }), read);
  }
}

}  // namespace
}  // namespace pincer::tasks
