#include "pincer/tasks/lab/sessions/study_session.h"

#include <new>

#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/session/build_info.h"

namespace pincer::tasks {
namespace {

class StudyFileSink final : public StudySink {
 public:
  // `inputs`: of every tick too, of a finger that nothing else can bring back.
  StudyFileSink(SessionWriter& writer, bool inputs) : writer_(writer), inputs_(inputs) {}
  bool wantsInputs() const override { return inputs_; }
  void hands(const HandsRecord& hands) override { writer_.addHands(hands); }
  // a lost one is a gap in the ticks, which a replay names
  void input(const InputRecord& input) override { writer_.pushInput(input); }
  // a lost one is counted by the store
  void sample(const SampleRecord& sample) override { writer_.pushSample(sample); }
  void event(const EventRecord& event) override { writer_.addEvent(event); }
  void response(const ResponseRecord& response) override { writer_.finishResponse(response); }

 private:
  SessionWriter& writer_;
  const bool inputs_;
};

// Asks people what the study has for this moment. False: the person has left.
bool askSurvey(const Experiment& experiment, const StudySession& session, const std::string& moment,
               SessionWriter& writer) {
  if (!session.host.ask) return true;
  const SurveyPlan& plan = experiment.plan();
  const SurveyForm form{
      questionsOf(moment == "before" ? plan.demographics : plan.survey, {session.info.task}, experiment.conditions()),
      moment, session.host.person.value_or(0)};
  return fillForm(form, SessionReader(session.path).survey(), session.host.ask,
                  [&](const SurveyRecord& answer) { writer.addSurvey(answer); });
}

}  // namespace

SessionInfo studySessionInfo(const std::string& task, std::uint64_t seed, const std::string& protocol_json,
                             const std::string& participants_json, const ServoOptions& servo, int sample_rate,
                             const std::string& devices) {
  SessionInfo info;
  info.task = task;
  info.seed = seed;
  tellBuild(info);
  info.protocol_json = protocol_json;
  info.participants_json = participants_json;
  info.participants_hash = fingerprint(participants_json);
  JsonWriter json;
  const bool simulated = devices == "simulated" || devices == "mouse";
  json.beginObject()
      .key("arms")
      .value(devices)
      .key("tactile_display")
      .value(simulated ? "simulated 1-DOF" : devices.c_str());
  json.key("rate").value(servo.rate);
  info.devices_json = json.key("sample_rate")
                          .value(sample_rate)
                          .key("real_time")
                          .value(servo.clock != ServoClock::kVirtual)
                          .endObject()
                          .text();
  return info;
}

StudyOutcome runStudySession(Experiment& experiment, const StudySession& session, const std::atomic<bool>& interrupted,
                             const std::function<void(const StudyProgress&)>& progress) {
  SessionOptions store;
  store.block_when_full = session.waits;
  SessionWriter writer = session.resume ? SessionWriter::resume(session.path, store)
                                        : SessionWriter::create(session.path, session.info, store);
  const std::vector<ResponseRecord> earlier =
      session.resume ? SessionReader(session.path).responses() : std::vector<ResponseRecord>();
  experiment.serveWith(session.host);
  StudyFileSink sink(writer, session.host.isPersons());
  try {
    const auto ask = [&](const char* moment) { return askSurvey(experiment, session, moment, writer); };
    StudyOutcome outcome;
    outcome.interrupted = !ask("before");
    if (!outcome.interrupted) outcome = runStudy(experiment, session.info.seed, earlier, sink, interrupted, progress);
    if (!outcome.interrupted) outcome.interrupted = !ask("after");
    if (!outcome.interrupted && session.host.show) session.host.show({"That was all", {"Thank you."}});
    outcome.interrupted ? writer.abort("interrupted by the user") : writer.close();
    outcome.samples_hash = writer.samplesHash();
    return outcome;
  } catch (const std::bad_alloc&) {
    writer.abort("not enough memory");
    throw;
  }
}

}  // namespace pincer::tasks
