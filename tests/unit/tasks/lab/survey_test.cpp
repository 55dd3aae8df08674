// Questions that people are asked beside the trials, the answers that will do, and where they are kept.
#include <gtest/gtest.h>

#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/finger/survey_form.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/session/bids_export.h"
#include "pincer/tasks/run/session/csv_export.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;

const std::vector<NamedCondition> kTwo = {{"force", "force only"}, {"cld+force", "display and force"}};

TEST(Survey, IsAskedOfEachTaskInEachCondition) {
  const SurveyPlan plan = manipulationSurvey();
  const auto questions = questionsOf(plan.survey, {"sphere-pickup", "cylinder-alignment"}, kTwo);
  EXPECT_EQ(questions.size(), 7u * 4 + 4);
  EXPECT_EQ(questionText(questions[0]), "I did well (sphere-pickup, force only)");
  EXPECT_EQ(answerHint(questions[0].item), "a number from 1 (not at all) to 7 (very much)");
  const auto preferred = std::find_if(questions.begin(), questions.end(),
                                      [](const SurveyQuestion& q) { return q.item.name == "preferred"; });
  ASSERT_NE(preferred, questions.end());
  EXPECT_EQ(answerHint(preferred->item), "1 force only or 2 display and force");
}

TEST(Survey, NobodyPrefersOneConditionOfOne) {
  for (const SurveyQuestion& q : questionsOf(manipulationSurvey().survey, {"sphere-pickup"}, {kTwo[0]}))
    EXPECT_NE(q.item.name, "preferred");
}

TEST(Survey, TakesWhatFitsAndSaysWhatWould) {
  SurveyItem scale, choice;
  choice.kind = AnswerKind::kChoice;
  choice.choices = {"right", "left"};
  EXPECT_EQ(answerOf(scale, " 7 ").value, 7);
  for (const char* bad : {"", "0", "8", "3.5", "7x", "nan", "inf", "very"})
    EXPECT_TRUE(contains(errorOf([&] { answerOf(scale, bad); }), "isn't an answer here. Give a number from 1 to 7."))
        << bad;
  EXPECT_EQ(answerOf(choice, "2").text, "left");
  EXPECT_EQ(answerOf(choice, "right").value, 1);
  EXPECT_TRUE(contains(errorOf([&] { answerOf(choice, "3"); }), "Give 1 right or 2 left."));
  scale.required = false;
  EXPECT_EQ(answerOf(scale, "").text, "");
  EXPECT_NE(answerOf(scale, "").value, answerOf(scale, "").value);
}

// Asked again until an answer will do; what was answered in an earlier session isn't asked again.
TEST(Survey, GoesOnWhereItWasLeft) {
  const SurveyForm form{questionsOf(oneFingerSurvey().survey, {"t"}, {{"a", ""}, {"b", ""}}), "after", 2};
  std::vector<SurveyRecord> kept;
  std::vector<std::string> typed = {"9", "5", "4"}, problems;
  const auto ask = [&](const AskedQuestion& q) -> std::optional<std::string> {
    problems.push_back(q.problem);
    if (typed.empty()) return {};
    const std::string answer = typed.front();
    typed.erase(typed.begin());
    return answer;
  };
  EXPECT_FALSE(fillForm(form, {}, ask, [&](const SurveyRecord& r) { kept.push_back(r); }));
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].answer_value, 5);
  EXPECT_EQ(kept[1].condition, "b");
  EXPECT_TRUE(contains(problems[1], "\"9\" isn't an answer here"));
  typed = std::vector<std::string>(20, "1");
  const std::size_t before = kept.size();
  EXPECT_TRUE(fillForm(form, kept, ask, [&](const SurveyRecord& r) { kept.push_back(r); }));
  EXPECT_EQ(kept.size(), form.questions.size());
  EXPECT_GT(kept.size(), before);
}

