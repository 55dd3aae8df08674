// record_comparison: which column of two records differs first, to the bit; how long ticks took is left out.
#pragma once
#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pincer/tasks/run/session/columns.h"

namespace pincer::tasks {

// Values of a record's columns as text that tells any two apart, times that were measured left out.
template <class Record>
std::vector<std::pair<std::string, std::string>> comparable(const Record& record) {
  std::vector<std::pair<std::string, std::string>> values;
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    const std::string column = name.text();
    if (column == "tick_us" || column == "tick_median_us" || column == "tick_p999_us") return;
    if constexpr (std::is_floating_point_v<Field>) {
      values.emplace_back(column,
                          field != field ? std::string("nan") : fmt::format("{}", field + 0));  // the store has one zero, -0 + 0 as well
    } else {
      values.emplace_back(column, fmt::format("{}", field));
    }
  });
  return values;
}

template <class Record>
std::string differenceOf(const Record& stored, const Record& fresh) {
  const auto a = comparable(stored), b = comparable(fresh);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) return fmt::format("{} was {}, is {}", a[i].first, a[i].second, b[i].second);
  }
  return "";
}

}  // namespace pincer::tasks
