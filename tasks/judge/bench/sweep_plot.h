// sweep_plot: a sweep over an object as a table and a picture: where the contact is on
// the finger, for each variant of shading.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/judge/bench/sweep.h"

namespace pincer::tasks {

struct NamedTrace {
  std::string name;
  SweepTrace trace;
};

// Writes <directory>/<object>.csv (all ticks, SI units) and <directory>/<object>.png, making the
// directory. The first trace is the one that the picture's lower part compares with. Throws InputError
// where a file can't be written or gnuplot is missing.
void writeSweep(const std::string& directory, const std::string& object, const std::vector<NamedTrace>& traces);

}  // namespace pincer::tasks
