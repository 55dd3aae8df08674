// record_hash: records as numbers of a fingerprint. Times that were measured are left out; NaNs are one value, and so
// are the two zeros, as in the store.
#pragma once
#include <bit>
#include <limits>

#include "pincer/tasks/run/files/fingerprint.h"
#include "pincer/tasks/run/session/columns.h"

namespace pincer::tasks {

inline std::uint64_t hashedBits(double value) {
  return std::bit_cast<std::uint64_t>(value != value ? std::numeric_limits<double>::quiet_NaN() : value + 0);
}

// A table begins with its columns' names: a session has thousands of ticks of a hundred columns, whose numbers are all
// that is added.
template <class Record>
void addNames(Fingerprint& hash) {
  const Record record{};
  forEachColumn(record, [&](const ColumnName& name, const auto&) { hash.add(name.text()); });
}

template <class Record>
void addValues(const Record& record, Fingerprint& hash) {
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    if (name.isMeasuredTime()) return;
    if constexpr (std::is_floating_point_v<Field>) {
      hash.add(hashedBits(field));
    } else if constexpr (std::is_integral_v<Field>) {
      hash.add(static_cast<std::uint64_t>(field));
    } else {
      hash.add(field);
    }
  });
}

}  // namespace pincer::tasks
