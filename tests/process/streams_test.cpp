// The program's standard streams closed, full, or read by nobody: it says what it can, loses no
// session, and never mixes messages into one.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/session_samples.h"
#include "pincer/tests/support/spawned.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::Spawned;
using tests::SpawnOptions;
using tests::spawnPincer;
using tests::TemporaryDirectory;

const std::vector<std::vector<int>> kClosed{{0}, {1}, {2}, {0, 1}, {0, 2}, {1, 2}, {0, 1, 2}};

std::vector<std::string> session(const std::string& directory) {
  return {"run",         "sphere-pickup", "--repetitions", "1",     "--friction", "0.9",
          "--condition", "cld+force",     "--no-report",   "--out", directory};
}

void expectWholeSession(const std::string& path) {
  const SessionReader reader(path);
  EXPECT_TRUE(reader.complete()) << reader.state();
  EXPECT_EQ(reader.trials().size(), 1u);
  EXPECT_GT(tests::samplesOf(reader).size(), 100u);
}

std::string nameOf(const std::vector<int>& closed) {
  std::string name;
  for (const int stream : closed) name += std::to_string(stream);
  return name;
}

TEST(ClosedStreams, EndEveryKindOfCommandWithItsExitCode) {
  const std::vector<std::pair<std::vector<std::string>, int>> commands{{{"report", "/no/such/session.db"}, 3},
                                                                       {{"sim", "no-such-scene"}, 3},
                                                                       {{"no-such-command"}, 2},
                                                                       {{"run", "sphere-pickup", "--nonsense"}, 2}};
  for (const auto& closed : kClosed) {
    for (const auto& [command, exit_code] : commands) {
      const Spawned ended = spawnPincer(command, {.closed = closed});
      EXPECT_EQ(ended.signal, 0) << command[0] << " without " << nameOf(closed);
      EXPECT_EQ(ended.exit_code, exit_code) << command[0] << " without " << nameOf(closed);
    }
  }
}

// A session that was given the file descriptor 2 had the program's messages in it.
TEST(ClosedStreams, LeaveTheSessionAlone) {
  for (const auto& closed : kClosed) {
    const TemporaryDirectory directory;
    const Spawned ended = spawnPincer(session(directory.path()), {.closed = closed});
    EXPECT_EQ(ended.signal, 0) << "without " << nameOf(closed);
    const bool unheard = std::find(closed.begin(), closed.end(), STDOUT_FILENO) != closed.end();
    EXPECT_EQ(ended.exit_code, unheard ? 3 : 0) << "without " << nameOf(closed) << ": " << ended.error;
    expectWholeSession(directory / "session.db");
  }
}

TEST(FullStreams, AreSaidToBeFull) {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"--help"}, {"--version"}, {"sim", "s4_pinch", "--duration", "0.01"}}) {
    const Spawned ended = spawnPincer(command, {.out_path = "/dev/full"});
    EXPECT_EQ(ended.exit_code, 3) << command[0];
    EXPECT_NE(ended.error.find("standard output can't be written"), std::string::npos) << ended.error;
  }
  EXPECT_EQ(spawnPincer({"sim", "no-such-scene"}, {.error_path = "/dev/full"}).exit_code, 3);
  EXPECT_EQ(spawnPincer({"no-such-command"}, {.out_path = "/dev/full", .error_path = "/dev/full"}).exit_code, 2);
}

// As `pincer run ... | head -0`.
TEST(ClosedPipe, LosesNoSession) {
  const TemporaryDirectory directory;
  const Spawned ended = spawnPincer(session(directory.path()), {.prepare = [] {
                                      int ends[2];
                                      if (::pipe(ends) != 0) ::_exit(126);
                                      ::dup2(ends[1], STDOUT_FILENO);
                                      ::close(ends[0]);
                                      ::close(ends[1]);
                                    }});
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_NE(ended.error.find("standard output can't be written"), std::string::npos) << ended.error;
  expectWholeSession(directory / "session.db");
}

// `ulimit -f`: SIGXFSZ ended the program.
TEST(LimitOfFileSize, IsReportedAsAFailedWrite) {
  const TemporaryDirectory directory;
  const Spawned ended = spawnPincer(session(directory.path()), {.prepare = [] {
                                      const rlimit small{128 << 10, 128 << 10};
                                      ::setrlimit(RLIMIT_FSIZE, &small);
                                    }});
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_NE(ended.error.find("session.db"), std::string::npos) << ended.error;
}

}  // namespace
}  // namespace pincer::tasks
