#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/lab/report/study_summary.h"

namespace pincer::tasks {
namespace {

SurveyRecord rated(std::int64_t participant, const std::string& condition, double value) {
  SurveyRecord answer;
  answer.participant = participant;
  answer.moment = "after";
  answer.item = "did_well";
  answer.condition = condition;
  answer.question = "I did well";
  answer.answer = std::to_string(static_cast<int>(value));
  answer.answer_value = value;
  return answer;
}

TEST(ReportSurvey, HasARowPerQuestionAndConditionWithMeanRangeAndAnswers) {
  SurveyRecord words;
  words.moment = "after";
  words.item = "else";
  words.question = "Anything else?";
  words.answer = "<b>too much</b> to feel";
  const std::string html =
      htmlSurvey({rated(0, "force", 3), rated(0, "cld+force", 6), words, rated(1, "force", 5), rated(2, "force", 5)});
  EXPECT_NE(html.find("<td>I did well</td><td></td><td>force</td><td>3</td><td>4.3<br><small>(3 to "
                      "5)</small></td><td>3; 5 (2 people)</td>"),
            std::string::npos)
      << html;
  EXPECT_NE(html.find("<td>cld+force</td><td>1</td><td>6<br><small>(6 to 6)</small></td><td>6</td>"), std::string::npos)
      << html;
  EXPECT_NE(html.find("&lt;b&gt;too much&lt;/b&gt; to feel"), std::string::npos) << "a person's words are no HTML";
}

TEST(ReportSurvey, IsLeftOutWhereNobodyWasAsked) { EXPECT_EQ(htmlSurvey({}), ""); }

TEST(StudyFinding, SaysEachConditionsFigureBesideThePublishedOne) {
  StudySummary summary;
  summary.info.task = "backlash-discrimination";
  summary.participants = 12;
  summary.headline = {.name = "threshold", .unit = "mm", .scale = 1e3};
  StudyCondition low, edge;
  low.name = "low";
  low.label = "large cylinder";
  low.published = 0.46e-3;
  low.headline = {.n = 12, .mean = 0.5e-3, .half_width = 0.1e-3};
  edge.name = edge.label = "edge";
  edge.published = std::nan("");
  edge.headline = {.n = 12, .mean = 0.9e-3, .half_width = 0.2e-3};
  summary.conditions = {low, edge};
  const std::string words = studyFinding(summary);
  EXPECT_EQ(words.rfind("12 people. Threshold, large cylinder: 0.50 (", 0), 0u) << words;
  EXPECT_NE(words.find("mm; published 0.46 mm. Threshold, edge: 0.90 ("), std::string::npos) << words;
  EXPECT_EQ(words.find("nan"), std::string::npos) << words;
  summary.conditions = {edge};
  summary.conditions[0].headline = {.n = 1, .mean = 0.9e-3, .half_width = std::nan("")};
  EXPECT_NE(studyFinding(summary).find("One person says nothing about others."), std::string::npos);
}

}  // namespace
}  // namespace pincer::tasks
