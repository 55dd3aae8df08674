// Studies of one's own: in every experiment a file names conditions, blocks, their order and questions; simulated
// people do them, and report and export tell the conditions apart.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::TemporaryDirectory;

struct OwnStudy {
  const char* task;
  const char* design;      // keys of the file that make it small
  const char* conditions;  // labelled "as it was", "a little other" and "quite other"
  int trials;              // of a condition, per participant and block
  int participants = 2;
};

constexpr const char* kShort =
    R"("staircase": {"reversals": 2, "averaged": 1, "large_reversals": 0, "most_trials": 2})";

const std::vector<OwnStudy> kStudies = {
    {"smoothness-discrimination", R"("strokes": 2)",
     R"({"name": "C3", "label": "as it was", SHORT}, {"name": "mixed", "label": "a little other", "tactile": "facet", SHORT},
        {"name": "third", "label": "quite other", "force": "smooth", "tactile": "smooth", SHORT})",
     2},
    {"backlash-discrimination", R"("strokes": 2)",
     R"({"name": "edge", "label": "as it was", SHORT}, {"name": "flat", "label": "a little other", SHORT},
        {"name": "third", "label": "quite other", "force": "facet", SHORT})",
     2},
    {"delay-discrimination", R"("strokes": 2)",
     R"({"name": "whole", "label": "as it was", SHORT}, {"name": "half", "label": "a little other", "travel_share": 0.5, SHORT},
        {"name": "third", "label": "quite other", "travel_share": 0.8, SHORT})",
     2},
    {"repeated-localisation", R"("places": 2, "repetitions": 1)",
     R"({"name": "tactor", "label": "as it was"}, {"name": "loose", "label": "a little other", "backlash": 0.002},
        {"name": "third", "label": "quite other", "delay": 0.1, "radius_max": 0.06})",
     2},
    {"shape-identification", R"("sessions": 1, "sizes": {"sides": 12, "facet_sides": 12})",
     R"({"name": "shaded", "label": "as it was"}, {"name": "flat", "label": "a little other", "shaded": false, "group": 2},
        {"name": "third", "label": "quite other", "display_tactile": true, "group": 3})",
     14, 1},
    {"sphere-pickup", R"("sphere_pickup": {"repetitions": 1, "frictions": [0.9]})",
     R"("cld+force", {"name": "heavy", "label": "a little other", "display_tactile": true, "mass_ratio": 1.5},
        {"name": "third", "label": "quite other", "shading": "facet"})",
     1},
    {"cylinder-alignment", R"("cylinder_alignment": {"repetitions": 1, "timeout": 60})",
     R"({"name": "force", "label": "as it was"}, {"name": "light", "label": "a little other", "mass_ratio": 0.5},
        {"name": "third", "label": "quite other", "display_tactile": true, "shading": "exactly"})",
     1},
};

std::string fileOf(const OwnStudy& study) {
  std::string conditions = study.conditions;
  for (std::size_t at; (at = conditions.find("SHORT")) != std::string::npos;) conditions.replace(at, 5, kShort);
  return fmt::format(
      R"({{"experiment": "{}", "participants": {}, {}, "conditions": [{}],
  "session": {{"order": "shuffled", "blocks": 2, "instructions": ["Feel it."],
    "demographics": [{{"name": "plays", "text": "Do you play?", "kind": "choice", "choices": ["no", "yes"]}}],
    "survey": [{{"name": "sure", "text": "I was sure", "per": "condition"}}]}}}})",
      study.task, study.participants, study.design, conditions);
}

// Counted trials per condition and participant.
std::map<std::pair<std::string, std::int64_t>, int> countsOf(const SessionReader& session) {
  std::map<std::pair<std::string, std::int64_t>, int> counts;
  for (const ResponseRecord& r : session.responses()) ++counts[{r.condition, r.participant}];
  for (const TrialRecord& t : session.trials()) counts[{t.condition, t.participant}] += t.training == 0;
  return counts;
}

struct OwnStudies : testing::TestWithParam<OwnStudy> {};

