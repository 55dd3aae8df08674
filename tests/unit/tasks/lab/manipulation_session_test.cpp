// Study files, resuming, replaying and exporting a manipulation study.
#include "pincer/tasks/lab/sessions/manipulation_session.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/sessions/replay.h"
#include "pincer/tasks/run/session/bids_export.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tasks/run/session/session_lock.h"
#include "pincer/tests/support/pickup_session.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

const std::atomic<bool> kGoOn{false};

ManipulationSessionOptions quickSession(int repetitions) { return tests::pickupSession(repetitions, 2); }

TEST(ManipulationFile, ReadsWhatItWrites) {
  ManipulationStudy study;
  study.seed = 77;
  study.people.strategy = Strategy::kSimple;
  study.people.limits.tactor_sd = 1.25e-3;
  study.alignment.pivot = false;
  study.pickup.frictions = {0.4, 0.8};
  study.conditions = {publishedHandConditions()[1]};
  const std::string text = studyFile(study);
  EXPECT_EQ(studyFile(parseStudyFile(text, "study.json")), text);
  EXPECT_EQ(hashOf(parseStudyFile(text, "study.json").people), hashOf(study.people));
  EXPECT_NE(hashOf(study.people), hashOf(ParticipantModel{}));
}

TEST(ManipulationFile, HasThePublishedDesignWhereItIsSilent) {
  EXPECT_EQ(studyFile(parseStudyFile(R"({"version": 1})", "study.json")), studyFile({}));
}

