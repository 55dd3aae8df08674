// record_comparison: which column of two records differs first, to the bit; how long ticks took is left out.
#pragma once
#include <fmt/format.h>

#include <string>

#include "pincer/tasks/lab/sessions/session_hash.h"

namespace pincer::tasks {

template <class Record>
std::string differenceOf(const Record& stored, const Record& fresh) {
  const auto a = comparable(stored), b = comparable(fresh);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) return fmt::format("{} was {}, is {}", a[i].first, a[i].second, b[i].second);
  }
  return "";
}

}  // namespace pincer::tasks