TEST_P(OwnStudies, NameConditionsBlocksOrderAndQuestions) {
  const OwnStudy& study = GetParam();
  const TemporaryDirectory dir;
  const std::string file = dir / "study.json", out = dir / "out";
  std::ofstream(file) << fileOf(study);
  const auto shown = tests::runPincer({"run", study.task, "--study", file, "--print-study"});
  ASSERT_EQ(shown.exit_code, 0) << shown.error;
  EXPECT_TRUE(contains(shown.out, "I was sure") && contains(shown.out, "Do you play?")) << shown.out;
  const auto ran = tests::runPincer({"run", study.task, "--study", file, "--out", out, "--sample-rate", "10"});
  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.error;
  const auto counts = countsOf(SessionReader(out + "/session.db"));
  EXPECT_EQ(counts.size(), 3u * static_cast<std::size_t>(study.participants));
  for (const auto& [cell, count] : counts) EXPECT_EQ(count, 2 * study.trials) << cell.first << " of " << cell.second;
  const std::string report = tests::readFile(out + "/report.html");
  for (const char* label : {"a little other", "quite other"}) {
    EXPECT_TRUE(contains(report, label)) << label;
    EXPECT_TRUE(contains(ran.out, label)) << label << " isn't in:\n" << ran.out;
  }
  const auto exported = tests::runPincer({"export", out + "/session.db"});
  ASSERT_EQ(exported.exit_code, 0) << exported.error;
  const std::string columns = tests::readFile(out + "/csv/columns.csv");
  const bool two_fingers = SessionReader(out + "/session.db").responses().empty();
  EXPECT_TRUE(contains(columns, std::string(two_fingers ? "trial" : "response") +
                                    ",condition,,\"condition of the study, as its file names it\","))
      << columns;
  EXPECT_TRUE(contains(columns, ": a little other; third: quite other\n")) << columns;
}

// Its keys may all be known to the other one, which would then run in conditions that differ in their names alone.
TEST_P(OwnStudies, AreRefusedByAnotherExperiment) {
  const OwnStudy& study = GetParam();
  const TemporaryDirectory dir;
  const std::string file = dir / "study.json";
  std::ofstream(file) << fileOf(study);
  for (const OwnStudy& other : kStudies) {
    if (std::string(other.task) == study.task) continue;
    const auto ran = tests::runPincer({"run", other.task, "--study", file, "--print-study"});
    EXPECT_EQ(ran.exit_code, 3) << other.task;
    EXPECT_TRUE(contains(ran.error, fmt::format("study.json:1: experiment = \"{}\" is another experiment than the one "
                                                "that runs here, {}. Give the file to `pincer run {}`",
                                                study.task, other.task, study.task)))
        << ran.error;
  }
}

// A study of both tasks holds the parameters of each.
TEST(OwnStudyFile, OfBothTasksIsTakenByEither) {
  const TemporaryDirectory dir;
  const std::string file = dir / "study.json";
  std::ofstream(file) << R"({"experiment": "manipulation", "sphere_pickup": {"repetitions": 1}})";
  for (const char* task : {"sphere-pickup", "cylinder-alignment", "manipulation"}) {
    const auto shown = tests::runPincer({"run", task, "--study", file, "--print-study"});
    EXPECT_EQ(shown.exit_code, 0) << shown.error;
    EXPECT_TRUE(contains(shown.out, fmt::format("\"experiment\": \"{}\"", task))) << shown.out;
  }
  std::ofstream(file) << R"({"experiment": "sphere-picup"})";
  EXPECT_TRUE(contains(tests::runPincer({"run", "sphere-pickup", "--study", file, "--print-study"}).error,
                       "study.json:1: experiment = \"sphere-picup\" isn't known. Did you mean \"sphere-pickup\"?"));
}

INSTANTIATE_TEST_SUITE_P(EveryExperiment, OwnStudies, testing::ValuesIn(kStudies), [](const auto& study) {
  std::string name = study.param.task;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace pincer::tasks
