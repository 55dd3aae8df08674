// row_sink: keeps the trials' rows alone: no sample is made.
#pragma once
#include <vector>

#include "pincer/tasks/lab/experiments/record_sink.h"

namespace pincer::tasks {

class RowSink final : public RecordSink {
 public:
  bool wantsSample(std::int64_t) const override { return false; }
  void sample(const SampleRecord&) override {}
  void event(const EventRecord&) override {}
  void reading(const ReadingRecord&) override {}
  void trial(const TrialRecord& trial) override { rows.push_back(trial); }
  std::vector<TrialRecord> rows;
};

}  // namespace pincer::tasks
