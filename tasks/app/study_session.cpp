#include "tasks/app/study_session.h"

namespace pincer::tasks {
namespace {

class StudyFileSink final : public StudySink {
 public:
  explicit StudyFileSink(SessionWriter& writer) : writer_(writer) {}
  void sample(const SampleRecord& sample) override { writer_.pushSample(sample); }  // a lost one is counted by the store
  void event(const EventRecord& event) override { writer_.addEvent(event); }
  void response(const ResponseRecord& response) override { writer_.finishResponse(response); }

 private:
  SessionWriter& writer_;
};

}  // namespace

StudyOutcome runStudySession(Experiment& experiment, const StudySession& session, const std::atomic<bool>& interrupted,
                             const std::function<void(const StudyProgress&)>& progress) {
  SessionOptions store;
  store.block_when_full = !session.real_time;
  const std::vector<ResponseRecord> earlier = session.resume ? SessionReader(session.path).responses() : std::vector<ResponseRecord>();
  SessionWriter writer =
      session.resume ? SessionWriter::resume(session.path, store) : SessionWriter::create(session.path, session.info, store);
  StudyFileSink sink(writer);
  const StudyOutcome outcome = runStudy(experiment, session.info.seed, earlier, sink, interrupted, progress);
  if (outcome.interrupted) {
    writer.abort("interrupted by the user");
  } else {
    writer.close();
  }
  return outcome;
}

}  // namespace pincer::tasks
