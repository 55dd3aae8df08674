// The measures of shape identification and of the manipulation tasks, on answers that are written by hand.
#include "pincer/tasks/lab/findings/shape_measures.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tasks/lab/findings/claim_judge.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

// Every solid once in each of four conditions. Everybody knows all of them but for the tetrahedron, a cone
// when shaded; spheres take 8 s, the rest 16.
std::vector<ResponseRecord> answersOf(int people) {
  std::vector<ResponseRecord> answers;
  for (int person = 0; person < people; ++person) {
    for (const char* condition : {"facets", "facets+cld", "shaded", "shaded+cld"}) {
      for (const char* solid : {"cone", "cylinder", "cube", "sphere", "tetrahedron", "octagon", "triangle"}) {
        ResponseRecord r;
        r.participant = person;
        r.trial = static_cast<std::int64_t>(answers.size());
        r.condition = condition;
        r.stimulus = r.answer = solid;
        r.outcome = "answered";
        const bool shaded = r.condition.starts_with("shaded");
        if (shaded && r.stimulus == "tetrahedron") r.answer = "cone";
        r.correct = r.answer == r.stimulus;
        r.duration = r.stimulus == "sphere" ? 8 : 16;
        r.contact_share = shaded ? 0.9 : 0.6;
        answers.push_back(r);
      }
    }
  }
  return answers;
}

TEST(ShapeMeasures, AreThoseOfTheAnswers) {
  StudyMeasures m;
  addShapeMeasures(answersOf(3), m);
  EXPECT_EQ(m.persons, 3u);
  ASSERT_EQ(m.of("right").size(), 3u);
  EXPECT_NEAR(m.of("right")[0], 100.0 * 26 / 28, 1e-12);
  EXPECT_EQ(m.of("right:sphere")[2], 100);
  EXPECT_EQ(m.of("right:tetrahedron")[2], 50);
  // Cells person x solid x shading or display: the published 504 in halves.
  EXPECT_EQ(m.of("right:force").size(), 3u * 7 * 2);
  EXPECT_EQ(m.of("right:shaded").size(), 3u * 7 * 2);
  EXPECT_EQ(m.of("cells:sphere").size(), 3u * 2);
  EXPECT_EQ(m.of("cells:rest").size(), 3u * 6 * 2);
  EXPECT_NEAR(estimateMean(m.of("right:shaded")).mean, 100.0 * 6 / 7, 1e-9);
  EXPECT_NEAR(estimateMean(m.of("right:facets")).mean, 100, 1e-9);
  // Times and contact of trials answered rightly.
  EXPECT_EQ(m.of("times:sphere").size(), 3u * 4);
  EXPECT_EQ(m.of("times:force").size() + m.of("times:cld").size(), 3u * 26);
  EXPECT_EQ(m.of("time:tetrahedron"), (std::vector<double>{16, 16, 16}));
  EXPECT_NEAR(estimateMean(m.of("contact:facets")).mean, 0.6, 1e-12);
  // Confusions.
  EXPECT_EQ(m.of("tetrahedron>cone"), (std::vector<double>{50, 50, 50}));
  EXPECT_EQ(m.of("tetrahedron>cone:shaded")[0], 100);
  EXPECT_EQ(m.of("tetrahedron>others:facets")[0], 0);
  EXPECT_EQ(m.of("confusions:first"), std::vector<double>{50});
  EXPECT_EQ(m.of("confusions:next"), std::vector<double>{0});
  EXPECT_NEAR(m.of("unevenness:cld")[0], std::sqrt((45.0 * 45 + 9 * 25) / 9), 1e-9);  // 50 once and 0 nine times
}

// F13 needs people who are right as often, F21 that spheres are faster: in four
// studies of three people who all do the same.
TEST(ShapeMeasures, JudgeTheClaims) {
  const tests::TemporaryDirectory dir;
  std::vector<std::string> paths;
  for (int e = 0; e < 4; ++e) {
    SessionInfo info;
    info.task = "shape-identification";
    info.protocol_json = studyJson(ShapeStudy{});
    paths.push_back(dir / fmt::format("{}.db", e));
    SessionWriter writer = SessionWriter::create(paths.back(), info);
    for (ResponseRecord r : answersOf(3)) {
      r.duration += 0.1 * static_cast<double>(r.trial % 5);  // something varies
      writer.finishResponse(r);
    }
    writer.close();
  }
  const ClaimTable table = judgeClaims({{{"shape-identification", paths}}, {}, {}});
  const auto verdict = [&](const std::string& id) {
    const auto row =
        std::find_if(table.rows.begin(), table.rows.end(), [&](const ClaimRow& r) { return r.claim->id == id; });
    return verdictOn(*row->claim, row->evidence);
  };
  EXPECT_EQ(verdict("F21"), "follows");
  EXPECT_EQ(verdict("F24a"), "does not follow: 2.5 times");  // 50 % for 20.1
  EXPECT_EQ(verdict("F24k"), "follows") << "one value per study is enough where nothing was tested";
  EXPECT_EQ(verdict("F24l"), "does not follow") << "neither way";
  EXPECT_EQ(verdict("F14"), "follows") << "the display changes nothing";
  EXPECT_EQ(verdict("F44"), "not run");
}

// Two people who need three squeezes without the display and one with it, and 7 s longer for an alignment with it.
TEST(HandMeasures, ArePeoplesMeans) {
  std::vector<TrialRecord> trials;
  for (int person = 0; person < 2; ++person) {
    for (const char* condition : {"force", "cld+force"}) {
      const bool cld = condition == std::string("cld+force");
      TrialRecord t;
      t.participant = person;
      t.condition = condition;
      t.outcome = "success";
      t.task = "sphere-pickup";
      t.squeezes = cld ? 1 : 3;
      t.duration = 5;
      trials.push_back(t);
      t.task = "cylinder-alignment";
      t.duration = cld ? 27 : 20;
      t.error = cld ? -0.1 : 0.1;
      trials.push_back(t);
    }
  }
  const StudyMeasures m = measuresOf(trials);
  EXPECT_EQ(m.persons, 2u);
  EXPECT_EQ(m.of("tries:force"), (std::vector<double>{3, 3}));
  EXPECT_EQ(m.of("tries:cld"), (std::vector<double>{1, 1}));
  EXPECT_EQ(m.of("alignment-time:longer"), (std::vector<double>{7, 7}));
  EXPECT_NEAR(m.of("alignment-error:cld")[0], 5.73, 0.01);
  EXPECT_EQ(m.of("pickup-time:force")[1], 5);
}

}  // namespace
}  // namespace pincer::tasks
