// The scenes and study files that the documentation prints are taken by their readers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;

struct Example {
  std::string page, task, text;  // task: the study named last before it
};

const std::vector<std::string> kTasks = {"smoothness-discrimination", "backlash-discrimination", "delay-discrimination",
                                         "shape-identification",      "repeated-localisation",   "manipulation"};

// Blocks of code that begin with a brace, or are marked as JSON: fenced ones, and ones indented by four.
std::vector<Example> examplesOf(const std::filesystem::path& page) {
  std::istringstream in(tests::readFile(page));
  std::vector<Example> found;
  std::string task, block;
  bool fenced = false, is_json = false;
  const auto finish = [&] {
    if (is_json && !block.empty()) found.push_back({page.filename().string(), task, block});
    block.clear();
    is_json = false;
  };
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```")) {
      finish();
      fenced = !fenced;
      is_json = fenced && line.starts_with("```json");
      continue;
    }
    const bool indented = !fenced && line.starts_with("    ");
    if (indented && block.empty() && line[4] == '{') is_json = true;
    if (fenced || indented) {
      block += line + "\n";
      continue;
    }
    finish();
    for (const std::string& name : kTasks)
      if (line.find("pincer run " + name) != std::string::npos) task = name;
  }
  finish();
  return found;
}

void readAsStudy(const Example& example) {
  if (example.task == "manipulation") {
    parseStudyFile(example.text, example.page);
    return;
  }
  for (ArcStudy study : {smoothnessStudy(), backlashStudy(), delayStudy()})
    if (study.task == example.task) return parseStudy(example.text, example.page, study);
  ASSERT_TRUE(example.task == "shape-identification" || example.task == "repeated-localisation") << example.text;
  ShapeStudy shapes;
  LocalisationStudy places;
  example.task == "shape-identification" ? parseStudy(example.text, example.page, shapes)
                                         : parseStudy(example.text, example.page, places);
}

// A scene, or keys of one, or a finger.
std::string asScene(const std::string& text) {
  if (contains(text, "\"version\"")) return text;
  const bool keys = text.find_first_not_of(" \n") != std::string::npos && text[text.find_first_not_of(" \n")] == '"';
  const std::string bodies = contains(text, "\"bodies\"") ? "" : "\"bodies\": [],\n";
  if (keys) return "{\"version\": 1, \"duration\": 1,\n" + bodies + text + "}";
  return "{\"version\": 1, \"duration\": 1, \"bodies\": [], \"fingers\": [" + text + "]}";
}

TEST(DocsExamples, ScenesAndStudiesThatAreShownAreTaken) {
  int studies = 0, scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PINCER_SOURCE_DIR "/docs")) {
    if (entry.path().extension() != ".md") continue;
    for (const Example& example : examplesOf(entry.path())) {
      const bool is_study = example.page == "experiments.md" || example.page == "own-study.md";
      const std::string said = errorOf([&] {
        if (is_study) return readAsStudy(example);
        parseScene(asScene(example.text), std::string(PINCER_SOURCE_DIR "/tasks/scenes/") + example.page);
      });
      EXPECT_EQ(said, "") << example.page << " shows:\n" << example.text;
      ++(is_study ? studies : scenes);
    }
  }
  EXPECT_GE(studies, 1);
  EXPECT_GE(scenes, 3);
}

// A condition with a name that isn't published begins as the first published
// one: its staircase is one that can be shown.
TEST(DocsExamples, ANewConditionBeginsAsTheFirstPublishedOne) {
  ArcStudy study = delayStudy();
  parseStudy(R"({"conditions": [{"name": "half", "travel_share": 0.5}]})", "s.json", study);
  ASSERT_EQ(study.conditions.size(), 1u);
  EXPECT_EQ(study.conditions[0].staircase.highest, delayStudy().conditions[0].staircase.highest);
  EXPECT_EQ(study.conditions[0].label, "half");
  EXPECT_TRUE(std::isnan(study.conditions[0].published));
}

// Two parameters that contradict each other are refused with the line of the nearest one that the file has.
TEST(DocsExamples, AStudyThatContradictsItselfIsRefusedWithFileAndLine) {
  const auto said = [](const std::string& text) {
    return errorOf([&] {
      ArcStudy study = delayStudy();
      parseStudy(text, "s.json", study);
    });
  };
  const auto expectStart = [](const std::string& text, const std::string& start) {
    EXPECT_EQ(text.substr(0, start.size()), start);
  };
  expectStart(
      said("{\n\"conditions\": [\n{\"name\": \"whole\"},\n{\"name\": \"half\",\n\"staircase\": {\"averaged\": 99}}]}"),
      "s.json:5: delay-discrimination: condition half: staircase: averaged = 99 is out of range [1, reversals]");
  expectStart(said("{\"seed\": 1,\n\"strokes\": 3}"), "s.json:2: delay-discrimination: strokes = 3 is odd");
  expectStart(said("{\"seed\": 1,\n\"conditions\": []}"), "s.json:2: delay-discrimination: conditions is empty");
  expectStart(errorOf([] { parseStudyFile("{\"seed\": 1,\n\"tasks\": []}", "m.json"); }),
              "m.json:2: study: tasks is empty");
  expectStart(errorOf([] {
                parseStudyFile("{\"seed\": 1,\n\"cylinder_alignment\": {\"start_min\": 2,\n\"start_max\": 1}}",
                               "m.json");
              }),
              "m.json:3: cylinder-alignment: start_max = 1 is out of range [2, 3.1416]");
  const tests::TemporaryDirectory folder;
  std::ofstream(folder / "odd.json") << "{\n\"strokes\": 3}";
  const auto ran = tests::runPincer({"run", "delay-discrimination", "--study", folder / "odd.json", "--print-study"});
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_TRUE(contains(ran.error, "odd.json:2: delay-discrimination: strokes = 3 is odd")) << ran.error;
}

}  // namespace
}  // namespace pincer::tasks
