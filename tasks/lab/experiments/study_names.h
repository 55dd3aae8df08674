// study_names: the name of a study's experiment, as `pincer run` has it, and the key "experiment" of a study file,
// which keeps a file from running as another experiment whose keys happen to be the same.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/experiments/manipulation_study.h"
#include "pincer/tasks/lab/experiments/shape_study.h"

namespace pincer::tasks {

class JsonValue;

inline constexpr std::string_view kExperimentKey = "experiment";
inline constexpr std::string_view kExperimentMeaning = "for which the file is: any other refuses it; may be left out";
// Both tasks with two fingers are parts of the last, whose file either of them takes.
inline constexpr std::array<std::string_view, 8> kExperimentNames = {
    "smoothness-discrimination", "backlash-discrimination", "delay-discrimination", "repeated-localisation",
    "shape-identification",      "sphere-pickup",           "cylinder-alignment",   "manipulation"};

inline std::string taskName(const ArcStudy& study) { return study.task; }
inline std::string taskName(const LocalisationStudy&) { return "repeated-localisation"; }
inline std::string taskName(const ShapeStudy&) { return "shape-identification"; }

// Throws InputError with file, line and remedy if the file names another experiment than `runs`, or none that there is.
void requireExperiment(const JsonValue& file, std::string_view runs);

}  // namespace pincer::tasks
