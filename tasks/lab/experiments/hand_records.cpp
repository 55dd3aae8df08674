#include "pincer/tasks/lab/experiments/hand_records.h"

#include <algorithm>
#include <limits>

#include "pincer/engine/state.h"
#include "pincer/tasks/run/session/columns.h"

namespace pincer::tasks {
namespace {

std::array<double, 3> toArray(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
std::array<double, 2> toArray(const Vec2& v) { return {v.x(), v.y()}; }

FingerRecord fingerRecord(const TickState& state, const TickScratch& scratch, const FingerInputs& inputs,
                          std::size_t i) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // NaN: not measured
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
                 (state.mounts[i].gate.trip != devices::Trip::kNone ? kGateTripped : 0) |
                 (output.tactile.parked ? kTactorParked : 0);
  return record;
}

std::array<double, 4> toArray(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace

InputRecord inputRecord(const HandScene& scene, const TickState& state, const TickScratch& scratch,
                        const std::vector<FingerInputs>& samples, const HandIntent& intent) {
  InputRecord record;
  record.phase = static_cast<std::uint32_t>(intent.phase);
  record.flags = (intent.wants_lift ? InputRecord::kWantsLift : 0u) | (intent.answers ? InputRecord::kAnswers : 0u);
  for (std::size_t i = 0; i < record.fingers.size(); ++i)
    record.fingers[i] = fingerInputRecord(samples[i], scratch.outputs[i]);
  const Pose X_WB = engine::bodyPose(scene.model.grasp.world, state.grasp.world, scene.object);
  record.p_WB = toArray(X_WB.p);
  record.q_WB = toArray(X_WB.q);
  record.v_WB = toArray(state.grasp.world.bodies[static_cast<std::size_t>(scene.object)].v_W);
  return record;
}

HandIntent intentOf(const InputRecord& record) {
  HandIntent intent;
  static_assert(columns::kLastPhase == kHandPhases - 1 &&
                columns::kLastTrip == static_cast<double>(devices::Trip::kOperator));
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
