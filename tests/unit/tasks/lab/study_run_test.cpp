// Whole studies, small: the same seed gives the same answers, a killed or resumed one loses
// nothing, and the devices' tick is what it says.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/lab/sessions/study_session.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;
using tests::TemporaryDirectory;

struct StudyMemory final : StudySink {
  void sample(const SampleRecord& s) override {
    ++samples;
    EXPECT_GT(s.tick_us, 0) << "reports show what a tick took";
  }
  void event(const EventRecord&) override {}
  void response(const ResponseRecord& response) override { responses.push_back(response); }
  int samples = 0;
  std::vector<ResponseRecord> responses;
};

// One condition, two strokes, staircases that end after a few trials.
ArcStudy smallStudy(ArcStudy study) {
  study.participants = 1;
  study.strokes = 2;
  study.conditions.resize(1);
  study.conditions[0].staircase.reversals = 2;
  study.conditions[0].staircase.averaged = 1;
  study.conditions[0].staircase.most_trials = 6;
  return study;
}

std::vector<ResponseRecord> answersOf(Experiment& experiment, std::uint64_t seed,
                                      const std::vector<ResponseRecord>& earlier = {}) {
  StudyMemory memory;
  const std::atomic<bool> no{false};
  runStudy(experiment, seed, earlier, memory, no);
  return memory.responses;
}

void expectSameAnswers(const std::vector<ResponseRecord>& a, const std::vector<ResponseRecord>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].trial, b[k].trial);
    EXPECT_EQ(a[k].level, b[k].level);
    EXPECT_EQ(a[k].answer, b[k].answer);
    EXPECT_EQ(a[k].interval, b[k].interval);
    EXPECT_EQ(a[k].finger_speed, b[k].finger_speed);  // to the bit
  }
}

TEST(Study, TheSameSeedGivesTheSameAnswersAndResumingGoesOnWithThem) {
  ArcExperiment experiment(smallStudy(backlashStudy()), {}, 50);
  const auto whole = answersOf(experiment, 5);
  ASSERT_GE(whole.size(), 3u);
  for (const ResponseRecord& r : whole) EXPECT_EQ(r.outcome, "answered");
  const std::vector<ResponseRecord> begun(whole.begin(), whole.begin() + 2);
  expectSameAnswers(answersOf(experiment, 5, begun), {whole.begin() + 2, whole.end()});
}

TEST(Study, RefusesToResumeWhatItWouldNotHaveShown) {
  ArcExperiment experiment(smallStudy(backlashStudy()), {}, 50);
  ResponseRecord other;
  other.condition = "C1";
  EXPECT_TRUE(contains(errorOf([&] { answersOf(experiment, 5, {other}); }), "trial 1 of the session isn't the one"));
}

// A finger that strokes the circle touches it all the way, at about the speed
// of its hand, and no trial ends in a fault.
TEST(Study, StrokesStayOnTheSurface) {
  for (const ArcStudy& study : {smoothnessStudy(), backlashStudy(), delayStudy()}) {
    ArcStudy small = smallStudy(study);
    small.conditions[0].staircase.most_trials = 1;
    ArcExperiment experiment(small, {}, 50);
    const auto answers = answersOf(experiment, 1);
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].outcome, "answered") << study.task;
    EXPECT_GT(answers[0].contact_share, 0.5) << study.task;  // the rest is lowering, raising and reading
    EXPECT_GT(answers[0].finger_speed, 0.03) << study.task;
    EXPECT_LT(answers[0].finger_speed, 0.08) << study.task;
  }
}

TEST(Study, ABladeIsAsSharpAsItsAngleSays) {
  ArcStudy study = smallStudy(backlashStudy());
  study.conditions = {backlashStudy().conditions[1]};
  study.conditions[0].staircase.most_trials = 1;
  ArcExperiment experiment(study, {}, 50);
  const auto answers = answersOf(experiment, 1);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].outcome, "answered");
  EXPECT_GT(answers[0].contact_share, 0.2);  // strokes of 16 mm take less time than lowering and reading
}

