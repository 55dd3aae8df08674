// A seed has 64 bits, and all of them arrive: from options and study files,
// through sessions, to resuming and replaying.
#include <gtest/gtest.h>

#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;
using tests::runPincer;
using tests::TemporaryDirectory;

// 2^53 + 1, 2^63 + 1, 2^64 - 1
constexpr const char* kSeeds[] = {"9007199254740993", "9223372036854775809", "18446744073709551615"};

void expectSeed(const std::string& path, const std::string& seed) {
  const SessionInfo info = SessionReader(path).info();
  EXPECT_EQ(std::to_string(info.seed), seed);
  EXPECT_TRUE(contains(info.protocol_json, "\"seed\": " + seed)) << info.protocol_json.substr(0, 200);
}

TEST(Seed, SessionsOfLargeSeedsAreResumedAndReplayed) {
  for (const std::string seed : kSeeds) {
    const TemporaryDirectory dir;
    const std::string path = dir / "out/session.db";
    const std::vector<std::string> run = {"run", "sphere-pickup", "--no-report", "--out", dir / "out"};
    std::vector<std::string> begin = run, go_on = run;
    begin.insert(begin.end(), {"--repetitions", "2", "--friction", "0.9", "--condition", "force", "--seed", seed});
    go_on.emplace_back("--resume");
    runPincer(begin);
    expectSeed(path, seed);
    Database(path, Database::Mode::kWrite)
        .run("DELETE FROM trial WHERE trial = 1; UPDATE session SET state = 'running'");
    const tests::AppResult resumed = runPincer(go_on);
    EXPECT_NE(resumed.exit_code, kExitBadInput) << resumed.error;
    EXPECT_TRUE(SessionReader(path).complete());
    const tests::AppResult replayed = runPincer({"replay", path});
    EXPECT_EQ(replayed.exit_code, kExitOk) << replayed.error << replayed.out;
    EXPECT_TRUE(contains(replayed.out, "The same to the bit: 2 trials")) << replayed.out;
  }
}

TEST(Seed, StudiesOfLargeSeedsAreResumed) {
  const TemporaryDirectory dir;
  const std::string path = dir / "out/session.db";
  const std::string seed = kSeeds[2];
  std::ofstream(dir / "s.json") << R"({"repetitions": 1, "participants": 1, "seed": 18446744073709551615})";
  EXPECT_EQ(runPincer({"run", "repeated-localisation", "--study", dir / "s.json", "--no-report", "--out", dir / "out"})
                .exit_code,
            kExitOk);
  expectSeed(path, seed);
  Database(path, Database::Mode::kWrite)
      .run("DELETE FROM response WHERE trial > 1; UPDATE session SET state = 'running'");
  const tests::AppResult resumed =
      runPincer({"run", "repeated-localisation", "--resume", "--no-report", "--out", dir / "out"});
  EXPECT_EQ(resumed.exit_code, kExitOk) << resumed.error;
  EXPECT_TRUE(SessionReader(path).complete());
}

TEST(Seed, OutOfRangeIsAUsageErrorWithTheRange) {
  const std::vector<std::vector<std::string>> commands = {{"run", "sphere-pickup"},
                                                          {"run", "cylinder-alignment"},
                                                          {"run", "manipulation"},
                                                          {"run", "findings"},
                                                          {"run", "repeated-localisation"},
                                                          {"run", "shape-identification"},
                                                          {"run", "delay-discrimination"},
                                                          {"stress"},
                                                          {"sweep", "sphere-pickup", "--vary", "pickup.mass=0.1,0.2"}};
  for (std::vector<std::string> command : commands) {
    for (const char* seed :
         {"--seed=-1", "--seed=18446744073709551616", "--seed=1.5", "--seed=1e3", "--seed=seven", "--seed=0x10"}) {
      std::vector<std::string> with = command;
      with.emplace_back(seed);
      const tests::AppResult result = runPincer(with);
      EXPECT_EQ(result.exit_code, kExitUsage) << seed << ": " << result.error;
      EXPECT_TRUE(contains(result.error, "isn't a whole number in [0, 18446744073709551615]"))
          << seed << ": " << result.error;
    }
  }
  const tests::AppResult apart = runPincer({"run", "sphere-pickup", "--seed", "-1"});
  EXPECT_EQ(apart.exit_code, kExitUsage) << apart.error;
}

TEST(Seed, OfAStudyFileIsExactOrRefusedWithTheRange) {
  for (const std::string seed : kSeeds) {
    EXPECT_EQ(std::to_string(parseStudyFile("{\"seed\": " + seed + "}", "s.json").seed), seed);
    LocalisationStudy study;
    parseStudy("{\"seed\": " + seed + "}", "s.json", study);
    EXPECT_EQ(std::to_string(study.seed), seed);
  }
  for (const char* seed : {"-1", "1.5", "18446744073709551616", "1e300"}) {
    const std::string error = errorOf([&] { parseStudyFile(std::string("{\"seed\": ") + seed + "}", "s.json"); });
    EXPECT_TRUE(contains(error, "s.json:1: seed = ") &&
                contains(error, "isn't a whole number in [0, 18446744073709551615]"))
        << error;
  }
}

}  // namespace
}  // namespace pincer::tasks
