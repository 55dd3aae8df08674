// one_finger_sweep: a psychophysical study with simulated participants (tasks/lab/experiments), for many values of its
// parameters, and the thresholds, errors or right answers that came of it.
#pragma once
#include "pincer/tasks/lab/sweep/study_sweep.h"

namespace pincer::tasks {

// Each condition's headline (tasks/lab/report/study_summary.h): mean over the participants; NaN where its staircases
// found no threshold. Paths are those of the study's file (pincer run TASK --print-study), as
// conditions[0].travel_share. `task` is one of isStudy(). Throws InputError for a path or value that doesn't fit.
SweepJob oneFingerSweep(const std::string& task, const StudySweep& sweep);

}  // namespace pincer::tasks