TEST(ManipulationFile, NamesWhatIsWrong) {
  const auto said = [](const char* text) {
    try {
      parseStudyFile(text, "study.json");
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(said(R"({"version": 1, "participant": 3})").find("participants"), std::string::npos);  // did you mean
  EXPECT_NE(said("{\"version\": 1,\n\"sphere_pickup\": {\"mass\": \"heavy\"}}").find("study.json:2"),
            std::string::npos);
  EXPECT_NE(said(R"({"version": 1, "people": {"force_floor": -1}})").find("force_floor = -1"), std::string::npos);
  EXPECT_NE(said(R"({"version": 2})").find("version"), std::string::npos);
}

// A session that goes on after an interrupt is the session that was never interrupted.
TEST(ManipulationSession, GoesOnToTheSameEnd) {
  const tests::TemporaryDirectory directory;
  const auto options = quickSession(3);
  std::atomic<bool> interrupted{false};
  runManipulationSession(options, directory / "part.db", interrupted,
                         [&](const TrialProgress& at) { interrupted = at.done == 1; });
  EXPECT_EQ(SessionReader(directory / "part.db").trials().size(), 1u);
  EXPECT_EQ(resumeManipulationSession({}, directory / "part.db", kGoOn, {}).trials, 3u);
  runManipulationSession(options, directory / "whole.db", kGoOn, {});
  const SessionReader part(directory / "part.db"), whole(directory / "whole.db");
  EXPECT_TRUE(part.complete());
  ASSERT_EQ(part.trials().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(part.trials()[i].trial, whole.trials()[i].trial);
    EXPECT_EQ(part.trials()[i].duration, whole.trials()[i].duration);
  }
  EXPECT_EQ(part.events().size(), whole.events().size());
  EXPECT_THROW(resumeManipulationSession({}, directory / "part.db", kGoOn, {}), InputError);
}

// Killed at moments that the clock chooses; each time what had been reported as
// finished is there, and the session goes on.
TEST(ManipulationSession, LosesNoFinishedTrialWhenKilled) {
  const tests::TemporaryDirectory directory;
  const std::string path = directory / "killed.db";
  int reported[2];
  ASSERT_EQ(pipe(reported), 0);
  const pid_t child = fork();
  if (child == 0) {
    try {
      runManipulationSession(quickSession(200), path, kGoOn, [&](const TrialProgress& at) {
        const char done = static_cast<char>(at.done);
        if (write(reported[1], &done, 1) != 1) _exit(1);
      });
    } catch (...) {
    }
    _exit(0);
  }
  close(reported[1]);
  char done = 0;
  for (int i = 0; i < 4; ++i) ASSERT_EQ(read(reported[0], &done, 1), 1);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  while (read(reported[0], &done, 1) == 1) {
  }
  close(reported[0]);
  const SessionReader session(path);
  EXPECT_FALSE(session.complete());
  EXPECT_GE(session.trials().size(), static_cast<std::size_t>(done));
  EXPECT_GE(done, 3);
}

TEST(Replay, IsTheSameToTheBitAndNamesTheFirstDifference) {
  const tests::TemporaryDirectory directory;
  auto options = quickSession(2);
  options.sample_rate = 1000;
  runManipulationSession(options, directory / "s.db", kGoOn, {});
  const ReplayResult same = replaySession(SessionReader(directory / "s.db"), {}, kGoOn);
  EXPECT_FALSE(same.first) << same.first->what;
  EXPECT_EQ(same.trials, 2);
  EXPECT_GT(same.samples, 2000);
  Database(directory / "s.db", Database::Mode::kWrite)
      .run("UPDATE sample SET f1_gap_m = f1_gap_m + 1e-15 WHERE trial = 1 AND tick >= 1234");
  const ReplayResult changed = replaySession(SessionReader(directory / "s.db"), {}, kGoOn);
  ASSERT_TRUE(changed.first);
  EXPECT_EQ(changed.first->trial, 1);
  EXPECT_EQ(changed.first->tick, 1234);
  EXPECT_NE(changed.first->what.find("f1_gap_m"), std::string::npos) << changed.first->what;
}

TEST(SessionStore, ResumingARunningSessionEndsWithExitCode3) {
  const tests::TemporaryDirectory dir;
  std::filesystem::create_directory(dir / "out");
  tests::runPincer({"run", "sphere-pickup", "--repetitions", "1", "--friction", "0.9", "--condition", "force",
                    "--no-report", "--out", dir / "out"});
  Database(dir / "out/session.db", Database::Mode::kWrite).run("UPDATE session SET state = 'running'");
  const SessionLock held(dir / "out/session.db");
  const tests::AppResult result = tests::runPincer({"run", "sphere-pickup", "--resume", "--out", dir / "out"});
  EXPECT_EQ(result.exit_code, kExitBadInput);
  EXPECT_TRUE(tests::contains(result.error, "is being written by process " + std::to_string(::getpid())))
      << result.error;
}

TEST(Replay, OfAnotherVersionIsRefusedByName) {
  const tests::TemporaryDirectory directory;
  const std::string path = directory / "s.db";
  runManipulationSession(quickSession(1), path, kGoOn, {});
  EXPECT_EQ(tests::runPincer({"replay", path}).exit_code, kExitOk);
  Database(path, Database::Mode::kWrite).run("UPDATE session SET sources = '000000000000', commit_id = 'deadbeef0000'");
  const tests::AppResult refused = tests::runPincer({"replay", path});
  EXPECT_EQ(refused.exit_code, kExitBadInput);
  EXPECT_TRUE(tests::contains(
      refused.error,
      "it was made by pincer 0.1.0 (commit deadbeef0000, sources 000000000000), and this is pincer 0.1.0 ("))
      << refused.error;
  EXPECT_TRUE(tests::contains(refused.error, "--other-version")) << refused.error;
  const tests::AppResult told = tests::runPincer({"replay", path, "--other-version"});
  EXPECT_EQ(told.exit_code, kExitOk) << told.error;
  EXPECT_TRUE(tests::contains(told.error, "Their bits may differ")) << told.error;
  Database(path, Database::Mode::kWrite).run("UPDATE session SET version = '0.0.9', sources = '', commit_id = ''");
  EXPECT_TRUE(tests::contains(tests::runPincer({"replay", path}).error,
                              "made by pincer 0.0.9 (of before sessions kept their commit)"));
}

TEST(Replay, SaysWhatElseDiffersWhereBitsDo) {
  const tests::TemporaryDirectory directory;
  const std::string path = directory / "s.db";
  runManipulationSession(quickSession(1), path, kGoOn, {});
  Database(path, Database::Mode::kWrite)
      .run("UPDATE sample SET f0_gap_m = 1; UPDATE session SET processor = 'abacus', c_library = 'glibc 1.0'");
  const tests::AppResult result = tests::runPincer({"replay", path});
  EXPECT_EQ(result.exit_code, kExitCheckFailed);
  EXPECT_TRUE(tests::contains(result.error, "Not the same: processor: abacus then, ")) << result.error;
  EXPECT_TRUE(tests::contains(result.error, "Not the same: C library: glibc 1.0 then, glibc ")) << result.error;
  EXPECT_FALSE(tests::contains(result.error, "compiler")) << result.error;
}

TEST(ManipulationSession, NamesBothProgramsWhenAnotherGoesOn) {
  const tests::TemporaryDirectory directory;
  const std::string path = directory / "s.db";
  runManipulationSession(quickSession(1), path, kGoOn, {});
  Database(path, Database::Mode::kWrite)
      .run("DELETE FROM trial; UPDATE session SET state = 'running', sources = 'old', commit_id = 'older'");
  resumeManipulationSession({}, path, kGoOn, {});
  const SessionInfo info = SessionReader(path).info();
  EXPECT_TRUE(info.sources.starts_with("old; then ")) << info.sources;
  EXPECT_EQ(info.version, "0.1.0");
  EXPECT_EQ(tests::runPincer({"replay", path}).exit_code, kExitBadInput);
}

TEST(Version, TellsCommitCompilerLibraryAndProcessor) {
  const tests::AppResult result = tests::runPincer({"--version"});
  EXPECT_EQ(result.exit_code, kExitOk);
  EXPECT_TRUE(result.out.starts_with("pincer 0.1.0 (commit ") ||
              result.out.starts_with("pincer 0.1.0 (made without its repository, sources "))
      << result.out;
  for (const char* part : {"sources ", "glibc ", "-ffp-contract=off"})
    EXPECT_TRUE(tests::contains(result.out, part)) << part;
}

TEST(BidsExport, LaysOutOneTableWithASidecarPerPersonAndTask) {
  const tests::TemporaryDirectory directory;
  runManipulationSession(quickSession(1), directory / "s.db", kGoOn, {});
  const auto paths = exportBids(SessionReader(directory / "s.db"), directory / "bids");
  EXPECT_EQ(paths.size(), 6u);
  EXPECT_TRUE(std::filesystem::exists(directory / "bids/sub-01/beh/sub-01_task-spherepickup_beh.tsv"));
  EXPECT_TRUE(std::filesystem::exists(directory / "bids/sub-01/beh/sub-01_task-spherepickup_beh.json"));
  EXPECT_TRUE(std::filesystem::exists(directory / "bids/dataset_description.json"));
  EXPECT_TRUE(std::filesystem::exists(directory / "bids/README.md"));
}

// The studies with one finger gave a data set without participants.
TEST(BidsExport, HoldsTheAnswersOfAStudyWithOneFinger) {
  const tests::TemporaryDirectory directory;
  SessionInfo info;
  info.task = "shape-identification";
  SessionWriter writer = SessionWriter::create(directory / "s.db", info);
  for (const int person : {0, 1}) {
    ResponseRecord r;
    r.trial = r.participant = person;
    r.condition = person ? "shaded" : "facets";
    r.answer = "cone";
    writer.finishResponse(r);
  }
  writer.close();
  exportBids(SessionReader(directory / "s.db"), directory / "bids");
  const std::string table = tests::readFile(directory / "bids/sub-02/beh/sub-02_task-shapeidentification_beh.tsv");
  EXPECT_NE(table.find("\tcone\t"), std::string::npos) << table;
  EXPECT_EQ(tests::readFile(directory / "bids/participants.tsv"),
            "participant_id\tfirst_condition\nsub-01\tfacets\nsub-02\tshaded\n");
}

}  // namespace
}  // namespace pincer::tasks
