#include "pincer/tasks/lab/sessions/study_replay.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/finger/recorded_finger.h"
#include "pincer/tasks/lab/sessions/record_comparison.h"
#include "pincer/tasks/lab/sessions/study_experiments.h"
#include "pincer/tasks/run/session/input_codec.h"

namespace pincer::tasks {
namespace {

// A trial of the session: answered, or cut short with what survived of its inputs.
struct StoredStudyTrial {
  std::int64_t trial = 0;
  std::optional<ResponseRecord> response;
  std::optional<HandsRecord> hands;  // of a person
  std::vector<InputRecord> inputs;
  bool has_all_inputs = true;
};

// Compares what a trial leaves behind with what it left behind then.
class StudyComparison final : public StudySink {
 public:
  StudyComparison(const SessionReader& session, const StoredStudyTrial& stored, ReplayResult& result)
      : stored_(stored), result_(result), events_(session.events(stored.trial)) {
    session.forEachSample({.trial = stored.trial}, [this](const SampleRecord& sample) { samples_.push_back(sample); });
  }
  bool wantsInputs() const override { return stored_.hands.has_value(); }
  void input(const InputRecord& input) override {
    if (next_input_ >= stored_.inputs.size())
      return report("the trial had ended before this tick", input.tick, input.time);
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
  void event(const EventRecord& event) override {
    if (!stored_.response) return;
    if (next_event_ >= events_.size()) return report(fmt::format("event {} is new", next_event_), -1, event.time);
    const std::string difference = differenceOf(events_[next_event_], event);
    if (!difference.empty()) report(fmt::format("event {}: {}", next_event_, difference), -1, event.time);
    ++next_event_;
  }
  void response(const ResponseRecord&) override {}
  // After the last tick.
  void end() {
    const char* what = "the trial ended before this tick";
    if (next_input_ < stored_.inputs.size())
      report(what, stored_.inputs[next_input_].tick, stored_.inputs[next_input_].time);
    if (stored_.has_all_inputs && next_ < samples_.size()) report(what, samples_[next_].tick, samples_[next_].time);
    if (stored_.response && next_event_ < events_.size())
      report(fmt::format("event {} didn't come again", next_event_), -1, 0);
  }

 private:
  void report(const std::string& what, std::int64_t tick, double time) {
    if (!what.empty() && !result_.first) result_.first = ReplayDifference{stored_.trial, tick, time, what};
  }
  const StoredStudyTrial& stored_;
  ReplayResult& result_;
  std::vector<EventRecord> events_;
  std::vector<SampleRecord> samples_;
  std::size_t next_ = 0, next_input_ = 0, next_event_ = 0;
};

// The session's study, whose trials are compared as they are done again. Those
// that nobody wants are answered as they were.
class ReplayedStudy final : public Experiment {
 public:
  ReplayedStudy(const StudyReplay& replay, ReplayResult& result)
      : Experiment({}),
        replay_(replay),
        result_(result),
        study_(experimentOf(replay.session.info(), replay.session.path(), {}, 1)) {
    for (const ResponseRecord& response : replay.session.responses()) responses_.push_back(response);
    FingerHost host;
    host.person = personOf(replay.session.info());
    serveWith(host);
  }
  std::vector<StudyRun> runs() const override { return study_->runs(); }
  StudyPage introduction(const StudyRun&) const override { return {}; }
  std::vector<ListedStimulus> training(const StudyRun&) const override { return {}; }
  std::string feedback(const ResponseRecord&) const override { return {}; }
  const SurveyPlan& plan() const override { return study_->plan(); }
  std::vector<NamedCondition> conditions() const override { return study_->conditions(); }
  std::size_t answers() const { return responses_.size(); }

