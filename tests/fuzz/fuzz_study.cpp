#include <string>

#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

using namespace tasks;

template <class Study>
void read(const std::string& text, Study study) {
  readsOrRefuses([&] {
    parseStudy(text, "fuzz.json", study);
    Study again = study;
    parseStudy(studyJson(study), "again.json", again);
    demand(studyJson(again) == studyJson(study), "a study that is written and read again is the same");
  });
}

}  // namespace

void study(Bytes input) {
  const std::string text(textOf(input));
  read(text, smoothnessStudy());
  read(text, LocalisationStudy{});
  read(text, ShapeStudy{});
  readsOrRefuses([&] {
    const std::string written = studyFile(parseStudyFile(text, "fuzz.json"));
    demand(studyFile(parseStudyFile(written, "again.json")) == written,
           "a study that is written and read again is the same");
  });
}

}  // namespace pincer::fuzz
