#include "pincer/tasks/lab/sessions/manipulation_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/findings/claims.h"
#include "pincer/tasks/lab/sessions/study_experiments.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/session/build_info.h"

namespace pincer::tasks {
namespace {

class StudySessionSink final : public RecordSink {
 public:
  // Keeps every `stride`-th tick; 0: none.
  // `inputs`: and the inputs of all, of hands that nothing else can bring back.
  StudySessionSink(SessionWriter& writer, std::int64_t stride, bool inputs)
      : writer_(writer), stride_(stride), inputs_(inputs) {}
  bool wantsInputs() const override { return inputs_; }
  void hands(const HandsRecord& hands) override { writer_.addHands(hands); }
  // a lost one is a gap in the ticks, which a replay names
  void input(const InputRecord& input) override { writer_.pushInput(input); }
  bool wantsSample(std::int64_t tick) const override { return stride_ > 0 && tick % stride_ == 0; }
  // a lost one is counted by the store
  void sample(const SampleRecord& sample) override { writer_.pushSample(sample); }
  void event(const EventRecord& event) override { writer_.addEvent(event); }
  void reading(const ReadingRecord& reading) override { writer_.addReading(reading); }
  void trial(const TrialRecord& trial) override { writer_.finishTrial(trial); }

 private:
  SessionWriter& writer_;
  const std::int64_t stride_;
  const bool inputs_;
};

std::string devicesJson(const ManipulationSessionOptions& o) {
  JsonWriter json;
  json.beginObject()
      .key("arms")
      .value(o.devices)
      .key("tactile_displays")
      .value(o.devices == "mouse" ? "simulated" : o.devices)
      .key("rate")
      .value(o.servo.rate);
  return json.key("sample_rate")
      .value(o.sample_rate)
      .key("real_time")
      .value(o.servo.clock != ServoClock::kVirtual)
      .endObject()
      .text();
}

std::size_t plannedTrials(const ManipulationSessionOptions& options) {
  const auto trials = manipulationTrials(options.study);
  const auto& person = options.host.person;
  return static_cast<std::size_t>(std::count_if(
      trials.begin(), trials.end(), [&](const ManipulationTrial& t) { return !person || t.participant() == *person; }));
}

// Asks people what the study has for this moment. False: the person has left.
bool askSurvey(const ManipulationSessionOptions& options, SessionWriter& writer, const std::string& path,
               const std::string& moment) {
  if (!options.host.ask || !options.host.person) return true;
  std::vector<std::string> tasks;
  for (const HandTask task : options.study.tasks) tasks.emplace_back(kHandTaskNames[static_cast<std::size_t>(task)]);
  const std::vector<NamedCondition> conditions = namedOf(options.study.conditions);
  const SurveyPlan& plan = options.study.session;
  const SurveyForm form{questionsOf(moment == "before" ? plan.demographics : plan.survey, tasks, conditions), moment,
                        *options.host.person};
  return fillForm(form, SessionReader(path).survey(), options.host.ask,
                  [&](const SurveyRecord& answer) { writer.addSurvey(answer); });
}

ManipulationSessionResult runInto(SessionWriter& writer, const std::string& path,
                                  const ManipulationSessionOptions& options, StudyHooks hooks,
                                  const std::atomic<bool>& interrupted) {
  const std::int64_t stride = options.sample_rate > 0 ? std::lround(options.servo.rate) / options.sample_rate : 0;
  StudySessionSink sink(writer, stride, static_cast<bool>(options.host.hands));
  ManipulationSessionResult result;
  hooks.host = options.host;
  hooks.served = [&](const ServoReport& trial) { result.servo.add(trial); };
  bool refused = false;  // the operator didn't switch the forces on
  if (hooks.host.arm) {
    hooks.host.arm = [&refused, ask = hooks.host.arm](const std::string& why) {
      refused = !ask(why);
      return !refused;
    };
  }
  try {
    bool left = !askSurvey(options, writer, path, "before");
    if (!left) result.trials = runManipulationStudy(options.study, options.servo, sink, interrupted, hooks);
    left = left || result.trials < plannedTrials(options);
    if (!left && !result.servo.interrupted) left = !askSurvey(options, writer, path, "after");
    refused = refused || (left && options.host.show);
  } catch (const std::bad_alloc&) {
    writer.abort("not enough memory");
    throw;
  }
  result.interrupted = result.servo.interrupted || refused;
  result.interrupted ? writer.abort("interrupted by the user") : writer.close();
  result.samples_hash = writer.samplesHash();
  return result;
}

std::set<std::int64_t> finishedTrials(const SessionReader& session, std::size_t planned) {
  std::set<std::int64_t> finished;
  for (const TrialRecord& trial : session.trials()) {
    requirePlanned(session, trial.trial, planned);
    finished.insert(trial.trial);
  }
  return finished;
}

SessionOptions storeOptions(const ServoOptions& servo) {
  SessionOptions store;
  store.block_when_full = servo.clock != ServoClock::kReal;
  return store;
}

}  // namespace

SessionInfo manipulationSessionInfo(const ManipulationSessionOptions& o) {
  SessionInfo info;
  info.task = taskName(o.study);
  info.seed = o.study.seed;
  tellBuild(info);
  info.protocol_json = studyFile(o.study);
  info.devices_json = devicesJson(o);
  info.participants_json = o.host.person ? personJson(*o.host.person) : describe(o.study.people);
  info.participants_hash = o.host.person ? fingerprint(info.participants_json) : hashOf(o.study.people);
  if (!o.claims.empty()) info.scene_json = claimsJson(o.claims);
  return info;
}

void requirePlanned(const SessionReader& session, std::int64_t trial, std::size_t planned) {
  if (trial >= 0 && trial < static_cast<std::int64_t>(planned)) return;
  throw InputError(
      fmt::format("{}: trial {} isn't one of its plan, which has trials 1 to {}. The file is damaged, or something "
                  "else than pincer "
                  "changed it. Take a copy of before.",
                  session.path(), trial + 1, planned));
}

void validate(const ManipulationSessionOptions& options) {
  validate(options.study);
  const int rate = options.sample_rate;
  if (rate == 0 || (rate >= 1 && rate <= 1000 && std::fmod(options.servo.rate, rate) == 0)) return;
  throw InputError(fmt::format(
      "run: sample_rate = {} is out of range: 0 for none, or an integer in [1, 1000] Hz that divides the {:g} "
      "ticks of a second. Take for example 1000, 500, 200 or 100.",
      rate, options.servo.rate));
}

ManipulationSessionResult runManipulationSession(const ManipulationSessionOptions& options, const std::string& path,
                                                 const std::atomic<bool>& interrupted,
                                                 const TrialProgressLine& progress) {
  validate(options);
  SessionWriter writer = SessionWriter::create(path, manipulationSessionInfo(options), storeOptions(options.servo));
  return runInto(writer, path, options, {{}, progress, {}, {}}, interrupted);
}

ManipulationSessionResult resumeManipulationSession(const ManipulationSessionOptions& wanted, const std::string& path,
                                                    const std::atomic<bool>& interrupted,
                                                    const TrialProgressLine& progress) {
  ManipulationSessionOptions options = wanted;
  const SessionInfo info = SessionReader(path).info();
  options.study = parseStudyFile(info.protocol_json, path + ": protocol");
  if (options.host.person) options.host.person = personOf(info).value_or(0);
  validate(options);
  SessionWriter writer = SessionWriter::resume(path, storeOptions(options.servo));
  StudyHooks hooks{{}, progress, {}, {}};
  hooks.finished = finishedTrials(SessionReader(path), manipulationTrials(options.study).size());
  return runInto(writer, path, options, hooks, interrupted);
}

}  // namespace pincer::tasks