TEST(Study, PlacesAreFoundAgain) {
  LocalisationStudy study;
  study.participants = 1;
  study.repetitions = 2;
  LocalisationExperiment experiment(study, {}, 50);
  const auto answers = answersOf(experiment, 3);
  ASSERT_EQ(answers.size(), 10u);
  double sum = 0;
  for (const ResponseRecord& r : answers) {
    EXPECT_EQ(r.outcome, "answered");
    sum += std::abs(r.answer_value - r.level);
  }
  EXPECT_LT(sum / 10, 3e-3);  // 1.3 mm expected, its SD over ten answers 0.31 mm: five of them
}

// Which sense feels what, as published: facets in both is C3, facets in force alone with the smooth
// tactor C4; the pilots come after the others.
TEST(Smoothness, ConditionsAreThePublishedOnes) {
  using Variant = contact::SurfaceVariant;
  const ArcStudy study = smoothnessStudy();
  const auto shown = [&](std::size_t k) {
    return std::make_pair(study.conditions[k].force, study.conditions[k].tactile);
  };
  const std::optional<Variant> parked;
  EXPECT_EQ(shown(0), std::make_pair(Variant::facet, parked));
  EXPECT_EQ(shown(1), std::make_pair(Variant::force, parked));
  EXPECT_EQ(shown(2), std::make_pair(Variant::facet, std::optional(Variant::facet)));
  EXPECT_EQ(shown(3), std::make_pair(Variant::facet, std::optional(Variant::smooth)));
  EXPECT_EQ(shown(4), std::make_pair(Variant::smooth, std::optional(Variant::smooth)));
  EXPECT_EQ(shown(5), std::make_pair(Variant::force, std::optional(Variant::facet)));
  const std::vector<StudyRun> runs = ArcExperiment(study, {}, 50).runs();
  ASSERT_EQ(runs.size(), 72u);
  for (std::size_t p = 0; p < 12; ++p) {
    EXPECT_EQ(runs[6 * p].condition, study.conditions[p % 4].name)
        << "a reduced Latin square: its first column in order";
    EXPECT_EQ(runs[6 * p + 4].condition, "P1");
    EXPECT_EQ(runs[6 * p + 5].condition, "P2");
  }
}

// Strokes go away from and towards the body; the tactor runs along the finger.
TEST(Smoothness, StrokesGoForeAndAft) {
  struct Places final : StudySink {
    void sample(const SampleRecord& s) override {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], s.fingers[0].p_WF[i]);
        high[i] = std::max(high[i], s.fingers[0].p_WF[i]);
      }
    }
    void event(const EventRecord&) override {}
    void response(const ResponseRecord&) override {}
    std::array<double, 3> low{1, 1, 1}, high{-1, -1, -1};
  };
  ArcStudy study = smallStudy(smoothnessStudy());
  study.conditions[0].staircase.most_trials = 1;
  ArcExperiment experiment(study, {}, 10);
  Places places;
  const std::atomic<bool> no{false};
  runStudy(experiment, 1, {}, places, no);
  EXPECT_LT(places.high[0] - places.low[0], 1e-3);
  // a hand's spring gives way by a few millimetres
  EXPECT_NEAR(places.high[1] - places.low[1], 2 * 0.12 * std::sin(0.4), 5e-3);
}

