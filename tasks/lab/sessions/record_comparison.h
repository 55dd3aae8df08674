// record_comparison: which column of two records differs first, to the bit; how long ticks took is left out.
#pragma once
#include <fmt/format.h>

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "pincer/tasks/run/session/columns.h"

namespace pincer::tasks {

// Calls visit(name, text) with texts of a record's columns that tell any two values apart, measured times left out.
template <class Record, class Visit>
void forEachComparable(const Record& record, Visit&& visit) {
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    if (name.isMeasuredTime()) return;
    if constexpr (std::is_floating_point_v<Field>) {
      // NaNs are told apart by a sign that means nothing; the store has one zero, -0 + 0 as well
      visit(name, fmt::format("{}", field != field ? std::numeric_limits<Field>::quiet_NaN() : field + 0));
    } else {
      visit(name, fmt::format("{}", field));
    }
  });
}

template <class Record>
std::string differenceOf(const Record& stored, const Record& fresh) {
  std::vector<std::string> values;
  forEachComparable(stored, [&](const ColumnName&, std::string&& value) { values.push_back(std::move(value)); });
  std::string difference;
  std::size_t i = 0;
  forEachComparable(fresh, [&](const ColumnName& name, const std::string& value) {
    const std::string& was = values[i++];
    if (difference.empty() && was != value) difference = fmt::format("{} was {}, is {}", name.text(), was, value);
  });
  return difference;
}

}  // namespace pincer::tasks
