#include "pincer/tasks/lab/experiments/cylinder_trial.h"

#include "pincer/engine/state.h"
#include "pincer/tasks/lab/experiments/hand_hints.h"

namespace pincer::tasks {
namespace {

// cosine, 1.1 degrees: the flat's normal is the contact's; on the round part none is so near for long
constexpr double kOnFlat = 0.9998;

TrialHead headOf(const CylinderTrialSpec& spec) {
  return {"cylinder-alignment", spec.trial, spec.participant, spec.index, spec.condition.name, spec.training};
}

CylinderRules rulesOf(const CylinderAlignmentOptions& options) {
  CylinderRules rules;
  rules.timeout = options.timeout;
  return rules;
}

HandScene checkedScene(const CylinderAlignmentOptions& options, const CylinderTrialSpec& spec) {
  validate(options);
  return makeCylinderScene(options, spec);
}

}  // namespace

CylinderTrial::CylinderTrial(const CylinderAlignmentOptions& options, const CylinderTrialSpec& spec, RecordSink& sink)
    : HandTrial(checkedScene(options, spec), headOf(spec), sink),
      spec_(spec),
      rules_(rulesOf(options)),
      judge_(rules_) {}

double CylinderTrial::angle() const {
  return flatAngle(engine::bodyPose(scene().model.grasp.world, state().grasp.world, scene().object));
}

TrialVerdict CylinderTrial::judge(const HandIntent& intent, double time) {
  CylinderView view;
  view.time = time;
  view.answers = intent.answers;
  const double theta = angle();
  view.error = wrapAngle(theta - kTargetAngle);
  const Vec3 flat_W(math::cos(theta), math::sin(theta), 0);
  for (std::size_t i = 0; i < view.normal_forces.size(); ++i) {
    const grasp::FingerReport& finger = scratch().fingers[i];
    const bool on_object = finger.touching && finger.body == scene().object;
    view.normal_forces[i] = on_object ? finger.normal_force : 0;
    view.on_flat = view.on_flat || (on_object && finger.n_W.dot(flat_W) > kOnFlat);
  }
  const std::int64_t turning_grips = judge_.counts().turning_grips;
  const TrialVerdict verdict = judge_.observe(view);
  if (judge_.counts().turning_grips > turning_grips) note("turn");
  if (verdict == TrialVerdict::kSuccess) note("answer");
  return verdict;
}

void CylinderTrial::fill(TrialRecord& row) const {
  const CylinderCounts& counts = judge_.counts();
  row.start_angle = spec_.start_angle;
  row.error = counts.error;
  row.regrasps = counts.regrasps();
  row.flat_time = counts.flat_time;
}

HandGuide CylinderTrial::taskGuide() const {
  constexpr double kNear = 0.09;      // 5 degrees, at which nobody needs a hint [rad]
  constexpr double kPinchUp = 0.025;  // over its middle it may be pinched so far: its half length is 0.04 [m]
  HandGuide guide;
  guide.goal_heading = kTargetAngle;
  const double needed = wrapAngle(kTargetAngle - angle());
  const bool pinches = touchesObject(0) && touchesObject(1);
  const Vec3& middle_W = state().grasp.world.bodies[static_cast<std::size_t>(scene().object)].X_WI.p;
  const HandPlaces places{state().mounts[0].p_WF, state().mounts[1].p_WF, middle_W, scene().cues.flat_distance,
                          kPinchUp};
  const char* reach = pinches ? "" : reachHint(places);
  if (std::abs(needed) < kNear) {
    guide.hint = "The flat faces the monitor: Enter answers";
  } else if (touchesGround()) {
    guide.hint = "Too low: a finger touches the table. Up a little";
  } else {
    guide.hint = *reach ? reach : turnHint(handTurn(places), needed, pinches);
  }
  return guide;
}

Vec3 CylinderTrial::truthOf(const HandReading& reading) const {
  const std::string_view kind(reading.kind);
  if (kind == "grip") return gripTruth();
  if (kind == "place") return placeTruth();
  return {angle(), 0, 0};
}

}  // namespace pincer::tasks
