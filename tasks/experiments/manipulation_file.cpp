#include "tasks/experiments/manipulation_file.h"

#include <fstream>
#include <sstream>

#include "tasks/experiments/study_reader.h"
#include "tasks/experiments/study_writer.h"

namespace pincer::tasks {

std::string studyFile(const ManipulationStudy& study) { return studyText(study); }

ManipulationStudy parseStudyFile(std::string_view text, const std::string& name) { return studyOfJson(parseJson(text, name)); }

ManipulationStudy studyOfJson(const JsonValue& file) {
  ManipulationStudy study;
  readStudyText(file, study);
  validate(study);
  return study;
}

ManipulationStudy readStudyFile(const std::string& path) {
  const std::ifstream file(path);
  if (!file)
    throw InputError(path + ": can't be read. Give the path of a study file; `pincer run manipulation --write-study FILE` makes one.");
  std::ostringstream text;
  text << file.rdbuf();
  return parseStudyFile(text.str(), path);
}

}  // namespace pincer::tasks
