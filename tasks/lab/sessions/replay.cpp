#include "pincer/tasks/lab/sessions/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/experiments/recorded_hands.h"
#include "pincer/tasks/lab/experiments/simulated_trial.h"
#include "pincer/tasks/lab/sessions/manipulation_session.h"
#include "pincer/tasks/lab/sessions/record_comparison.h"
#include "pincer/tasks/lab/sessions/study_experiments.h"
#include "pincer/tasks/lab/sessions/study_replay.h"
#include "pincer/tasks/run/session/build_info.h"
#include "pincer/tasks/run/session/input_codec.h"

namespace pincer::tasks {
namespace {

// A trial of the session: finished, or cut short with what survived of its inputs.
struct StoredTrial {
  TrialRecord row;  // of a trial that was cut short its number alone
  bool finished = true;
  std::optional<HandsRecord> hands{};  // of a person
  std::vector<InputRecord> inputs{};
};

// Compares what a trial leaves behind with what it left behind then.
class ComparingSink final : public RecordSink {
 public:
  ComparingSink(const SessionReader& session, const StoredTrial& stored, ReplayResult& result)
      : stored_(stored),
        result_(result),
        events_(session.events(stored.row.trial)),
        readings_(session.readings(stored.row.trial)) {
    session.forEachSample({.trial = stored.row.trial},
                          [this](const SampleRecord& sample) { samples_.push_back(sample); });
  }
  bool wantsInputs() const override { return stored_.hands.has_value(); }
  void input(const InputRecord& input) override {
    const InputRecord& stored = stored_.inputs[next_input_++];
    ++result_.inputs;
    if (wordsOf(stored) != wordsOf(input)) report(differenceOf(stored, input), stored.tick, stored.time);
  }
  bool wantsSample(std::int64_t tick) const override { return next_ < samples_.size() && samples_[next_].tick == tick; }
  void sample(const SampleRecord& sample) override {
    const SampleRecord& stored = samples_[next_++];
    ++result_.samples;
    report(differenceOf(stored, sample), stored.tick, stored.time);
  }
  void event(const EventRecord& event) override { compareNext("event", events_, next_event_, event); }
  void reading(const ReadingRecord& reading) override { compareNext("reading", readings_, next_reading_, reading); }
  void trial(const TrialRecord& trial) override {
    ++result_.trials;
    if (next_event_ < events_.size())
      report(fmt::format("event {} didn't come again", next_event_), -1, trial.duration);
    if (next_reading_ < readings_.size())
      report(fmt::format("reading {} didn't come again", next_reading_), -1, trial.duration);
    report(differenceOf(stored_.row, trial), -1, trial.duration);
    endTooSoon();
  }
  // After the last tick, when no row follows.
  void endTooSoon() {
    const char* what = "the trial ended before this tick";
    if (next_input_ < stored_.inputs.size())
      report(what, stored_.inputs[next_input_].tick, stored_.inputs[next_input_].time);
    if (next_ < samples_.size()) report(what, samples_[next_].tick, samples_[next_].time);
  }

 private:
  template <class Record>
  void compareNext(const char* kind, const std::vector<Record>& stored, std::size_t& next, const Record& fresh) {
    const std::string name = fmt::format("{} {}", kind, next);
    if (next >= stored.size()) return report(name + " is new", -1, fresh.time);
    const std::string difference = differenceOf(stored[next++], fresh);
    if (!difference.empty()) report(name + ": " + difference, -1, fresh.time);
  }
  void report(const std::string& what, std::int64_t tick, double time) {
    if (!what.empty() && !result_.first) result_.first = ReplayDifference{stored_.row.trial, tick, time, what};
  }
  const StoredTrial& stored_;
  ReplayResult& result_;
  std::vector<EventRecord> events_;
  std::vector<ReadingRecord> readings_;
  std::vector<SampleRecord> samples_;
  std::size_t next_ = 0, next_input_ = 0, next_event_ = 0, next_reading_ = 0;
};

// Bits are promised for the same version and the same sources. Sessions of before format 5 don't tell their sources.
bool isByThisProgram(const SessionInfo& then, const SessionInfo& now) {
  return then.version == now.version && (then.sources.empty() || then.sources == now.sources);
}

// Why bits may differ, for somebody whose bits do.
void compareBuilds(const SessionInfo& then, ReplayResult& result) {
  SessionInfo now;
  tellBuild(now);
  if (then.sources != now.sources || then.version != now.version) {
    result.notes.push_back(
        fmt::format("The session was made by {}; this is {}. Their bits may differ.", programOf(then), programOf(now)));
  }
  result.surroundings = surroundingsThatDiffer(then, now);
}

void requireReplayable(const SessionReader& session, bool simulated, bool other_version) {
  const std::string& task = session.info().task;
  const auto refuse = [&](const std::string& why) { throw InputError(session.path() + ": can't be replayed: " + why); };
  if (task != "manipulation" && task != "sphere-pickup" && task != "cylinder-alignment" && !isOneFingerTask(task)) {
    refuse(fmt::format("its task, {}, is none of this program's.", task));
  }
  if (const std::string doubled = session.doubledTrials(); !doubled.empty()) refuse(doubled);
  SessionInfo now;
  tellBuild(now);
  if (!other_version && !isByThisProgram(session.info(), now)) {
    refuse(fmt::format(
        "it was made by {}, and this is {}: the bits may differ. Replay it with the program that made it, or with "
        "--other-version to see where they do.",
        programOf(session.info()), programOf(now)));
  }
  if (!simulated && !session.keepsInputs()) {
    refuse(
        "it was recorded by a pincer that didn't keep what people's hands did. Its tables and its report are as good "
        "as ever.");
  }
}

// The wanted trials that are finished; of people those cut short too. Their inputs are read one trial at a time.
std::vector<StoredTrial> wantedTrials(const SessionReader& session, std::optional<std::int64_t> trial, bool simulated) {
  std::vector<StoredTrial> wanted;
  const auto isWanted = [&](std::int64_t number) { return !trial || number == *trial; };
  for (const TrialRecord& row : session.trials()) {
    if (isWanted(row.trial)) wanted.push_back({row});
  }
  for (const HandsRecord& hands : simulated ? std::vector<HandsRecord>() : session.hands()) {
    if (!isWanted(hands.trial)) continue;
    const auto same =
        std::find_if(wanted.begin(), wanted.end(), [&](const StoredTrial& t) { return t.row.trial == hands.trial; });
    StoredTrial& stored = same == wanted.end() ? wanted.emplace_back(StoredTrial{{}, false}) : *same;
    stored.row.trial = hands.trial;
    stored.hands = hands;
  }
  if (wanted.empty()) {
    throw InputError(fmt::format("{}: holds no finished trial{}. `pincer report` lists them.", session.path(),
                                 trial ? fmt::format(" {}", *trial + 1) : ""));
  }
  return wanted;
}

bool readInputs(const SessionReader& session, StoredTrial& stored) {
  bool all = false;
  stored.inputs = wholeInputs(session, stored.row.trial, all);
  return all;
}

class Replayer {
 public:
  Replayer(const SessionReader& session, bool simulated, const std::atomic<bool>& interrupted, const ReplayRun& run)
      : session_(session),
        simulated_(simulated),
        interrupted_(interrupted),
        run_(run),
        study_(parseStudyFile(session.info().protocol_json, session.path() + ": protocol")),
        plan_(manipulationTrials(study_)),
        objects_(makePickupObjects(study_)) {}

