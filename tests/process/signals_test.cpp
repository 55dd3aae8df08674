// One policy for signals (tasks/app/interrupt.h): the first ends the command
// cleanly with exit code 5, a later one at once.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/spawned.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using namespace std::chrono_literals;
using tests::Spawned;
using tests::spawnPincer;
using tests::TemporaryDirectory;

// Waits until `done`, at most a minute.
template <class Done>
void awaitThat(const Done& done) {
  for (int k = 0; k < 6000 && !done(); ++k) std::this_thread::sleep_for(10ms);
}

bool holdsATrial(const std::string& path) {
  try {
    return !SessionReader(path).trials().empty();
  } catch (const std::exception&) {
    return false;  // still being made
  }
}

class EndingSignal : public testing::TestWithParam<int> {};

TEST_P(EndingSignal, LeavesASessionThatSaysSo) {
  const TemporaryDirectory directory;
  const Spawned ended =
      spawnPincer({"run", "sphere-pickup", "--no-report", "--out", directory.path()}, {.meanwhile = [&](pid_t child) {
                    awaitThat([&] { return holdsATrial(directory / "session.db"); });
                    ::kill(child, GetParam());
                  }});
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_NE((ended.out + ended.error).find("nterrupted"), std::string::npos);
  const SessionReader session(directory / "session.db");
  EXPECT_EQ(session.state(), "aborted: interrupted by the user");
  EXPECT_GE(session.trials().size(), 1u);
}

// While gnuplot draws, which nobody else ends.
TEST_P(EndingSignal, LeavesNothingOfAReportBehind) {
  const TemporaryDirectory directory;
  const std::string session = directory / "session.db", bin = directory / "bin", temporary = directory / "tmp";
  ASSERT_EQ(spawnPincer({"run", "sphere-pickup", "--repetitions", "1", "--friction", "0.9", "--no-report", "--out",
                         directory.path()})
                .exit_code,
            0);
  std::filesystem::create_directory(bin);
  std::filesystem::create_directory(temporary);
  std::ofstream(bin + "/gnuplot") << "#!/bin/sh\necho $$ > '" << bin << "/pid'\nexec sleep 600\n";
  ::chmod((bin + "/gnuplot").c_str(), 0755);
  const Spawned ended = spawnPincer(
      {"report", session, "--html", directory / "page.html"},
      {.environment = {"PATH=" + bin + ":/usr/bin:/bin", "TMPDIR=" + temporary}, .meanwhile = [&](pid_t child) {
         awaitThat([&] { return !tests::readFile(bin + "/pid").empty(); });
         ::kill(child, GetParam());
       }});
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_NE(ended.error.find("pincer: interrupted"), std::string::npos) << ended.error;
  EXPECT_FALSE(std::filesystem::exists(directory / "page.html"));
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
  const int gnuplot = std::atoi(tests::readFile(bin + "/pid").c_str());
  ASSERT_GT(gnuplot, 0);
  EXPECT_EQ(::kill(gnuplot, 0), -1) << "gnuplot outlives the report";
}

INSTANTIATE_TEST_SUITE_P(InterruptTerminateHangUp, EndingSignal, testing::Values(SIGINT, SIGTERM, SIGHUP));

// Stopped meanwhile, so that it can't end in between.
TEST(SecondSignal, EndsTheProgramAtOnce) {
  const TemporaryDirectory directory;
  const Spawned ended =
      spawnPincer({"run", "sphere-pickup", "--repetitions", "50", "--no-report", "--out", directory.path()},
                  {.meanwhile = [&](pid_t child) {
                    awaitThat([&] { return holdsATrial(directory / "session.db"); });
                    ::kill(child, SIGSTOP);
                    ::kill(child, SIGINT);
                    ::kill(child, SIGCONT);
                    std::this_thread::sleep_for(1ms);
                    ::kill(child, SIGSTOP);
                    std::this_thread::sleep_for(300ms);
                    ::kill(child, SIGTERM);
                    ::kill(child, SIGCONT);
                  }});
  EXPECT_TRUE(ended.signal == SIGTERM || ended.exit_code == 5);
}

// As `timeout` sends them, to the program and to its group: once left sessions "running".
TEST(SecondSignal, IsTheSameWishWhereItComesAtOnce) {
  const TemporaryDirectory directory;
  const Spawned ended =
      spawnPincer({"run", "sphere-pickup", "--repetitions", "50", "--no-report", "--out", directory.path()},
                  {.meanwhile = [&](pid_t child) {
                    awaitThat([&] { return holdsATrial(directory / "session.db"); });
                    // both are there when it goes on, whatever this machine does
                    ::kill(child, SIGSTOP);
                    ::kill(child, SIGINT);
                    ::kill(child, SIGTERM);
                    ::kill(child, SIGCONT);
                  }});
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_EQ(SessionReader(directory / "session.db").state(), "aborted: interrupted by the user");
}

// nohup
TEST(HangUp, IsIgnoredWhereItWas) {
  const TemporaryDirectory directory;
  const Spawned ended = spawnPincer(
      {"run", "sphere-pickup", "--repetitions", "2", "--friction", "0.9", "--no-report", "--out", directory.path()},
      {.prepare = [] { ::signal(SIGHUP, SIG_IGN); },
       .meanwhile =
           [&](pid_t child) {
             awaitThat([&] { return holdsATrial(directory / "session.db"); });
             ::kill(child, SIGHUP);
           }});
  EXPECT_EQ(ended.exit_code, 0) << ended.error;
  EXPECT_TRUE(SessionReader(directory / "session.db").complete());
}

}  // namespace
}  // namespace pincer::tasks
