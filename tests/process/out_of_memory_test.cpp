// Memory ends anywhere (tests/campaign/fail_malloc.cpp): the program says so and ends with an exit code;
// a session is marked, its trials are kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/spawned.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::Spawned;
using tests::SpawnOptions;
using tests::TemporaryDirectory;

constexpr int kPoints = 20;  // of each command and kind, over the whole range of its allocations

SpawnOptions withFaults(const std::string& variable) {
  return {.environment = {"LD_PRELOAD=" PINCER_BINARY_DIR "/libfail_malloc.so", variable}};
}

long allocationsOf(const std::vector<std::string>& command) {
  const TemporaryDirectory directory;
  const Spawned whole = tests::spawnPincer(command, withFaults("PINCER_COUNT_MALLOC=" + (directory / "count")));
  EXPECT_EQ(whole.exit_code, 0) << whole.error;
  return std::atol(tests::readFile(directory / "count").c_str());
}

// Early allocations are different ones, later ones repeat: the points lie the denser the earlier.
std::vector<long> pointsUpTo(long last, int points) {
  std::vector<long> chosen;
  for (int k = 1; k <= points; ++k) {
    const double share = static_cast<double>(k) / points;
    chosen.push_back(std::max(1L, static_cast<long>(share * share * static_cast<double>(last))));
  }
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

std::vector<long> allPointsUpTo(long last) {
  std::vector<long> all;
  for (long k = 1; k <= last; ++k) all.push_back(k);
  return all;
}

void expectASentence(const Spawned& ended, const std::string& where) {
  EXPECT_EQ(ended.signal, 0) << where << ": " << ended.error;
  EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 3)
      << where << ": exit code " << ended.exit_code << ": " << ended.error;
  if (ended.exit_code == 3) {
    EXPECT_NE(ended.error.find("pincer: "), std::string::npos) << where << ": \"" << ended.error << '"';
  }
}

// A session that is there has ended in words, and holds the trials that it says.
void expectNoLoss(const std::string& path, const Spawned& ended, const std::string& where) {
  if (!std::filesystem::exists(path)) {
    EXPECT_EQ(ended.exit_code, 3) << where;
    return;
  }
  const SessionReader session(path);
  EXPECT_NE(session.state(), "running") << where << ": " << ended.error;
  if (session.complete()) {
    EXPECT_EQ(session.trials().size(), 1u) << where;
  }
  if (ended.exit_code == 0) {
    EXPECT_TRUE(session.complete()) << where;
  }
}

// "": one allocation fails; "+": it and all that follow
class OutOfMemory : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (PINCER_SANITIZED) GTEST_SKIP() << "the sanitizer owns the allocator";
  }
  void endsInWords(const std::vector<std::string>& command, const std::vector<long>& points) {
    for (const long point : points) {
      const std::string variable = "PINCER_FAIL_MALLOC=" + std::to_string(point) + GetParam();
      expectASentence(tests::spawnPincer(command, withFaults(variable)), variable);
    }
  }
  void losesNoSession(const std::vector<long>& points) {
    for (const long point : points) {
      const TemporaryDirectory directory;
      const std::string variable = "PINCER_FAIL_MALLOC=" + std::to_string(point) + GetParam();
      const Spawned ended = tests::spawnPincer(session(directory.path()), withFaults(variable));
      expectASentence(ended, variable);
      expectNoLoss(directory / "session.db", ended, variable);
    }
  }
  static std::vector<std::string> session(const std::string& directory) {
    return {"run",       "cylinder-alignment", "--repetitions", "1",      "--condition",
            "cld+force", "--no-report",        "--out",         directory};
  }
  static long allocationsOfASession() {
    const TemporaryDirectory directory;
    return allocationsOf(session(directory.path()));
  }
};

const std::string kScene = PINCER_SOURCE_DIR "/tasks/scenes/s4_pinch.json";

TEST_P(OutOfMemory, EndsASceneInWords) {
  const std::vector<std::string> command{"sim", kScene, "--duration", "0.1"};
  endsInWords(command, pointsUpTo(allocationsOf(command), kPoints));
}

TEST_P(OutOfMemory, EndsAMeshInWords) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "tetra.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::vector<std::string> command{"mesh", "info", directory / "tetra.obj", "--units", "cm"};
  endsInWords(command, pointsUpTo(allocationsOf(command), kPoints));
}

TEST_P(OutOfMemory, LosesNoSession) { losesNoSession(pointsUpTo(allocationsOfASession(), kPoints)); }

TEST_P(OutOfMemory, EndsAnExportInWords) {
  const TemporaryDirectory directory;
  ASSERT_EQ(tests::spawnPincer(session(directory.path())).exit_code, 0);
  const std::vector<std::string> command{"export", directory / "session.db", "--every", "100",
                                         "--out",  directory / "csv"};
  endsInWords(command, pointsUpTo(allocationsOf(command), kPoints));
}

TEST_P(OutOfMemory, EndsAReportInWords) {
  const TemporaryDirectory directory;
  ASSERT_EQ(tests::spawnPincer(session(directory.path())).exit_code, 0);
  const std::vector<std::string> command{"report", directory / "session.db"};
  endsInWords(command, pointsUpTo(allocationsOf(command), kPoints / 5));  // gnuplot takes seconds
}

// Hours; after a change of how the program ends: process
// --gtest_also_run_disabled_tests --gtest_filter='*AtEveryAllocation*'
TEST_P(OutOfMemory, DISABLED_LosesNoSessionAtEveryAllocation) {
  losesNoSession(allPointsUpTo(allocationsOfASession()));
}
TEST_P(OutOfMemory, DISABLED_EndsASceneInWordsAtEveryAllocation) {
  const std::vector<std::string> command{"sim", kScene, "--duration", "0.1"};
  endsInWords(command, allPointsUpTo(allocationsOf(command)));
}

INSTANTIATE_TEST_SUITE_P(OnceAndFromThenOn, OutOfMemory, testing::Values("", "+"),
                         [](const auto& which) { return *which.param ? "FromThenOn" : "Once"; });

}  // namespace
}  // namespace pincer::tasks
