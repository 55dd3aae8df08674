#include "pincer/tasks/lab/sessions/session_hash.h"

#include "pincer/tasks/run/files/fingerprint.h"

namespace pincer::tasks {

std::string sessionHash(const SessionReader& session) {
  Fingerprint hash;
  const auto add = [&](const auto& record) {
    forEachComparable(record, [&](std::string_view name, std::string_view value) {
      hash.add(name);
      hash.add(value);
    });
  };
  for (const TrialRecord& trial : session.trials()) add(trial);
  for (const ResponseRecord& response : session.responses()) add(response);
  session.forEachSample({}, add);
  return hash.text();
}

}  // namespace pincer::tasks
