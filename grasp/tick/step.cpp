#include "pincer/grasp/step.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/driven_motion.h"
#include "pincer/grasp/tick/finger_contacts.h"
#include "pincer/grasp/tick/finger_tick.h"
#include "pincer/grasp/tick/followed_shapes.h"

namespace pincer::grasp {
namespace {

// The finger turns evenly from where it was at the end of the last tick.
void setRotation(const FingerInput& input, const FingerState& last, double h, engine::PointInput& point,
                 Quat& q_mid_WF) {
  PINCER_ASSERT(isUnitIfFinite(input.q_WF));
  q_mid_WF = input.q_WF;
  if (!last.seen || last.q_WF.coeffs() == input.q_WF.coeffs()) return;
  const Vec3 turn_W = engine::rotationVectorOf(input.q_WF * last.q_WF.conjugate());
  point.w_W = turn_W / h;
  q_mid_WF = quatFromRotationVector(0.5 * turn_W) * last.q_WF;
}

}  // namespace

void setInputs(const GraspModel& model, const GraspState& state, std::span<const FingerInput> inputs,
               GraspScratch& scratch) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    engine::PointInput& point = scratch.inputs[i];
    point.p_target_W = inputs[i].p_WF;
    point.v_target_W = inputs[i].v_WF;
    point.f_W = inputs[i].f_W;
    point.w_W.setZero();
    const engine::DrivenPointModel& coupling = model.fingers[i].coupling;
    const double h = model.world.options.h;
    setRotation(inputs[i], state.fingers[i], h, point, scratch.q_mid_WF[i]);
    if (coupling.turn_stiffness + coupling.turn_damping > 0) {
      const engine::PointState& s = state.world.points[i];
      scratch.q_mid_WF[i] =
          (quatFromRotationVector(s.turn_W + 0.5 * h * s.turn_rate_W) * scratch.q_mid_WF[i]).normalized();
    }
    point.turned = model.fingers[i].along_normal;
    const bool has_axis = point.turned || coupling.twist_stiffness + coupling.twist_damping > 0;
    point.n_W = has_axis ? state.fingers[i].n_W : Vec3(Vec3::UnitZ());
  }
}

FingersContacts contactsFrom(const GraspScratch& scratch, int finger) {
  const FingersContacts all = scratch.world.contacts;
  const auto less = [](const engine::Contact& c, std::uint64_t id) { return c.id < id; };
  // whatever it touches
  const std::uint64_t first_id = engine::contactId(0, {engine::SideKind::kPoint, 0, finger}, {}, 0);
  return {std::lower_bound(all.begin(), all.end(), first_id, less), all.end()};
}

FingersContacts firstOf(FingersContacts sorted, int finger) {
  const auto is_other = [&](const engine::Contact& c) {
    return c.a.kind != engine::SideKind::kPoint || c.a.index != finger;
  };
  return {sorted.begin(), std::find_if(sorted.begin(), sorted.end(), is_other)};
}

