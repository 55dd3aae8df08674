// People in the experiments with one finger: keys answer, what they did is kept, and it comes again to the bit.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "pincer/devices/window/input.h"
#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/experiments/shape_study.h"
#include "pincer/tasks/lab/finger/mouse_finger.h"
#include "pincer/tasks/lab/sessions/replay.h"
#include "pincer/tasks/lab/sessions/study_experiments.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/lab/sessions/study_session.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::TemporaryDirectory;

// Somebody at a window: lowers the finger at each tone, strokes or looks for the ring,
// raises it, and presses keys. In virtual time.
struct MousePerson {
  std::atomic<bool> leaves{false};
  std::int64_t leaves_at_tick = -1;  // of the last trial that began; -1: stays
  char answer = '2';
  std::vector<StudyPage> pages;
  int trials = 0, trained = 0;
  FingerTold last_told;
  AnswerBox keys;

  FingerHost host() {
    FingerHost host;
    host.person = 0;
    host.finger = [this](const FingerPlace& place) {
      auto made = std::make_unique<MouseFinger>(place, keys);
      finger = made.get();
      radius = place.start_W.norm() - 0.01;
      return made;
    };
    host.show = [this](const StudyPage& page) {
      pages.push_back(page);
      return true;
    };
    host.serve = [this](FingerTrial& trial, const TrialPlace&) { return serve(trial); };
    return host;
  }

