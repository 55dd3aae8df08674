// study_bench: how well the psychophysics core (tasks/lab/study) measures observers whose thresholds are known.
//
// Observers differ: threshold 1 (in units of the level), spread of the psychometric function uniform in [0.2,
// 0.5], lapses in [0, 0.02]. The true value is each observer's own: its level of 70.7 % for a 1-up 2-down
// staircase, of 75 % for constant stimuli.
#pragma once
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct StudyBenchOptions {
  int observers = 2000;  // per measurement
};

std::vector<Measurement> studyMeasurements(const StudyBenchOptions& options);

}  // namespace pincer::tasks
