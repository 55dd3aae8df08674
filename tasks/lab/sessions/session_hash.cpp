#include "pincer/tasks/lab/sessions/session_hash.h"

#include <bit>
#include <limits>

#include "pincer/tasks/run/files/fingerprint.h"
#include "pincer/tasks/run/session/columns.h"

namespace pincer::tasks {
namespace {

std::uint64_t bitsOf(double value) {
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
      hash.add(bitsOf(field));
    } else if constexpr (std::is_integral_v<Field>) {
      hash.add(static_cast<std::uint64_t>(field));
    } else {
      hash.add(field);
    }
  });
}

template <class Record>
void addTable(const std::vector<Record>& records, Fingerprint& hash) {
  addNames<Record>(hash);
  for (const Record& record : records) addValues(record, hash);
}

}  // namespace

std::string sessionHash(const SessionReader& session) {
  Fingerprint hash;
  addTable(session.trials(), hash);
  addTable(session.responses(), hash);
  addNames<SampleRecord>(hash);
  session.forEachSample({}, [&](const SampleRecord& sample) { addValues(sample, hash); });
  return hash.text();
}

}  // namespace pincer::tasks
