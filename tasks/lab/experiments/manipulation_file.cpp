#include "pincer/tasks/lab/experiments/manipulation_file.h"

#include "pincer/tasks/lab/experiments/study_reader.h"
#include "pincer/tasks/lab/experiments/study_writer.h"
#include "pincer/tasks/run/files/file_limits.h"

namespace pincer::tasks {

std::string studyFile(const ManipulationStudy& study) { return studyText(study); }

ManipulationStudy parseStudyFile(std::string_view text, const std::string& name) {
  return studyOfJson(parseJson(text, name));
}

ManipulationStudy studyOfJson(const JsonValue& file) {
  ManipulationStudy study;
  readStudyText(file, study);
  return study;
}

ManipulationStudy readStudyFile(const std::string& path, ManipulationStudy study) {
  readStudyText(readJson(path, kStudyFile), study);
  return study;
}

}  // namespace pincer::tasks