  // False: interrupted.
  bool replay(StoredTrial& stored, ReplayResult& result) {
    requirePlanned(session_, stored.row.trial, plan_.size());
    const ManipulationTrial& spec = plan_[static_cast<std::size_t>(stored.row.trial)];
    return simulated_ ? replaySimulated(spec, stored, result) : replayRecorded(spec, stored, result);
  }

 private:
  bool serve(HandsCycle& cycle, const TrialRecord& row) {
    return !(run_ ? run_(cycle, row) : runServo({}, cycle, interrupted_)).interrupted;
  }
  bool replaySimulated(const ManipulationTrial& spec, const StoredTrial& stored, ReplayResult& result) {
    ComparingSink sink(session_, stored, result);
    const std::unique_ptr<Participant> participant = makeParticipant(study_, spec);
    SimulatedTrial cycle(makeTrial(study_, objects_, spec, sink), *participant);
    if (!serve(cycle.cycle(), stored.row)) return false;
    cycle.finish();
    return true;
  }
  bool replayRecorded(const ManipulationTrial& spec, StoredTrial& stored, ReplayResult& result) {
    const bool whole = stored.hands && readInputs(session_, stored);
    if (!whole || stored.inputs.empty()) {
      result.notes.push_back(fmt::format(
          "Trial {}: {} inputs of its first ticks are kept, then some were lost; it is compared up to there.",
          stored.row.trial + 1, stored.inputs.size()));
      stored.finished = false;
      if (stored.inputs.empty()) return true;
    }
    ComparingSink sink(session_, stored, result);
    const std::unique_ptr<HandTrial> trial = makeTrial(study_, objects_, spec, sink);
    RecordedHands hands(*trial, *stored.hands, stored.inputs);
    HandsCycle cycle(*trial, hands);
    if (!serve(cycle, stored.row)) return false;
    if (stored.finished) return trial->finish(), true;
    ++result.cut_short;
    if (whole) sink.endTooSoon();
    return true;
  }

  const SessionReader& session_;
  const bool simulated_;
  const std::atomic<bool>& interrupted_;
  const ReplayRun& run_;
  const ManipulationStudy study_;
  const std::vector<ManipulationTrial> plan_;
  const PickupObjects objects_;
};

}  // namespace

ReplayResult replaySession(const SessionReader& session, const ReplayOptions& options,
                           const std::atomic<bool>& interrupted,
                           const std::function<void(std::int64_t, std::int64_t)>& progress, const ReplayRun& run,
                           const FingerReplayRun& finger_run) {
  const bool simulated = session.info().devices_json.find("\"arms\": \"simulated\"") != std::string::npos;
  requireReplayable(session, simulated, options.other_version);
  ReplayResult result;
  compareBuilds(session.info(), result);
  if (isOneFingerTask(session.info().task)) {
    replayStudy({session, simulated, options.trial, interrupted, progress, finger_run}, result);
    return result;
  }
  std::vector<StoredTrial> trials = wantedTrials(session, options.trial, simulated);
  Replayer replayer(session, simulated, interrupted, run);
  std::int64_t done = 0;
  for (StoredTrial& stored : trials) {
    if (!replayer.replay(stored, result) || result.first) break;
    stored = {};
    if (progress) progress(++done, static_cast<std::int64_t>(trials.size()));
  }
  return result;
}

}  // namespace pincer::tasks
