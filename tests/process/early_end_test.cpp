// How long work ends early, and what other programs and libraries may say meanwhile.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <system_error>
#include <thread>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/measure_command.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/process/child_process.h"
#include "pincer/tasks/run/process/interrupted.h"
#include "pincer/tasks/run/process/threads.h"
#include "pincer/tasks/run/session/csv_export.h"
#include "pincer/tests/support/spawned.h"
#include "pincer/tests/support/synthetic_session.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::readFile;
using tests::Spawned;
using tests::spawnPincer;
using tests::TemporaryDirectory;

bool never() { return false; }

void writeSession(const std::string& path) {
  auto writer = SessionWriter::create(path, tests::SyntheticSession::info(), {.block_when_full = true});
  tests::SyntheticSession({.repetitions = 1}).writeTo(writer);
  writer.close();
}

TEST(InterruptedReader, EndsAtTheNextRow) {
  const TemporaryDirectory directory;
  writeSession(directory / "a.db");
  SessionReader session(directory / "a.db");
  std::atomic<bool> interrupted{false};
  session.heed(interrupted);
  int samples = 0;
  const auto take = [&](const SampleRecord&) { interrupted = ++samples == 10; };
  EXPECT_THROW(session.forEachSample({}, take), Interrupted);
  EXPECT_EQ(samples, 10);
}

TEST(InterruptedExport, LeavesNoPartOfATable) {
  const TemporaryDirectory directory;
  writeSession(directory / "a.db");
  SessionReader session(directory / "a.db");
  std::atomic<bool> interrupted{false};
  session.heed(interrupted);
  std::thread user([&] {
    while (!std::filesystem::exists(directory / "csv/trial.csv"))
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    interrupted = true;
  });
  try {
    exportCsv(session, directory / "csv");
  } catch (const Interrupted&) {
  }
  user.join();
  for (const auto& file : std::filesystem::directory_iterator(directory / "csv"))
    EXPECT_EQ(file.path().extension(), ".csv") << file.path();
}

TEST(ChildProcess, SaysHowItEnded) {
  const TemporaryDirectory directory;
  EXPECT_EQ(ChildProcess({"sh", "-c", "echo heard; pwd; exit 7"}, directory.path(), "log").wait(never), 7);
  EXPECT_EQ(readFile(directory / "log"), "heard\n" + directory.path() + "\n");
  EXPECT_EQ(ChildProcess({"sh", "-c", "kill -TERM $$"}, directory.path(), "log").wait(never), 128 + SIGTERM);
  EXPECT_THROW(ChildProcess({"no-such-program"}, directory.path(), "log"), std::system_error);
  EXPECT_THROW(ChildProcess({"sh"}, directory / "none", "log"), std::system_error);
}

TEST(ChildProcess, NeverOutlivesItsUser) {
  const TemporaryDirectory directory;
  std::atomic<bool> interrupted{false};
  std::thread user([&] {
    while (readFile(directory / "log").empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    interrupted = true;
  });
  {
    ChildProcess child({"sh", "-c", "trap '' TERM; echo $$; while :; do sleep 0.1; done"}, directory.path(),
                       "log");  // which doesn't listen
    EXPECT_THROW(child.wait([&] { return interrupted.load(); }), Interrupted);
  }
  user.join();
  EXPECT_EQ(::kill(std::atoi(readFile(directory / "log").c_str()), 0), -1);
}

TEST(ChildProcess, IsHeardLineByLine) {
  ChildProcess child({"sh", "-c", "printf 'one\\n\\ntwo '; sleep 0.1; printf 'three'; exit 2"});
  std::vector<std::string> lines;
  for (std::string line; child.readLine(line, never);) lines.push_back(line);
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "", "two three"}));
  EXPECT_EQ(child.wait(never), 2);
  std::string line;
  EXPECT_THROW(ChildProcess({"sleep", "600"}).readLine(line, [] { return true; }), Interrupted);
}

TEST(Threads, AllDoTheWorkAndTheCallerToo) {
  std::atomic<int> calls{0}, own{0};
  const std::thread::id self = std::this_thread::get_id();
  onThreads(5, [&] {
    ++calls;
    own += std::this_thread::get_id() == self ? 1 : 0;
  });
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(own, 1);
}

// Other engines say what they like: `bench engine --peers --json` was no JSON.
TEST(Measurements, KeepWhatALibraryPrintsOutOfTheRecords) {
  const Measurement talking{"talking", [](MeasureContext&) {
                              std::printf("Warning [the library] by printf\n");
                              std::cout << "Warning [the library] by cout" << std::endl;
                              const std::string raw = "Warning [the library] by write\n";
                              EXPECT_EQ(::write(STDOUT_FILENO, raw.data(), raw.size()),
                                        static_cast<ssize_t>(raw.size()));
                              return std::vector{atMost("value", 1, "-", 1)};
                            }};
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(runMeasurements({talking}, {.json = true}, "test"), kExitOk);
  const std::string error = ::testing::internal::GetCapturedStderr(), out = ::testing::internal::GetCapturedStdout();
  EXPECT_EQ(parseJson(out, "stdout").array().size(), 1u) << out;
  for (const char* by : {"by printf", "by cout", "by write"}) EXPECT_NE(error.find(by), std::string::npos) << error;
}

TEST(Watchdog, IsRefusedWhereThereAreNoMotors) {
  const TemporaryDirectory directory;
  for (const char* devices : {"sim", "mouse", "replay"}) {
    const Spawned ended = spawnPincer(
        {"run", "sphere-pickup", "--devices", devices, "--watchdog", "8", "--view", "--out", directory / "none"});
    EXPECT_EQ(ended.exit_code, 2) << devices;
    EXPECT_NE(ended.error.find("--watchdog 8 guards motors, and --devices " + std::string(devices) + " has none"),
              std::string::npos)
        << ended.error;
    EXPECT_FALSE(std::filesystem::exists(directory / "none"));
  }
  EXPECT_EQ(
      spawnPincer({"run", "sphere-pickup", "--devices", "usb", "--watchdog", "8", "--yes", "--out", directory / "none"})
          .exit_code,
      4);
}

}  // namespace
}  // namespace pincer::tasks
