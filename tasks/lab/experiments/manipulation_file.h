// manipulation_file: a manipulation study as a JSON file (comments allowed): every parameter of the protocol and of the
// simulated participants. What a file leaves out has the published design's value, or ours where that is open; unknown
// keys are errors with line and a did-you-mean.
//
// The session keeps this text, so that a study can be resumed and replayed.
#pragma once
#include <string>
#include <string_view>

#include "pincer/tasks/lab/experiments/manipulation_study.h"

namespace pincer::tasks {

class JsonValue;

// The study as a file: every value, and what it means behind it as a comment.
std::string studyFile(const ManipulationStudy& study);

// Throws InputError: file, line, path, value, range, remedy.
// `study`: whose values are kept where the file has none.
ManipulationStudy readStudyFile(const std::string& path, ManipulationStudy study = {});
ManipulationStudy parseStudyFile(std::string_view text, const std::string& name);
ManipulationStudy studyOfJson(const JsonValue& file);

}  // namespace pincer::tasks
