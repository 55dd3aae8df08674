// session_hash: what a session keeps, as texts that tell any two apart; and 64 bits over all of it.
#pragma once
#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "pincer/tasks/run/session/columns.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

// Calls visit(name, value) with the texts of a record's columns, times that were measured left out. A session has
// thousands of ticks of a hundred columns: all of them are written into the same two texts.
template <class Record, class Visit>
void forEachComparable(const Record& record, Visit&& visit) {
  std::string column;
  fmt::memory_buffer value;
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    column.clear();
    value.clear();
    name.writeTo(column);
    if (column == "tick_us" || column == "tick_median_us" || column == "tick_p999_us") return;
    if constexpr (std::is_floating_point_v<Field>) {
      // NaNs are told apart by a sign that means nothing; the store has one zero, -0 + 0 as well
      fmt::format_to(std::back_inserter(value), "{}",
                     field != field ? std::numeric_limits<Field>::quiet_NaN() : field + 0);
    } else {
      fmt::format_to(std::back_inserter(value), "{}", field);
    }
    visit(std::string_view(column), std::string_view(value.data(), value.size()));
  });
}

// 16 hexadecimal digits (FNV-1a) over the finished trials, answers and kept ticks:
// equal for runs that are the same to the bit.
std::string sessionHash(const SessionReader& session);

}  // namespace pincer::tasks
