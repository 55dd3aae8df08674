#include "pincer/tasks/lab/finger/finger_records.h"

#include <algorithm>
#include <cmath>

namespace pincer::tasks {
namespace {

std::array<double, 3> tripleOf(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
std::array<double, 2> pairOf(const Vec2& v) { return {v.x(), v.y()}; }
Vec3 vec3Of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

void keepValue(const Vec3& value, std::array<double, 3>& kept) { kept = tripleOf(value); }
void keepValue(const Vec2& value, std::array<double, 2>& kept) { kept = pairOf(value); }
void keepValue(const Quat& q, std::array<double, 4>& kept) { kept = {q.w(), q.x(), q.y(), q.z()}; }
void keepValue(const Mat3& J, std::array<double, 9>& kept) { std::copy(J.data(), J.data() + J.size(), kept.begin()); }
void keepValue(std::uint32_t value, std::uint32_t& kept) { kept = value; }

// Keeps a value that is there, and a flag that it was.
template <class Value, class Kept>
void keep(const std::optional<Value>& value, FingerInputRecord::Flag flag, Kept& kept, FingerInputRecord& record) {
  if (!value) return;
  record.flags |= flag;
  keepValue(*value, kept);
}

}  // namespace

FingerInputRecord fingerInputRecord(const FingerInputs& inputs, const FingerOutputs& output) {
  using Record = FingerInputRecord;
  Record record;
  record.flags = (inputs.arm.valid ? Record::kValid : 0u) | (inputs.arm.gave_up ? Record::kGaveUp : 0u) |
                 (inputs.tactile.valid ? Record::kTactileValid : 0u);
  record.arm_time = inputs.arm.time;
  record.p_DF = tripleOf(inputs.arm.p_DF);
  keep(inputs.arm.v_DF, Record::kVelocity, record.v_DF, record);
  keep(inputs.arm.q_DF, Record::kOrientation, record.q_DF, record);
  keep(inputs.arm.switches, Record::kSwitches, record.switches, record);
  keep(inputs.arm.J, Record::kJacobian, record.J, record);
  record.tactile_time = inputs.tactile.time;
  keep(inputs.tactile.place_L, Record::kTactilePlace, record.place_shown_L, record);
  record.f_arm_D = tripleOf(output.f_D);
  record.place_wanted_L = pairOf(output.tactile.place_L);
  return record;
}

FingerInputs samplesOf(const FingerInputRecord& record) {
  using Record = FingerInputRecord;
  const auto has = [&](Record::Flag flag) { return (record.flags & flag) != 0; };
  FingerInputs inputs;
  inputs.arm.time = record.arm_time;
  inputs.arm.valid = has(Record::kValid);
  inputs.arm.gave_up = has(Record::kGaveUp);
  inputs.arm.p_DF = vec3Of(record.p_DF);
  if (has(Record::kVelocity)) inputs.arm.v_DF = vec3Of(record.v_DF);
  if (has(Record::kOrientation)) inputs.arm.q_DF = Quat(record.q_DF[0], record.q_DF[1], record.q_DF[2], record.q_DF[3]);
  if (has(Record::kSwitches)) inputs.arm.switches = record.switches;
  if (has(Record::kJacobian)) inputs.arm.J = Eigen::Map<const Mat3>(record.J.data());
  inputs.tactile.time = record.tactile_time;
  inputs.tactile.valid = has(Record::kTactileValid);
  if (has(Record::kTactilePlace)) inputs.tactile.place_L = Vec2(record.place_shown_L[0], record.place_shown_L[1]);
  return inputs;
}

HandsRecord::Finger handsRecordOf(const FingerWear& wear) {
  HandsRecord::Finger kept;
  kept.base_offset_W = tripleOf(wear.base.offset_W);
  kept.base_turn = wear.base.turn;
  kept.peak_force = wear.arm.peak_force;
  kept.continuous_force = wear.arm.continuous_force;
  if (wear.arm.peak_torque) kept.peak_torque = tripleOf(*wear.arm.peak_torque);
  kept.tip_mass = wear.arm.tip_mass.value_or(HandsRecord::kNone);
  kept.tip_damping = wear.arm.tip_damping;
  return kept;
}

devices::ArmCapabilities capabilitiesOf(const HandsRecord::Finger& finger) {
  devices::ArmCapabilities arm;
  arm.peak_force = finger.peak_force;
  arm.continuous_force = finger.continuous_force;
  if (!std::isnan(finger.peak_torque[0])) arm.peak_torque = vec3Of(finger.peak_torque);
  if (!std::isnan(finger.tip_mass)) arm.tip_mass = finger.tip_mass;
  if (!std::isnan(finger.tip_damping)) arm.tip_damping = finger.tip_damping;
  return arm;
}

}  // namespace pincer::tasks