 private:
  ServoReport serve(FingerTrial& trial) {
    ++(trial.asked().training ? trained : trials);
    ServoReport report;
    stage.clear();
    for (std::int64_t tick = 0;; ++tick) {
      ++report.ticks;
      if (tick == leaves_at_tick && !trial.asked().training) report.interrupted = true;
      if (report.interrupted || !trial.tick(1e-3 * static_cast<double>(tick))) return report;
      act(trial, trial.told());
      EXPECT_LT(tick, 60'000) << trial.told().instruction;
      if (tick >= 60'000) report.interrupted = true;
    }
  }

  void act(FingerTrial& trial, const FingerTold& told) {
    last_told = told;
    ticks = stage == told.stage ? ticks + 1 : 0;
    stage = told.stage;
    if (stage == "answer" && ticks == 100) keys.press(answer);
    if (stage.rfind("you chose", 0) == 0 && ticks == 100) keys.press(devices::kKeyEnter);
    const bool feels = stage == "first" || stage == "second" || stage == "feel";
    if (!feels) return;
    const TrialQuestion question = trial.asked().question;
    question == TrialQuestion::kWhich ? stroke() : question == TrialQuestion::kMatch ? match(trial, told) : explore();
  }
  // Down, 20 mm away and back, up, Enter. A hand's spring gives way to the surface.
  void stroke() {
    if (ticks < 200) finger->hand().move({0, 0, -7e-5});
    if (ticks >= 300 && ticks < 800) finger->hand().move({0, 4e-5, 0});
    if (ticks >= 900 && ticks < 1400) finger->hand().move({0, -4e-5, 0});
    if (ticks == 1450) keys.press(devices::kKeyEnter);  // too early: nothing comes of it
    if (ticks >= 1500 && ticks < 1700) finger->hand().move({0, 0, 7e-5});
    if (ticks == 2200) keys.press(devices::kKeyEnter);
  }
  // Down, along the finger until the tactor is where it should be, Enter; then up.
  void match(const FingerTrial& trial, const FingerTold& told) {
    const double off = *trial.asked().target - finger->tactorPlace();
    const double push = finger->hand().arm(0).force_D().norm();
    const bool keeps = told.instruction == trial.asked().texts.feel;
    if (keeps) finger->hand().move({0, ticks >= 500 ? -0.02 * off : 0, push < 0.3 ? -3e-5 : push > 1 ? 3e-5 : 0});
    if (ticks == 6000) keys.press(devices::kKeyEnter);
    if (!keeps) finger->hand().move({0, 0, 4e-5});
  }
  // Down until something is felt, and a guess.
  void explore() {
    if (ticks < 1000) finger->hand().move({0, 0, -4.5e-5});
    if (ticks == 1500) keys.press(answer);
  }

  MouseFinger* finger = nullptr;
  double radius = 0;
  std::string stage;
  std::int64_t ticks = 0;
};

template <class Study>
StudySession sessionOf(const std::string& task, const Study& study, const std::string& path, MousePerson& person) {
  StudySession session;
  session.path = path;
  session.host = person.host();
  session.info = studySessionInfo(task, study.seed, studyJson(study), personJson(0), {}, 50, "mouse");
  return session;
}

ReplayResult replayed(const std::string& path) {
  return replaySession(SessionReader(path), {}, std::atomic<bool>{false});
}

std::string differenceIn(const ReplayResult& result) { return result.first ? result.first->what : ""; }

ArcStudy briefBacklash() {
  ArcStudy study = backlashStudy();
  study.participants = 1;
  study.conditions.resize(1);
  study.conditions[0].staircase.reversals = 2;
  study.conditions[0].staircase.averaged = 1;
  study.conditions[0].staircase.most_trials = 2;
  return study;
}

TEST(FingerPerson, AnswersByKeysAndComesAgainToTheBit) {
  const TemporaryDirectory dir;
  ArcExperiment experiment(briefBacklash(), {}, 20);
  MousePerson person;
  const StudySession session = sessionOf("backlash-discrimination", briefBacklash(), dir / "session.db", person);
  const std::atomic<bool> no{false};
  const StudyOutcome outcome = runStudySession(experiment, session, no, {});
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_EQ(person.trained, 1);
  ASSERT_GE(person.pages.size(), 4u);  // instruction, what was right in training, the trials begin, the end
  const SessionReader reader(session.path);
  ASSERT_EQ(reader.responses().size(), 2u);
  for (const ResponseRecord& r : reader.responses()) {
    EXPECT_EQ(r.outcome, "answered");
    EXPECT_EQ(r.answer, "2");
    EXPECT_EQ(r.correct, r.interval == 2 ? 1 : 0);
    EXPECT_GT(r.contact_share, 0.3);
  }
  const std::vector<EventRecord> events = reader.events(0);
  EXPECT_EQ(std::count_if(events.begin(), events.end(),
                          [](const EventRecord& e) { return e.kind == "key" && e.detail == "Enter"; }),
            5);
  const ReplayResult result = replayed(session.path);
  EXPECT_EQ(differenceIn(result), "");
  EXPECT_EQ(result.trials, 2);
  EXPECT_GT(result.samples, 100);
  EXPECT_GT(result.inputs, 10'000);
}

TEST(FingerPerson, SeesNothingButThePadInACountedTrial) {
  ArcExperiment experiment(briefBacklash(), {}, 20);
  MousePerson person;
  const TemporaryDirectory dir;
  const std::atomic<bool> no{false};
  runStudySession(experiment, sessionOf("backlash-discrimination", briefBacklash(), dir / "session.db", person), no,
                  {});
  EXPECT_TRUE(person.last_told.hidden);
  EXPECT_TRUE(person.last_told.shows_pad);
}

TEST(FingerPerson, APlaceIsKeptAndFoundAgain) {
  const TemporaryDirectory dir;
  LocalisationStudy study;
  study.participants = 1;
  study.places = 2;
  study.repetitions = 1;
  LocalisationExperiment experiment(study, {}, 20);
  MousePerson person;
  const StudySession session = sessionOf("repeated-localisation", study, dir / "session.db", person);
  const std::atomic<bool> no{false};
  runStudySession(experiment, session, no, {});
  const std::vector<ResponseRecord> responses = SessionReader(session.path).responses();
  ASSERT_EQ(responses.size(), 2u);
  // the ring's 0.25 mm, twice
  for (const ResponseRecord& r : responses) EXPECT_LT(std::abs(r.answer_value - r.level), 0.5e-3);
  EXPECT_EQ(differenceIn(replayed(session.path)), "");
}

TEST(FingerPerson, NamesASolidByOneKey) {
  const TemporaryDirectory dir;
  ShapeStudy study;
  study.participants = study.sessions = 1;
  study.sizes.facet_sides = 24;  // 180 take long to build
  study.conditions = {study.conditions[2]};
  ShapeExperiment experiment(study, {}, 20);
  MousePerson person;
  person.answer = '4';
  const StudySession session = sessionOf("shape-identification", study, dir / "session.db", person);
  const std::atomic<bool> no{false};
  runStudySession(experiment, session, no, {});
  const std::vector<ResponseRecord> responses = SessionReader(session.path).responses();
  ASSERT_EQ(responses.size(), 14u);  // two runs without the display
  for (const ResponseRecord& r : responses) EXPECT_EQ(r.answer, "sphere");
  EXPECT_EQ(differenceIn(replayed(session.path)), "");
}

TEST(FingerPerson, WhoLeavesInATrialGoesOnLaterAndTheTrialThatWasLeftComesAgainToo) {
  const TemporaryDirectory dir;
  MousePerson person;
  StudySession session = sessionOf("backlash-discrimination", briefBacklash(), dir / "session.db", person);
  const std::atomic<bool> no{false};
  person.leaves_at_tick = 3000;
  {
    ArcExperiment experiment(briefBacklash(), {}, 20);
    EXPECT_TRUE(runStudySession(experiment, session, no, {}).interrupted);
  }
  const ReplayResult result = replayed(session.path);
  EXPECT_EQ(differenceIn(result), "");
  EXPECT_EQ(result.trials, 0);
  EXPECT_EQ(result.cut_short, 1);
  EXPECT_EQ(result.inputs, 3000);
  person.leaves_at_tick = -1;
  session.resume = true;
  ArcExperiment experiment(briefBacklash(), {}, 20);
  EXPECT_FALSE(runStudySession(experiment, session, no, {}).interrupted);
  EXPECT_EQ(replayed(session.path).trials, 2);
}

TEST(FingerPerson, AnAnswerThatWasChangedAfterwardsIsFound) {
  const TemporaryDirectory dir;
  MousePerson person;
  const StudySession session = sessionOf("backlash-discrimination", briefBacklash(), dir / "session.db", person);
  const std::atomic<bool> no{false};
  ArcExperiment experiment(briefBacklash(), {}, 20);
  runStudySession(experiment, session, no, {});
  Database(session.path, Database::Mode::kWrite).run("UPDATE response SET answer = '1' WHERE trial = 1");
  const ReplayResult result = replayed(session.path);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->trial, 1);
  EXPECT_EQ(result.first->what, "answer was 1, is 2");
}

// Simulated participants, whose devices and decisions follow from the seed.
TEST(StudyReplay, SimulatedAnswersComeAgainToTheBit) {
  const TemporaryDirectory dir;
  ArcExperiment experiment(briefBacklash(), {}, 10);
  StudySession session;
  session.path = dir / "session.db";
  session.info = studySessionInfo("backlash-discrimination", 1, studyJson(briefBacklash()),
                                  participantsJson(briefBacklash()), {}, 100);
  const std::atomic<bool> no{false};
  runStudySession(experiment, session, no, {});
  const ReplayResult result = replayed(session.path);
  EXPECT_EQ(differenceIn(result), "");
  EXPECT_EQ(result.trials, 2);
  EXPECT_GT(result.samples, 500);
}

}  // namespace
}  // namespace pincer::tasks