namespace {

// Angular impulse about the normal at the mean place that the contacts' forces make by being apart.
// Number by number: the place and the normal were written just before, and as vectors they would be waited for.
double momentOfPoints(FingersContacts contacts, const FingerReport& report) {
  const double px = report.p_WC.x(), py = report.p_WC.y(), pz = report.p_WC.z();
  const double nx = report.n_W.x(), ny = report.n_W.y(), nz = report.n_W.z();
  double moment = 0;
  for (const engine::Contact& c : contacts) {
    if (!c.active()) continue;
    const double x = c.p_W.x() - px, y = c.p_W.y() - py, z = c.p_W.z() - pz;
    const Vec3& f = c.impulse_W;
    moment += (nx * (y * f.z() - z * f.y()) + ny * (z * f.x() - x * f.z())) + nz * (x * f.y() - y * f.x());
  }
  return moment;
}

// Sums the contacts of one finger into its report; returns the way from its centre to their
// force-weighted mean place, or its direction.
Vec3 sumContacts(FingersContacts contacts, const Vec3& p_mid_W, double h, FingerReport& report) {
  Vec3 p_sum = Vec3::Zero(), n_sum = Vec3::Zero(), impulse_W = Vec3::Zero();
  double normal = 0, torsion = 0, largest = 0;  // impulses
  int pushing = 0;
  const engine::Contact* lead = nullptr;
  for (const engine::Contact& c : contacts) {
    if (!c.active()) continue;
    const double r_n = c.r[engine::kNormalRow];
    impulse_W += c.impulse_W;
    normal += r_n;
    if (engine::rowsOf(c.material) > engine::kTorsionRow)
      torsion += c.r[engine::kTorsionRow] * c.material.torsion_radius;
    report.sliding = report.sliding || c.sliding;
    p_sum += r_n * c.p_W;
    n_sum += r_n * c.n_W();
    ++pushing;
    if (!(r_n > largest)) continue;
    largest = r_n;
    lead = &c;
  }
  report.touching = normal > 0;
  if (!report.touching) return Vec3::Zero();
  report.body = lead->b.index;
  report.f_contact_W = impulse_W / h;
  report.normal_force = normal / h;
  report.tangential_force = (impulse_W - n_sum).norm() / h;
  report.torsion = torsion / h;
  const bool is_spread = pushing > 1;
  report.p_WC = is_spread ? Vec3(p_sum / normal) : lead->p_W;
  report.n_W = is_spread && n_sum.squaredNorm() > 0 ? Vec3(n_sum.normalized()) : lead->n_W();
  if (is_spread) report.torsion += momentOfPoints(contacts, report) / h;
  PINCER_ASSERT(isUnitIfFinite(report.n_W) && report.body >= 0);
  const Vec3 to_mean = report.p_WC - p_mid_W;
  return to_mean.squaredNorm() > 0 ? to_mean : Vec3(-report.n_W);
}

// Where the tick was cut, its last part doesn't speak for all of it: a landing in a short part would be felt as a blow.
void averageOverTick(const engine::PointScratch& point, double tick, FingerReport& report) {
  PINCER_ASSERT(tick > 0);
  report.f_contact_W = point.tick_impulse_W / tick;
  if (!report.touching) return;
  report.normal_force = std::max(report.f_contact_W.dot(report.n_W), 0.0);
  report.tangential_force = (report.f_contact_W - report.n_W * report.f_contact_W.dot(report.n_W)).norm();
}

// Place on the pad that is touched, or would be. All geometry is that of the middle of the tick.
void reportTouch(const GraspModel& model, int finger, const Vec3& touch_W, GraspScratch& scratch) {
  FingerReport& report = scratch.fingers[finger];
  const bool has_shape = model.fingers[finger].shape.has_value();
  const Quat& q_WF = scratch.q_mid_WF[finger];
  const Vec3 n_W = -scratch.nearest[finger].n_W;
  if (report.touching) {
    report.touch = {true, q_WF, has_shape ? Vec3(report.p_WC - scratch.world.points[finger].p_mid_W) : touch_W,
                    -report.n_W};
  } else if (!n_W.isZero(0)) {
    report.nearest = {true, q_WF, has_shape ? scratch.nearest[finger].d_W : n_W, n_W};
  }
}

}  // namespace

void reportFinger(const GraspModel& model, const GraspState& state, int finger, FingersContacts contacts,
                  GraspScratch& scratch) {
  const double h = scratch.world.h;
  FingerReport& report = scratch.fingers[finger];
  report = {};
  report.gap = scratch.nearest[finger].gap;
  const engine::PointScratch& point = scratch.world.points[finger];
  const Vec3 touch_W = sumContacts(contacts, point.p_mid_W, h, report);
  reportTouch(model, finger, touch_W, scratch);
  const double tick = model.world.options.h;
  if (h < tick) averageOverTick(point, tick, report);
  report.f_user_W = report.f_contact_W + scratch.inputs[finger].f_W;
  const double mass = model.fingers[finger].coupling.mass;
  if (mass > 0) report.f_user_W -= mass / tick * (state.world.points[finger].v_W - point.v_tick_W);
  mapPressure(model, finger, contacts, scratch);
}

void rememberFinger(const GraspModel& model, const FingerInput& input, int finger, GraspState& state,
                    GraspScratch& scratch) {
  const FingerModel& f = model.fingers[finger];
  FingerReport& report = scratch.fingers[finger];
  FingerState& memory = state.fingers[finger];
  report.last_touch = memory.touch;
  if (f.pad.isSoft()) report.patch_radius = patchRadius(f.pad, f.radius, report.normal_force);
  memory.seen = true;
  memory.q_WF = input.q_WF;
  memory.normal_force = report.normal_force;
  memory.touch = report.touch;
  if (report.touching) memory.n_W = report.n_W;
  scratch.orientations[finger] = input.q_WF;
}

