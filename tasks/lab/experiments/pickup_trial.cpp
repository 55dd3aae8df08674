#include "pincer/tasks/lab/experiments/pickup_trial.h"

#include "pincer/engine/state.h"
#include "pincer/tasks/lab/experiments/hand_hints.h"

namespace pincer::tasks {
namespace {

PickupRules rulesOf(const SpherePickupOptions& options) {
  PickupRules rules;
  rules.success_height = options.success_height;
  rules.hold_time = options.hold_time;
  rules.timeout = options.timeout;
  return rules;
}

TrialHead headOf(const PickupTrialSpec& spec) {
  return {"sphere-pickup", spec.trial, spec.participant, spec.index, spec.condition.name, spec.training};
}

}  // namespace

PickupTrial::PickupTrial(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec,
                         RecordSink& sink)
    : HandTrial(makePickupScene(options, object, spec), headOf(spec), sink),
      spec_(spec),
      smallest_grip_(options.mass * 9.81 / (2 * spec.mu_s)),
      rules_(rulesOf(options)),
      judge_(rules_) {}

TrialVerdict PickupTrial::judge(const HandIntent& intent, double time) {
  if (intent.reading && std::string_view(intent.reading->kind) == "grip") {
    felt_grip_ = intent.reading->percept.x();
    true_grip_ = gripTruth().x();
  }
  const PickupCounts before = judge_.counts();
  const PickupView seen = view(intent.wants_lift, time);
  clearance_ = seen.clearance;
  const TrialVerdict verdict = judge_.observe(seen);
  noteCounts(before);
  return verdict;
}

void PickupTrial::noteCounts(const PickupCounts& before) {
  const PickupCounts& after = judge_.counts();
  if (after.squeezes > before.squeezes) note("squeeze");
  if (after.lifts > before.lifts) note("lift");
  if (after.tries_5mm > before.tries_5mm) note("try_5mm");
  if (after.slips > before.slips) note("slip");
  if (after.drops > before.drops) note("drop");
  if (after.failures > before.failures) note("failure", after.last_failure);
}

PickupView PickupTrial::view(bool wants_lift, double time) {
  PickupView view;
  view.time = time;
  view.wants_lift = wants_lift;
  const engine::WorldModel& model = scene().model.grasp.world;
  const engine::WorldState& world = state().grasp.world;
  const engine::BodyState& object = world.bodies[kObjectBody];
  const Vec3 w_WB = engine::bodyAngularVelocity(model, world, kObjectBody);
  for (std::size_t i = 0; i < view.fingers.size(); ++i) {
    const grasp::FingerReport& finger = scratch().fingers[i];
    const bool on_object = finger.touching && finger.body == kObjectBody;
    const Vec3 v_W = world.points[i].v_W - object.v_W - w_WB.cross(finger.p_WC - object.X_WI.p);
    const double slide_speed = (v_W - v_W.dot(finger.n_W) * finger.n_W).norm();
    view.fingers[i] = {on_object, finger.sliding, on_object ? finger.normal_force : 0, slide_speed, finger.p_WC};
  }
  view.p_WBcm = object.X_WI.p;
  view.clearance = clearanceOverDish(scene(), engine::bodyPose(model, world, kObjectBody), *patches_);
  return view;
}

HandGuide PickupTrial::taskGuide() const {
  // Of the half width: so far over its middle a sphere may be pinched, and so far below it the fingers may stand. The
  // dish rises to the sides, where open fingers touch it; as they close they slide down to where they are wanted.
  constexpr double kPinchUp = 0.15, kTooLow = 0.1;
  HandGuide guide;
  const Vec3& middle_W = state().grasp.world.bodies[kObjectBody].X_WI.p;
  guide.goal_height = middle_W.z() - clearance_ + rules_.success_height;
  const bool pinches = touchesObject(0) && touchesObject(1);
  const double half_width = scene().cues.half_width;
  const char* reach =
      reachHint({state().mounts[0].p_WF, state().mounts[1].p_WF, middle_W, half_width, kPinchUp * half_width});
  const double above = 0.5 * (state().mounts[0].p_WF.z() + state().mounts[1].p_WF.z()) - middle_W.z();
  if (touchesGround() && above < -kTooLow * half_width) {
    guide.hint = "Too low: a finger touches the dish. Up a little";
  } else if (clearance_ >= rules_.success_height) {
    guide.hint = "Hold it there for a second";
  } else if (pinches) {
    guide.hint = "Lift it to the line";
  } else if (*reach) {
    guide.hint = reach;
  } else {
    guide.hint = touchesObject(0) || touchesObject(1) ? "One finger touches: go the other way a little"
                                                      : "Squeeze: hold the left button, or G";
  }
  return guide;
}

Vec3 PickupTrial::truthOf(const HandReading& reading) const {
  return std::string_view(reading.kind) == "grip" ? gripTruth() : placeTruth();
}

void PickupTrial::fill(TrialRecord& row) const {
  const PickupCounts& counts = judge_.counts();
  row.mu_s = spec_.mu_s;
  row.mu_d = spec_.mu_d;
  row.squeezes = counts.squeezes;
  row.lifts = counts.lifts;
  row.tries_5mm = counts.tries_5mm;
  row.slips = counts.slips;
  row.drops = counts.drops;
  row.cause = counts.last_failure;
  row.peak_grip = counts.peak_grip;
  row.grip_ratio = counts.held_grip / smallest_grip_;
  row.offset_at_squeeze = counts.offset_at_squeeze;
  row.felt_grip = felt_grip_;
  row.true_grip = true_grip_;
}

}  // namespace pincer::tasks