TEST(Survey, IsKeptInTheSessionAndExported) {
  const tests::TemporaryDirectory dir;
  SessionInfo info;
  info.task = "manipulation";
  SessionWriter writer = SessionWriter::create(dir / "s.db", info);
  writer.addSurvey({0, "after", "remarks", "", "", "Anything else?", "=cold\tfingers"});
  writer.addSurvey({0, "after", "did_well", "sphere-pickup", "force", "I did well", "6", 6});
  writer.close();
  const SessionReader reader(dir / "s.db");
  ASSERT_EQ(reader.survey().size(), 2u);
  EXPECT_EQ(reader.survey()[1].answer_value, 6);
  exportCsv(reader, dir / "csv");
  EXPECT_TRUE(contains(tests::readFile(dir / "csv/survey.csv"), "1,after,did_well,sphere-pickup,force,I did well,6,6"));
  exportBids(reader, dir / "bids");
  EXPECT_TRUE(contains(tests::readFile(dir / "bids/phenotype/survey.tsv"),
                       "sub-01\tafter\tremarks\tn/a\tn/a\tAnything else?\t'=cold\\tfingers\tn/a"));
  EXPECT_TRUE(contains(tests::readFile(dir / "bids/phenotype/survey.json"),
                       "\"item\": {\"Description\": \"name of the question"));
}

TEST(SurveyFile, TheGuidesStudyIsRead) {
  ArcStudy study = backlashStudy();
  readStudy(std::string(PINCER_SOURCE_DIR) + "/docs/examples/own_study.json", study);
  ASSERT_EQ(study.session.survey.size(), 1u);
  EXPECT_EQ(study.session.survey[0].per, AskedFor::kCondition);
  EXPECT_EQ(study.session.demographics[1].choices, (std::vector<std::string>{"no", "yes"}));
  const auto runs = ArcExperiment(study, {}, 50).runs();
  ASSERT_EQ(runs.size(), 8u * 2 * 2);
  // as listed
  for (std::size_t k = 0; k < runs.size(); ++k) EXPECT_EQ(runs[k].condition, k % 2 == 0 ? "low-curvature" : "edge");
  ArcStudy again = backlashStudy();
  parseStudy(studyJson(study), "again", again);
  EXPECT_EQ(again.session, study.session);
}

TEST(SurveyFile, NamesWhatIsWrongAndWhere) {
  const auto error = [](const std::string& session) {
    ArcStudy study = backlashStudy();
    return errorOf([&] { parseStudy("{\n\"session\": " + session + "\n}", "f.json", study); });
  };
  EXPECT_TRUE(contains(error(R"({"survey": [{"name": "a", "text": "A"}, {"name": "a", "text": "B"}]})"),
                       "session.survey[1]: the name a is there twice"));
  EXPECT_TRUE(contains(error(R"({"survey": [{"name": "a", "text": "A"}, {"name": "a", "text": "B"}]})"), "f.json:2: "));
  EXPECT_TRUE(contains(error(R"({"survey": [{"name": "a", "text": "A", "low": 3, "high": 3}]})"), "isn't below"));
  EXPECT_TRUE(contains(error(R"({"survey": [{"name": "a", "text": "A", "kind": "choice", "choices": ["x"]}]})"),
                       "a choice of one is none"));
  EXPECT_TRUE(contains(error(R"({"survay": []})"), "survey"));
  EXPECT_TRUE(contains(errorOf([] { parseStudyFile(R"({"session": {"blocks": 0}})", "f.json"); }), "blocks = 0"));
}

// Unchanged questions aren't written: sessions of before surveys keep their protocol to the byte.
TEST(SurveyFile, IsLeftOutWhereItIsAsGiven) {
  EXPECT_FALSE(contains(studyJson(backlashStudy()), "demographics"));
  EXPECT_FALSE(contains(studyFile(ManipulationStudy{}), "demographics"));
}

}  // namespace
}  // namespace pincer::tasks