// A finger pressed into the circle by d gets k d outwards, and the tactor goes where the finger touches.
TEST(PlanarTick, ForceAndPlaceAreThoseOfTheCircle) {
  const auto circle =
      std::make_shared<const contact::Curve>(contact::arcPolygon(0.1, 1e-3, 1.0), contact::SurfaceVariant::smooth);
  PlanarTickModel model;
  model.gate.ramp_time = 0;
  model.gate.slew = 1e9;
  PlanarTickState state;
  devices::arm(state.gate);
  const double a = 0.2, depth = 1e-3;
  devices::ArmSample sample;
  sample.valid = true;
  sample.p_DF = (0.1 + model.finger_radius - depth) * Vec3(0, std::sin(a), std::cos(a));
  const PlanarStimulus stimulus{circle, circle, 8e-3};
  const std::int64_t allocations = tests::allocationCount();
  const PlanarTickOutput out = planarTick(model, stimulus, state, sample, 0, 1e-3);
  EXPECT_EQ(tests::allocationCount(), allocations);
  // the polygon's circle is 1.3e-8 m off: (1e-3)^2 / 8 of 0.1 m
  EXPECT_NEAR(out.normal_force, model.stiffness * depth, 1e-3);
  EXPECT_NEAR(out.f_D.y(), model.stiffness * depth * std::sin(a), 1e-3);
  EXPECT_NEAR(out.tactile.place_L.x(), -model.finger_radius * a, 1e-5);
  EXPECT_FALSE(out.tactile.parked);
  EXPECT_TRUE(planarTick(model, {circle, nullptr, 8e-3}, state, sample, 1e-3, 1e-3).tactile.parked);
}

TEST(StudyFile, ComesBackAsItWasWritten) {
  const TemporaryDirectory dir;
  ArcStudy written = smoothnessStudy();
  written.strokes = 6;
  written.conditions[2].staircase.small_step = 0.25;
  std::ofstream(dir / "study.json") << studyJson(written);
  ArcStudy read = smoothnessStudy();
  for (auto& condition : read.conditions) condition.staircase.small_step *= 2;
  ++read.strokes;
  readStudy(dir / "study.json", read);
  EXPECT_EQ(studyJson(read), studyJson(written));
}

TEST(StudyFile, NamesTheKeyThatIsWrong) {
  const TemporaryDirectory dir;
  std::ofstream(dir / "study.json") << "{\n  \"strokez\": 4\n}";
  ArcStudy study = backlashStudy();
  const std::string error = errorOf([&] { readStudy(dir / "study.json", study); });
  EXPECT_TRUE(contains(error, "study.json:2") && contains(error, "strokes")) << error;
}

