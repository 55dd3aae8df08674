// memory_sink: keeps an experiment's records in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/tasks/lab/experiments/record_sink.h"

namespace pincer::tests {

struct MemorySink final : tasks::RecordSink {
  explicit MemorySink(std::size_t samples_to_expect = 0) { samples.reserve(samples_to_expect); }

  void sample(const tasks::SampleRecord& record) override { samples.push_back(record); }
  void event(const tasks::EventRecord& record) override { events.push_back(record); }
  void reading(const tasks::ReadingRecord& record) override { readings.push_back(record); }
  void trial(const tasks::TrialRecord& record) override { trials.push_back(record); }

  std::int64_t count(const std::string& kind) const {
    std::int64_t n = 0;
    for (const auto& event : events) n += event.kind == kind;
    return n;
  }

  std::vector<tasks::SampleRecord> samples;
  std::vector<tasks::EventRecord> events;
  std::vector<tasks::ReadingRecord> readings;
  std::vector<tasks::TrialRecord> trials;
};

}  // namespace pincer::tests
