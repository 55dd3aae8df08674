// variation: which numbers of a scene or study take which values in a sweep, as its user writes them.
//
//   PATH=FROM:TO:N       N values, evenly from FROM to TO, both included
//   PATH=FROM:TO:N:log   likewise, in equal ratios
//   PATH=A,B,C           these
//
// Values of a range are those that a person would write: rounded to the 15 digits that
// doubles keep of the larger end (0.3, not
// 0.30000000000000004); in equal ratios to 12 digits.
#pragma once
#include <string>
#include <vector>

namespace pincer::tasks {

struct Variation {
  std::string path;  // tasks/run/scene/json_change.h
  std::vector<double> values;
};

// Throws InputError that says how it is written.
Variation parseVariation(const std::string& text);

// Paths that vary in a sweep, and each case's values.
struct SweepGrid {
  std::vector<std::string> paths;
  std::vector<std::vector<double>> points;
};

// Every combination of the variations' values; the last varies fastest. These throw InputError where there are more
// than `most` cases, a path is there twice, or lengths don't fit.
SweepGrid crossed(const std::vector<Variation>& variations, std::size_t most);
// The first values of all, the second ones, ...; a single value stands for all.
SweepGrid zipped(const std::vector<Variation>& variations, std::size_t most);
// A CSV file: paths in its first line, then a case per line.
SweepGrid readCases(const std::string& path, std::size_t most);

}  // namespace pincer::tasks
