// session_samples: the samples of a stored session, in order.
#pragma once
#include <vector>

#include "pincer/tasks/run/session_store.h"

namespace pincer::tests {

inline std::vector<tasks::SampleRecord> samplesOf(const tasks::SessionReader& reader,
                                                  const tasks::SampleFilter& filter = {}) {
  std::vector<tasks::SampleRecord> samples;
  reader.forEachSample(filter, [&](const tasks::SampleRecord& s) { samples.push_back(s); });
  return samples;
}

}  // namespace pincer::tests
