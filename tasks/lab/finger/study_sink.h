// study_sink: where an experiment with one finger leaves its records. The session store stands behind it
// in a session; a test keeps them in memory.
#pragma once
#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

class StudySink {
 public:
  virtual ~StudySink() = default;
  // of this tick: a sample that nobody keeps needn't be made
  virtual bool wantsSample(std::int64_t) const { return true; }
  virtual bool wantsInputs() const { return false; }    // of every tick: a finger that nothing else can bring back
  virtual void hands(const HandsRecord&) {}             // before the first tick of a trial whose inputs are wanted
  virtual void input(const InputRecord&) {}             // from the tick, before its sample: must not block in real time
  virtual void sample(const SampleRecord& sample) = 0;  // from the tick: must not block in real time
  virtual void event(const EventRecord& event) = 0;     // after a trial, before its response()
  virtual void response(const ResponseRecord& response) = 0;  // after a trial; durable on return
};

}  // namespace pincer::tasks