bool keepOrientations(std::span<const FingerInput> inputs, const GraspScratch& scratch) {
  return std::equal(inputs.begin(), inputs.end(), scratch.orientations.begin(), scratch.orientations.end(),
                    [](const FingerInput& input, const Quat& last) { return input.q_WF.coeffs() == last.coeffs(); });
}

namespace {

// The fingers' contacts, for each part of the tick.
class FingerContacts final : public engine::ContactSource {
 public:
  FingerContacts(const GraspModel& model, GraspState& state, GraspScratch& scratch, std::span<const FingerInput> inputs)
      : model_(model), state_(state), scratch_(scratch), inputs_(inputs) {}
  void addContacts(engine::WorldScratch&) override {
    for (int i = 0; i < static_cast<int>(model_.fingers.size()); ++i) findFingerContacts(model_, i, state_, scratch_);
    engine::mark(scratch_.world, engine::Stage::kFingerContacts);
  }
  bool repeatsItself() const override { return keepOrientations(inputs_, scratch_); }

 private:
  const GraspModel& model_;
  GraspState& state_;
  GraspScratch& scratch_;
  std::span<const FingerInput> inputs_;
};

}  // namespace

GraspScratch::GraspScratch(const GraspModel& model)
    : world(model.world),
      inputs(model.fingers.size()),
      q_mid_WF(model.fingers.size(), Quat::Identity()),
      nearest(model.fingers.size()),
      fingers(model.fingers.size()),
      orientations(model.fingers.size()),
      taxels(model.fingers.size()) {
  if (!model.felt.empty()) world.patches = contact::PatchCache();  // the world may have room for one patch only
  for (std::size_t i = 0; i < taxels.size(); ++i) {
    const PressureGrid& grid = model.fingers[i].taxels;
    taxels[i].resize(static_cast<std::size_t>(grid.rows * grid.columns));
  }
}

void DeleteScratch::operator()(GraspScratch* scratch) const { delete scratch; }
ScratchHandle makeScratch(const GraspModel& model) { return ScratchHandle(new GraspScratch(model)); }

std::span<const FingerReport> fingersOf(const GraspScratch& scratch) { return scratch.fingers; }
engine::WorldScratch& worldOf(GraspScratch& scratch) { return scratch.world; }
const engine::WorldScratch& worldOf(const GraspScratch& scratch) { return scratch.world; }

GraspState makeState(const GraspModel& model, const std::vector<engine::BodyStart>& starts,
                     const std::vector<Vec3>& fingers) {
  GraspState state{engine::makeState(model.world, starts, fingers), placesFor(model), {}};
  state.fingers.resize(model.fingers.size());
  return state;
}

GraspReport step(const GraspModel& model, GraspState& state, GraspScratch& scratch, std::span<const FingerInput> inputs,
                 std::span<const engine::MotionInput> motions, const engine::AppliedForces& applied,
                 std::span<const engine::DriveInput> controls) {
  PINCER_DEMAND(inputs.size() == model.fingers.size(), "step: one input per finger");
  PINCER_DEMAND(
      state.fingers.size() == model.fingers.size() &&
          state.followed.trackers.size() == model.fingers.size() * static_cast<std::size_t>(state.followed.per_finger),
      "step: the state is one of this model (makeState)");
  PINCER_DEMAND(scratch.fingers.size() == model.fingers.size(), "step: the scratch is one of this model");
  setInputs(model, state, inputs, scratch);
  FingerContacts contacts(model, state, scratch, inputs);
  const engine::StepReport report =
      engine::step(model.world, state.world, scratch.world, {scratch.inputs, motions, applied, controls}, &contacts);
  if (report.asleep) return {report, scratch.fingers};  // those of the last tick
  // Of thousands of fingers each would else look at all contacts.
  FingersContacts left = contactsFrom(scratch, 0);
  for (int i = 0; i < static_cast<int>(inputs.size()); ++i) {
    const FingersContacts own = firstOf(left, i);
    left = left.subspan(own.size());
    reportFinger(model, state, i, own, scratch);
    rememberFinger(model, inputs[i], i, state, scratch);
  }
  engine::mark(scratch.world, engine::Stage::kFingerReport);
  return {report, scratch.fingers};
}

}  // namespace pincer::grasp
