#include "tasks/app/pickup_session.h"

#include "tasks/app/json_writer.h"
#include "tasks/session/session_store.h"

namespace pincer::tasks {
namespace {

class SessionSink final : public RecordSink {
 public:
  explicit SessionSink(SessionWriter& writer) : writer_(writer) {}
  void sample(const SampleRecord& sample) override { writer_.pushSample(sample); }  // a lost one is counted by the store
  void event(const EventRecord& event) override { writer_.addEvent(event); }
  void trial(const TrialRecord& trial) override { writer_.finishTrial(trial); }

 private:
  SessionWriter& writer_;
};

void writeObject(const SpherePickupOptions& o, JsonWriter& json) {
  if (o.object) {
    json.key("file").value(o.object->path).key("units").value(o.object->units);
  } else {
    json.key("radius").value(o.radius);
  }
  json.key("mass").value(o.mass);
}

// What the world is made of.
std::string sceneJson(const SpherePickupOptions& o) {
  JsonWriter json;
  json.beginObject().key("object").beginObject();
  writeObject(o, json);
  json.endObject().key("dish_radius").value(o.dish_radius).key("dish_friction").value(o.dish_friction);
  json.key("finger_radius").value(o.finger_radius).key("torsion_radius").value(o.torsion_radius);
  json.key("coupling_stiffness").value(o.coupling_stiffness).key("coupling_damping").value(o.coupling_damping);
  return json.endObject().text();
}

std::string devicesJson(const ServoOptions& servo) {
  JsonWriter json;
  json.beginObject().key("arms").value("simulated").key("tactile_displays").value("simulated").key("rate").value(servo.rate);
  return json.key("real_time").value(servo.real_time).endObject().text();
}

SessionInfo sessionInfo(const SpherePickupOptions& options, const ServoOptions& servo) {
  return {"sphere-pickup",    options.seed,          PINCER_VERSION,    "compiler " __VERSION__,
          sceneJson(options), protocolJson(options), devicesJson(servo)};
}

}  // namespace

std::string protocolJson(const SpherePickupOptions& o) {
  JsonWriter json;
  json.beginObject().key("participants").value(o.participants).key("repetitions").value(o.repetitions).key("conditions").beginArray();
  for (const PickupCondition condition : o.conditions) json.value(nameOf(condition));
  json.endArray().key("mu_s").beginArray();
  for (const double mu : o.frictions) json.value(mu);
  json.endArray().key("dynamic_ratio").value(o.dynamic_ratio).key("success_height").value(o.success_height);
  return json.key("hold_time").value(o.hold_time).key("timeout").value(o.timeout).endObject().text();
}

PickupSessionResult runPickupSession(const SpherePickupOptions& options, const ServoOptions& servo, const std::string& path,
                                     const std::atomic<bool>& interrupted, const std::function<void(const PickupProgress&)>& progress) {
  validate(options);
  SessionOptions store;
  store.block_when_full = !servo.real_time;
  SessionWriter writer = SessionWriter::create(path, sessionInfo(options, servo), store);
  SessionSink sink(writer);
  PickupSessionResult result;
  result.trials = runPickupStudy(options, servo, sink, interrupted, progress);
  result.interrupted = interrupted.load();
  if (result.interrupted) {
    writer.abort("interrupted by the user");
  } else {
    writer.close();
  }
  return result;
}

}  // namespace pincer::tasks
