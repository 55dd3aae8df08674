#include "pincer/tasks/lab/sessions/session_hash.h"

#include "pincer/tasks/run/session/record_hash.h"

namespace pincer::tasks {
namespace {

template <class Record>
void addTable(const std::vector<Record>& records, Fingerprint& hash) {
  addNames<Record>(hash);
  for (const Record& record : records) addValues(record, hash);
}

std::uint64_t samplesHash(const SessionReader& session) {
  Fingerprint hash;
  session.forEachSample({}, [&](const SampleRecord& sample) { addValues(sample, hash); });
  return hash.bits();
}

}  // namespace

std::string sessionHash(const SessionReader& session, const std::optional<std::uint64_t>& samples) {
  Fingerprint hash;
  addTable(session.trials(), hash);
  addTable(session.responses(), hash);
  addNames<SampleRecord>(hash);
  hash.add(samples ? *samples : samplesHash(session));
  return hash.text();
}

}  // namespace pincer::tasks
