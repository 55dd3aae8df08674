#include "pincer/tasks/app/grasp_text.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/scene/sim_run.h"

namespace pincer::tasks {
namespace {

void writeBodies(const Simulation& simulation, JsonWriter& json) {
  json.key("bodies").beginArray();
  const Moment moment = simulation.moment();
  for (std::size_t i = 0; i < simulation.scene().bodies.size(); ++i) {
    const int body = static_cast<int>(i);
    const Pose X_WB = simulation.bodyPose(body);
    json.beginObject().key("name").value(simulation.scene().bodies[i].name);
    json.key("p_WB").value(X_WB.p).key("q_WB").value(X_WB.q).key("v_W").value(moment.state.world.bodies[i].v_W);
    json.key("w_W").value(engine::bodyAngularVelocity(moment.model.world, moment.state.world, body)).endObject();
  }
  json.endArray();
}

void writeFingers(const Simulation& simulation, JsonWriter& json) {
  json.key("fingers").beginArray();
  const Moment moment = simulation.moment();
  for (std::size_t i = 0; i < simulation.scene().fingers.size(); ++i) {
    const grasp::FingerReport& felt = moment.fingers[i];
    json.beginObject().key("name").value(simulation.scene().fingers[i].model.name);
    json.key("p_WP")
        .value(moment.state.world.points[i].p_W)
        .key("f_contact_W")
        .value(felt.f_contact_W)
        .key("f_user_W")
        .value(felt.f_user_W);
    json.key("normal_force").value(felt.normal_force).key("tangential_force").value(felt.tangential_force);
    json.key("touching").value(felt.touching).key("sliding").value(felt.sliding).endObject();
  }
  json.endArray();
}

// The rest of the object.
void writeHashExpectation(const Expectation& expected, const Outcome& outcome, JsonWriter& json) {
  json.key("time").value(expected.time).key("value").value(*expected.hash).key("because").value(expected.because);
  json.key("reached").value(outcome.reached);
  if (outcome.reached) json.key("measured").value(outcome.hash).key("ok").value(outcome.holds());
  json.endObject();
}

void writeExpectation(const Expectation& expected, const Outcome& outcome, JsonWriter& json) {
  json.beginObject().key("quantity").value(expected.quantity.name).key("unit").value(expected.quantity.kind->unit);
  if (expected.hash) return writeHashExpectation(expected, outcome, json);
  json.key("time");
  if (expected.tick == Expectation::kAlways) {
    json.value("always");
  } else {
    json.value(expected.time);
  }
  json.key("relation")
      .value(kRelationNames[static_cast<std::size_t>(expected.relation)])
      .key("value")
      .value(expected.value);
  json.key("tolerance").value(expected.tolerance);
  json.key("because").value(expected.because).key("reached").value(outcome.reached);
  if (outcome.reached) json.key("measured").value(outcome.measured).key("ok").value(outcome.holds());
  json.endObject();
}

void writeTimes(const SimResult& result, JsonWriter& json) {
  json.key("tick_us").beginObject().key("median").value(1e6 * result.times.quantile(0.5));
  json.key("p999")
      .value(1e6 * result.times.quantile(0.999))
      .key("max")
      .value(1e6 * result.times.quantile(1))
      .endObject();
}

void writeStatuses(const SimResult& result, JsonWriter& json) {
  json.key("status").beginObject();
  for (std::size_t i = 0; i < kStatusKinds.size(); ++i) json.key(kStatusKinds[i].key).value(result.statuses.of(i));
  json.endObject();
}

void writeOverlaps(const Simulation& simulation, const SimResult& result, JsonWriter& json) {
  const auto nameOf = [&](int body) { return simulation.scene().bodies[static_cast<std::size_t>(body)].name; };
  json.key("overlaps").beginArray();
  for (const StartOverlap& overlap : result.overlaps) {
    json.beginObject().key("bodies").beginArray().value(nameOf(overlap.a)).value(nameOf(overlap.b)).endArray();
    json.key("depth").value(overlap.depth).endObject();
  }
  json.endArray();
}

}  // namespace

std::string simJson(const Simulation& simulation, const SimOptions& options, const SimResult& result) {
  JsonWriter json;
  json.beginObject()
      .key("scene")
      .value(simulation.scene().file)
      .key("description")
      .value(simulation.scene().description);
  json.key("time")
      .value(simulation.time())
      .key("ticks")
      .value(simulation.ticks())
      .key("interrupted")
      .value(result.interrupted);
  if (options.timing) writeTimes(result, json);
  writeStatuses(result, json);
  writeOverlaps(simulation, result, json);
  json.key("state_hash").value(hashText(simulation.state().world));
  writeBodies(simulation, json);
  writeFingers(simulation, json);
  if (options.grasp) writeGrasps(simulation, json);
  json.key("recorded").beginObject();
  for (const Quantity& q : simulation.scene().record.quantities) json.key(q.name).value(q.measure(simulation.moment()));
  json.endObject();
  json.key("expectations").beginArray();
  for (std::size_t i = 0; i < result.log.expectations().size(); ++i) {
    writeExpectation(result.log.expectations()[i], result.log.outcomes()[i], json);
  }
  json.endArray().key("ok").value(!result.log.anyFailed() && !result.broke);
  return json.endObject().text();
}

}  // namespace pincer::tasks