TEST(StudySession, LosesNoFinishedTrialWhenItIsKilled) {
  const TemporaryDirectory dir;
  const std::string path = dir / "session.db", mark = dir / "mark";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {  // kills itself in the middle of the third trial
    LocalisationStudy study;
    LocalisationExperiment experiment(study, {}, 50);
    const std::atomic<bool> no{false};
    StudySession session;
    session.info.task = "repeated-localisation";
    session.path = path;
    int done = 0;
    runStudySession(experiment, session, no, [&](const StudyProgress&) {
      if (++done == 3) ::raise(SIGKILL);
    });
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  const SessionReader session(path);
  EXPECT_FALSE(session.complete());
  EXPECT_EQ(session.responses().size(), 3u);
}

LocalisationStudy studyToKill() {
  LocalisationStudy study;
  study.participants = 1;
  study.repetitions = 4;
  return study;
}

// Runs the study in a child, from its begin or from where the last one died, and kills that
// after `trials` more and `delay` microseconds.
void killStudyAfter(const StudySession& session, int trials, unsigned delay) {
  int reported[2];
  ASSERT_EQ(::pipe(reported), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    LocalisationExperiment experiment(studyToKill(), {}, 50);
    const std::atomic<bool> no{false};
    runStudySession(experiment, session, no, [&](const StudyProgress&) {
      if (::write(reported[1], "x", 1) != 1) ::_exit(1);
    });
    ::_exit(0);
  }
  ::close(reported[1]);
  char x = 0;
  for (int k = 0; k < trials; ++k) ASSERT_EQ(::read(reported[0], &x, 1), 1);
  ::usleep(delay);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(reported[0]);
}

// Killed again and again, each time somewhere else in a trial (where, the machine decides), and resumed: the answers
// and samples are those of the study that nobody touched.
TEST(StudySession, GoesOnAfterEveryKillToTheSameEnd) {
  const TemporaryDirectory dir;
  StudySession session;
  session.info.task = "repeated-localisation";
  session.path = dir / "killed.db";
  std::size_t answers = 0;
  for (const unsigned delay : {0u, 1500u, 4000u, 9000u}) {
    killStudyAfter(session, static_cast<int>(answers) + 2, delay);
    session.resume = true;
    const SessionReader killed(session.path);
    EXPECT_FALSE(killed.complete());
    EXPECT_GE(killed.responses().size(), answers + 2);
    answers = killed.responses().size();
  }
  const std::atomic<bool> no{false};
  LocalisationExperiment experiment(studyToKill(), {}, 50), again(studyToKill(), {}, 50);
  runStudySession(experiment, session, no, {});
  StudySession whole = session;
  whole.path = dir / "whole.db";
  whole.resume = false;
  runStudySession(again, whole, no, {});
  const SessionReader a(session.path), b(whole.path);
  EXPECT_TRUE(a.complete());
  expectSameAnswers(a.responses(), b.responses());
  int samples_a = 0, samples_b = 0;
  a.forEachSample({}, [&](const SampleRecord&) { ++samples_a; });
  b.forEachSample({}, [&](const SampleRecord&) { ++samples_b; });
  EXPECT_EQ(samples_a, samples_b);
  EXPECT_GT(samples_b, 0);
}

TEST(StudyApp, ResumesWithTheSessionsOwnParameters) {
  const TemporaryDirectory dir;
  std::ofstream(dir / "small.json") << R"({"repetitions": 1})";
  const std::vector<std::string> begin = {"run",
                                          "repeated-localisation",
                                          "--participants",
                                          "1",
                                          "--study",
                                          dir / "small.json",
                                          "--seed",
                                          "4",
                                          "--out",
                                          dir / "out",
                                          "--no-report"};
  ASSERT_EQ(tests::runPincer(begin).exit_code, 0);
  const std::vector<std::string> resume = {"run",        "repeated-localisation", "--resume", "--out", dir / "out",
                                           "--no-report"};
  const auto finished = tests::runPincer(resume);
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_TRUE(contains(finished.error, "the session is complete")) << finished.error;
  Database(dir / "out/session.db", Database::Mode::kWrite)
      .run("DELETE FROM response WHERE trial >= 2; UPDATE session SET state = 'running'");
  const auto resumed = tests::runPincer(resume);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.error;
  EXPECT_EQ(SessionReader(dir / "out/session.db").responses().size(), 5u);
  const auto other = tests::runPincer({"run", "delay-discrimination", "--resume", "--out", dir / "out"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_TRUE(contains(other.error, "a session of repeated-localisation")) << other.error;
}

TEST(StudyApp, RunsReportsAndPrintsItsStudy) {
  const TemporaryDirectory dir;
  std::ofstream(dir / "small.json")
      << R"({"strokes": 2, "conditions": [{"name": "whole", "staircase": {"most_trials": 2}}]})";
  const auto printed =
      tests::runPincer({"run", "delay-discrimination", "--study", dir / "small.json", "--print-study"});
  EXPECT_EQ(printed.exit_code, 0) << printed.error;
  EXPECT_TRUE(contains(printed.out, "\"strokes\": 2")) << printed.out;
  const auto run = tests::runPincer({"run", "delay-discrimination", "--participants", "1", "--study",
                                     dir / "small.json", "--out", dir / "out", "--no-report", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_TRUE(contains(run.out, "\"task\": \"delay-discrimination\"")) << run.out;
  const auto bad = tests::runPincer({"run", "delay-discrimination", "--participants", "0"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_TRUE(contains(bad.error, "participants = 0 is out of range [1, 10000]")) << bad.error;
}

}  // namespace
}  // namespace pincer::tasks
