// session_hash: what a session keeps, as texts that tell any two apart; and 64 bits over all of it.
#pragma once
#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pincer/tasks/run/session/columns.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

// Values of a record's columns, times that were measured left out.
template <class Record>
std::vector<std::pair<std::string, std::string>> comparable(const Record& record) {
  std::vector<std::pair<std::string, std::string>> values;
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    const std::string column = name.text();
    if (column == "tick_us" || column == "tick_median_us" || column == "tick_p999_us") return;
    if constexpr (std::is_floating_point_v<Field>) {
      values.emplace_back(column,
                          // the store has one zero, -0 + 0 as well
                          field != field ? std::string("nan") : fmt::format("{}", field + 0));
    } else {
      values.emplace_back(column, fmt::format("{}", field));
    }
  });
  return values;
}

// 16 hexadecimal digits (FNV-1a) over the finished trials, answers and kept ticks:
// equal for runs that are the same to the bit.
std::string sessionHash(const SessionReader& session);

}  // namespace pincer::tasks
