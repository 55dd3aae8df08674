#include "tasks/app/replay.h"

#include <fmt/format.h>

#include <cstring>
#include <type_traits>
#include <vector>

#include "contact/error.h"
#include "tasks/experiments/manipulation_file.h"
#include "tasks/experiments/simulated_trial.h"
#include "tasks/session/columns.h"

namespace pincer::tasks {
namespace {

// Values of a record's columns as text that tells any two apart, times that were measured left out.
template <class Record>
std::vector<std::pair<std::string, std::string>> comparable(const Record& record) {
  std::vector<std::pair<std::string, std::string>> values;
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    const std::string column = name.text();
    if (column == "tick_us" || column == "tick_median_us" || column == "tick_p999_us") return;
    if constexpr (std::is_floating_point_v<Field>) {
      values.emplace_back(column,
                          field != field ? std::string("nan") : fmt::format("{}", field + 0));  // the store has one zero, -0 + 0 as well
    } else {
      values.emplace_back(column, fmt::format("{}", field));
    }
  });
  return values;
}

template <class Record>
std::string differenceOf(const Record& stored, const Record& fresh) {
  const auto a = comparable(stored), b = comparable(fresh);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) return fmt::format("{} was {}, is {}", a[i].first, a[i].second, b[i].second);
  }
  return "";
}

class ComparingSink final : public RecordSink {
 public:
  ComparingSink(const SessionReader& session, const TrialRecord& row, ReplayResult& result) : row_(row), result_(result) {
    session.forEachSample({.trial = row.trial}, [this](const SampleRecord& sample) { stored_.push_back(sample); });
  }
  bool wantsSample(std::int64_t tick) const override { return next_ < stored_.size() && stored_[next_].tick == tick; }
  void sample(const SampleRecord& sample) override {
    const SampleRecord& stored = stored_[next_++];
    ++result_.samples;
    if (!result_.first) report(differenceOf(stored, sample), stored.tick, stored.time);
  }
  void event(const EventRecord&) override {}
  void reading(const ReadingRecord&) override {}
  void trial(const TrialRecord& trial) override {
    ++result_.trials;
    if (!result_.first) report(differenceOf(row_, trial), -1, trial.duration);
    if (!result_.first && next_ < stored_.size()) report("the trial ended before this tick", stored_[next_].tick, stored_[next_].time);
  }

 private:
  void report(const std::string& what, std::int64_t tick, double time) {
    if (!what.empty()) result_.first = ReplayDifference{row_.trial, tick, time, what};
  }
  TrialRecord row_;
  ReplayResult& result_;
  std::vector<SampleRecord> stored_;
  std::size_t next_ = 0;
};

std::vector<TrialRecord> wantedTrials(const SessionReader& session, std::optional<std::int64_t> trial) {
  std::vector<TrialRecord> wanted;
  for (const TrialRecord& row : session.trials()) {
    if (!trial || row.trial == *trial) wanted.push_back(row);
  }
  if (wanted.empty()) {
    throw InputError(
        fmt::format("{}: holds no finished trial{}. `pincer report` lists them.", session.path(), trial ? fmt::format(" {}", *trial) : ""));
  }
  return wanted;
}

void requireSimulated(const SessionReader& session) {
  const std::string& task = session.info().task;
  const bool known = task == "manipulation" || task == "sphere-pickup" || task == "cylinder-alignment";
  if (known && session.info().devices_json.find("\"arms\": \"simulated\"") != std::string::npos) return;
  throw InputError(
      fmt::format("{}: can't be replayed: only sphere pickup and cylinder alignment with simulated participants are (task: {}).",
                  session.path(), task));
}

}  // namespace

ReplayResult replaySession(const SessionReader& session, std::optional<std::int64_t> trial, const std::atomic<bool>& interrupted,
                           const std::function<void(std::int64_t, std::int64_t)>& progress, const ReplayRun& run) {
  requireSimulated(session);
  const ManipulationStudy study = parseStudyFile(session.info().protocol_json, session.path() + ": protocol");
  const auto plan = manipulationTrials(study);
  const PickupObject object = makePickupObject(study.pickup);
  const auto rows = wantedTrials(session, trial);
  ReplayResult result;
  for (const TrialRecord& row : rows) {
    const ManipulationTrial& spec = plan.at(static_cast<std::size_t>(row.trial));
    ComparingSink sink(session, row, result);
    const std::unique_ptr<Participant> participant = makeParticipant(study, spec);
    SimulatedTrial cycle(makeTrial(study, object, spec, sink), *participant);
    if ((run ? run(cycle.cycle(), row) : runServo({}, cycle, interrupted)).interrupted) break;
    cycle.finish();
    if (result.first) break;
    if (progress) progress(result.trials, static_cast<std::int64_t>(rows.size()));
  }
  return result;
}

}  // namespace pincer::tasks
