// record_comparison: which column of two records differs first, to the bit; how long ticks took is left out.
#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "pincer/tasks/lab/sessions/session_hash.h"

namespace pincer::tasks {

template <class Record>
std::string differenceOf(const Record& stored, const Record& fresh) {
  std::vector<std::string> values;
  forEachComparable(stored, [&](std::string_view, std::string_view value) { values.emplace_back(value); });
  std::string difference;
  std::size_t i = 0;
  forEachComparable(fresh, [&](std::string_view name, std::string_view value) {
    const std::string& was = values[i++];
    if (difference.empty() && was != value) difference = fmt::format("{} was {}, is {}", name, was, value);
  });
  return difference;
}

}  // namespace pincer::tasks
