#include "tasks/app/pickup_session.h"

#include <fmt/format.h>

#include <cmath>

#include "contact/error.h"
#include "tasks/app/json_writer.h"
#include "tasks/session/session_store.h"

namespace pincer::tasks {
namespace {

class SessionSink final : public RecordSink {
 public:
  // Keeps every `stride`-th tick.
  SessionSink(SessionWriter& writer, std::int64_t stride) : writer_(writer), stride_(stride) {}
  bool wantsSample(std::int64_t tick) const override { return tick % stride_ == 0; }
  void sample(const SampleRecord& sample) override { writer_.pushSample(sample); }  // a lost one is counted by the store
  void event(const EventRecord& event) override { writer_.addEvent(event); }
  void reading(const ReadingRecord& reading) override { writer_.addReading(reading); }
  void trial(const TrialRecord& trial) override { writer_.finishTrial(trial); }

 private:
  SessionWriter& writer_;
  const std::int64_t stride_;
};

void writeObject(const SpherePickupOptions& o, JsonWriter& json) {
  if (o.object) {
    json.key("file").value(o.object->path);
    json.key("shading").value(std::string(contact::kSurfaceVariantNames[static_cast<std::size_t>(o.object->shading)]));
    o.object->size ? json.key("size").value(*o.object->size) : json.key("units").value(o.object->units);
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

std::string devicesJson(const PickupSessionOptions& o) {
  JsonWriter json;
  const char* what = o.live.devices != nullptr ? "real" : "simulated";
  json.beginObject().key("arms").value(what).key("tactile_displays").value(what).key("rate").value(o.servo.rate);
  return json.key("sample_rate").value(o.sample_rate).key("real_time").value(o.servo.real_time).endObject().text();
}

SessionInfo sessionInfo(const PickupSessionOptions& o) {
  return {"sphere-pickup",
          o.study.seed,
          PINCER_VERSION,
          "compiler " __VERSION__,
          sceneJson(o.study),
          protocolJson(o.study),
          devicesJson(o),
          "",
          ""};
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

void validate(const PickupSessionOptions& options) {
  validate(options.study);
  const int rate = options.sample_rate;
  if (rate >= 1 && rate <= 1000 && std::fmod(options.servo.rate, rate) == 0) return;
  throw InputError(
      fmt::format("sphere-pickup: sample_rate = {} is out of range: an integer in [1, 1000] Hz that divides the {:g} ticks of a "
                  "second. Take for example 1000, 500, 200 or 100.",
                  rate, options.servo.rate));
}

PickupSessionResult runPickupSession(const PickupSessionOptions& options, const std::string& path, const std::atomic<bool>& interrupted,
                                     const std::function<void(const PickupProgress&)>& progress) {
  validate(options);
  SessionOptions store;
  store.block_when_full = !options.servo.real_time;
  SessionWriter writer = SessionWriter::create(path, sessionInfo(options), store);
  SessionSink sink(writer, std::lround(options.servo.rate) / options.sample_rate);
  PickupSessionResult result;
  const auto served = [&](const ServoReport& trial) { result.servo.add(trial); };
  result.trials = options.live.devices != nullptr
                      ? runLivePickupStudy(options.study, options.servo, sink, options.live, interrupted, progress, served)
                      : runPickupStudy(options.study, options.servo, sink, interrupted, progress, served);
  result.interrupted = result.servo.interrupted;
  if (result.interrupted) {
    writer.abort("interrupted by the user");
  } else {
    writer.close();
  }
  return result;
}

}  // namespace pincer::tasks
