// study_file: the protocol of an experiment as JSON: what `pincer run TASK --print-study` prints and `--study FILE`
// reads. Every key may be left out; then the published design holds. SI units and radians. Mistakes get line, value
// and remedy (tasks/run/files/strict_json.h).
#pragma once
#include <string>

#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/experiments/shape_study.h"

namespace pincer::tasks {

// Changes what the file at `path` names. A list of conditions replaces the whole list; one with the name of a published
// condition begins as that. Throws InputError.
void readStudy(const std::string& path, ArcStudy& study);
void readStudy(const std::string& path, LocalisationStudy& study);
void readStudy(const std::string& path, ShapeStudy& study);
// The same from the text of a file; `name` stands for it in errors.
void parseStudy(const std::string& text, const std::string& name, ArcStudy& study);
void parseStudy(const std::string& text, const std::string& name, LocalisationStudy& study);
void parseStudy(const std::string& text, const std::string& name, ShapeStudy& study);

std::string studyJson(const ArcStudy& study);
std::string studyJson(const LocalisationStudy& study);
std::string studyJson(const ShapeStudy& study);

// The parameters of the simulated participants that do the study, frozen before it.
std::string participantsJson(const ArcStudy& study);
std::string participantsJson(const LocalisationStudy& study);
std::string participantsJson(const ShapeStudy& study);

// 16 hexadecimal digits that stand for a text (FNV-1a, 64 bits: G. Fowler, L. C. Noll, K.-P. Vo).
std::string fingerprint(const std::string& text);

}  // namespace pincer::tasks
