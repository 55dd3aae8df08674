#include "pincer/tasks/lab/experiments/hand_records.h"

#include <algorithm>
#include <limits>

#include "pincer/engine/state.h"
#include "pincer/tasks/run/session/columns.h"

namespace pincer::tasks {
namespace {

enum FingerFlag : std::int32_t { kTouching = 1, kSliding = 2, kGateTripped = 4, kTactorParked = 8 };

std::array<double, 3> toArray(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
std::array<double, 2> toArray(const Vec2& v) { return {v.x(), v.y()}; }

FingerRecord fingerRecord(const TickState& state, const TickScratch& scratch, const FingerInputs& inputs, std::size_t i) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const grasp::FingerReport& report = scratch.fingers[i];
  const FingerOutputs& output = scratch.outputs[i];
  FingerRecord record;
  record.p_WF = toArray(state.mounts[i].p_WF);
  record.p_WP = toArray(state.grasp.world.points[i].p_W);
  record.f_contact_W = toArray(report.f_contact_W);
  record.f_arm_D = toArray(output.f_D);
  record.normal_force = report.normal_force;
  record.tangential_force = report.tangential_force;
  record.gap = report.gap;
  record.place_wanted_L = toArray(output.tactile.place_L);
  record.place_shown_L = {kUnknown, kUnknown};
  if (inputs.tactile.valid && inputs.tactile.place_L) record.place_shown_L = toArray(*inputs.tactile.place_L);
  record.flags = (report.touching ? kTouching : 0) | (report.sliding ? kSliding : 0) |
                 (state.mounts[i].gate.trip != devices::Trip::kNone ? kGateTripped : 0) | (output.tactile.parked ? kTactorParked : 0);
  return record;
}

Vec3 toVector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
std::array<double, 4> toArray(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

// What is there is kept, and a flag that it was.
template <class Value, class Kept>
void keep(const std::optional<Value>& value, FingerInputRecord::Flag flag, Kept& kept, FingerInputRecord& record) {
  if (!value) return;
  record.flags |= flag;
  if constexpr (std::is_same_v<Value, Mat3>) {
    std::copy(value->data(), value->data() + value->size(), kept.begin());
  } else if constexpr (std::is_arithmetic_v<Value>) {
    kept = *value;
  } else {
    kept = toArray(*value);
  }
}

FingerInputRecord fingerInputRecord(const FingerInputs& inputs, const FingerOutputs& output) {
  using Record = FingerInputRecord;
  Record record;
  record.flags = (inputs.arm.valid ? Record::kValid : 0u) | (inputs.arm.gave_up ? Record::kGaveUp : 0u) |
                 (inputs.tactile.valid ? Record::kTactileValid : 0u);
  record.arm_time = inputs.arm.time;
  record.p_DF = toArray(inputs.arm.p_DF);
  keep(inputs.arm.v_DF, Record::kVelocity, record.v_DF, record);
  keep(inputs.arm.q_DF, Record::kOrientation, record.q_DF, record);
  keep(inputs.arm.switches, Record::kSwitches, record.switches, record);
  keep(inputs.arm.J, Record::kJacobian, record.J, record);
  record.tactile_time = inputs.tactile.time;
  keep(inputs.tactile.place_L, Record::kTactilePlace, record.place_shown_L, record);
  record.f_arm_D = toArray(output.f_D);
  record.place_wanted_L = toArray(output.tactile.place_L);
  return record;
}

}  // namespace

InputRecord inputRecord(const HandScene& scene, const TickState& state, const TickScratch& scratch,
                        const std::vector<FingerInputs>& samples, const HandIntent& intent) {
  InputRecord record;
  record.phase = static_cast<std::uint32_t>(intent.phase);
  record.flags = (intent.wants_lift ? InputRecord::kWantsLift : 0u) | (intent.answers ? InputRecord::kAnswers : 0u);
  for (std::size_t i = 0; i < record.fingers.size(); ++i) record.fingers[i] = fingerInputRecord(samples[i], scratch.outputs[i]);
  const Pose X_WB = engine::bodyPose(scene.model.grasp.world, state.grasp.world, scene.object);
  record.p_WB = toArray(X_WB.p);
  record.q_WB = toArray(X_WB.q);
  record.v_WB = toArray(state.grasp.world.bodies[static_cast<std::size_t>(scene.object)].v_W);
  return record;
}

FingerInputs samplesOf(const FingerInputRecord& record) {
  using Record = FingerInputRecord;
  const auto has = [&](Record::Flag flag) { return (record.flags & flag) != 0; };
  FingerInputs inputs;
  inputs.arm.time = record.arm_time;
  inputs.arm.valid = has(Record::kValid);
  inputs.arm.gave_up = has(Record::kGaveUp);
  inputs.arm.p_DF = toVector(record.p_DF);
  if (has(Record::kVelocity)) inputs.arm.v_DF = toVector(record.v_DF);
  if (has(Record::kOrientation)) inputs.arm.q_DF = Quat(record.q_DF[0], record.q_DF[1], record.q_DF[2], record.q_DF[3]);
  if (has(Record::kSwitches)) inputs.arm.switches = record.switches;
  if (has(Record::kJacobian)) inputs.arm.J = Eigen::Map<const Mat3>(record.J.data());
  inputs.tactile.time = record.tactile_time;
  inputs.tactile.valid = has(Record::kTactileValid);
  if (has(Record::kTactilePlace)) inputs.tactile.place_L = Vec2(record.place_shown_L[0], record.place_shown_L[1]);
  return inputs;
}

HandIntent intentOf(const InputRecord& record) {
  HandIntent intent;
  static_assert(columns::kLastPhase == kHandPhases - 1 && columns::kLastTrip == static_cast<double>(devices::Trip::kOperator));
  intent.phase = static_cast<HandPhase>(record.phase);
  intent.wants_lift = (record.flags & InputRecord::kWantsLift) != 0;
  intent.answers = (record.flags & InputRecord::kAnswers) != 0;
  return intent;
}

SampleRecord sampleRecord(const HandScene& scene, const TickState& state, const TickScratch& scratch,
                          const std::vector<FingerInputs>& samples) {
  SampleRecord record;
  const Pose X_WB = engine::bodyPose(scene.model.grasp.world, state.grasp.world, scene.object);
  record.p_WB = toArray(X_WB.p);
  record.q_WB = toArray(X_WB.q);
  record.v_WB = toArray(state.grasp.world.bodies[static_cast<std::size_t>(scene.object)].v_W);
  const std::size_t fingers = std::min(samples.size(), record.fingers.size());
  for (std::size_t i = 0; i < fingers; ++i) record.fingers[i] = fingerRecord(state, scratch, samples[i], i);
  return record;
}

}  // namespace pincer::tasks
