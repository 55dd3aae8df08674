// variation: which number of a scene or study takes which values in a sweep, as its user writes it.
//
//   PATH=FROM:TO:N       N values, evenly from FROM to TO, both included
//   PATH=FROM:TO:N:log   likewise, in equal ratios
//   PATH=A,B,C           these
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

// Every combination of the variations' values; the last varies fastest. Throws InputError where there are more than `most`.
std::vector<std::vector<double>> gridOf(const std::vector<Variation>& variations, std::size_t most);

}  // namespace pincer::tasks