  std::optional<ResponseRecord> present(const StudyTrial& trial, StudySink&, const std::atomic<bool>& interrupted,
                                        ServoReport& served) override {
    if (result_.first) return std::nullopt;
    StoredStudyTrial stored = storedTrial(trial.trial);
    if (replay_.trial && trial.trial != *replay_.trial) return stored.response;
    if (!stored.response && stored.inputs.empty()) return std::nullopt;
    StudyComparison comparison(replay_.session, stored, result_);
    study_->serveWith(hostOf(stored));
    auto response = study_->present(trial, comparison, interrupted, served);
    if (!response) return std::nullopt;
    comparison.end();
    if (!stored.has_all_inputs) {
      result_.notes.push_back(fmt::format(
          "Trial {}: {} inputs of its first ticks are kept, then some were lost; it is compared up to there.",
          trial.trial + 1, stored.inputs.size()));
      return stored.response;
    }
    if (stored.response) return response;
    ++result_.cut_short;
    return std::nullopt;
  }

  // With all that the study knows of the trial.
  void compare(const ResponseRecord& response) {
    const ResponseRecord& stored = responses_[static_cast<std::size_t>(response.trial)];
    if (replay_.trial && response.trial != *replay_.trial) return;
    ++result_.trials;
    const std::string difference = differenceOf(stored, response);
    if (!difference.empty() && !result_.first)
      result_.first = ReplayDifference{response.trial, -1, response.duration, difference};
  }

 private:
  StoredStudyTrial storedTrial(std::int64_t trial) {
    StoredStudyTrial stored;
    stored.trial = trial;
    if (static_cast<std::size_t>(trial) < responses_.size())
      stored.response = responses_[static_cast<std::size_t>(trial)];
    if (replay_.simulated) return stored;
    const auto hands = replay_.session.hands();
    const auto own = std::find_if(hands.begin(), hands.end(), [&](const HandsRecord& h) { return h.trial == trial; });
    if (own == hands.end()) return stored;
    stored.hands = *own;
    stored.inputs = wholeInputs(replay_.session, trial, stored.has_all_inputs);
    return stored;
  }

  FingerHost hostOf(const StoredStudyTrial& stored) const {
    FingerHost host;
    if (stored.hands && !stored.inputs.empty())
      host.finger = [&stored](const FingerPlace&) {
        return std::make_unique<RecordedFinger>(*stored.hands, stored.inputs);
      };
    if (replay_.run) host.serve = [this](FingerTrial& trial, const TrialPlace&) { return replay_.run(trial); };
    return host;
  }

  const StudyReplay& replay_;
  ReplayResult& result_;
  std::unique_ptr<Experiment> study_;
  std::vector<ResponseRecord> responses_;
};

// The study's own word on each trial.
class StudyRows final : public StudySink {
 public:
  explicit StudyRows(ReplayedStudy& study, const StudyReplay& replay) : study_(study), replay_(replay) {}
  void sample(const SampleRecord&) override {}
  void event(const EventRecord&) override {}
  void response(const ResponseRecord& response) override {
    study_.compare(response);
    if (replay_.progress) replay_.progress(response.trial + 1, static_cast<std::int64_t>(study_.answers()));
  }

 private:
  ReplayedStudy& study_;
  const StudyReplay& replay_;
};

}  // namespace

std::vector<InputRecord> wholeInputs(const SessionReader& session, std::int64_t trial, bool& all) {
  std::vector<InputRecord> inputs = session.inputs(trial);
  std::size_t whole = 0;
  while (whole < inputs.size() && inputs[whole].tick == static_cast<std::int64_t>(whole)) ++whole;
  all = whole == inputs.size();
  inputs.resize(whole);
  return inputs;
}

void replayStudy(const StudyReplay& replay, ReplayResult& result) {
  ReplayedStudy study(replay, result);
  const bool has_cut_short = !replay.simulated && replay.session.hands().size() > study.answers();
  const bool known =
      !replay.trial || *replay.trial < static_cast<std::int64_t>(study.answers() + (has_cut_short ? 1 : 0));
  if ((study.answers() == 0 && !has_cut_short) || !known) {
    throw InputError(fmt::format("{}: holds no finished trial{}. `pincer report` lists them.", replay.session.path(),
                                 replay.trial ? fmt::format(" {}", *replay.trial + 1) : ""));
  }
  StudyRows rows(study, replay);
  runStudy(study, replay.session.info().seed, {}, rows, replay.interrupted);
}

}  // namespace pincer::tasks
