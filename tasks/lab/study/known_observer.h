// known_observer: an observer whose psychometric function is known, to judge staircases and fits by. It has no body and
// feels no device: who does is in tasks/lab/participants.
#pragma once
#include <vector>

#include "pincer/tasks/lab/participants/random.h"
#include "pincer/tasks/lab/study/psychometric.h"
#include "pincer/tasks/lab/study/staircase.h"

namespace pincer::tasks {

// One staircase of an observer whose answers at x are right with probability P(x).
inline Staircase runStaircase(const StaircaseRule& rule, const PsychometricFunction& observer, Random& random) {
  Staircase staircase(rule);
  while (!staircase.over()) staircase.answer(random.uniform() < observer.at(staircase.level()));
  return staircase;
}

// `trials` answers at each of the levels.
inline std::vector<LevelCount> runConstantStimuli(const std::vector<double>& levels, int trials,
                                                  const PsychometricFunction& observer, Random& random) {
  std::vector<LevelCount> counts;
  for (const double level : levels) {
    counts.push_back({level, 0, trials});
    for (int k = 0; k < trials; ++k) counts.back().right += random.uniform() < observer.at(level);
  }
  return counts;
}

}  // namespace pincer::tasks
