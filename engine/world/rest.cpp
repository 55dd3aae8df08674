#include "pincer/engine/world/rest.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/drive_rows.h"

namespace pincer::engine {
namespace {

bool same(const Quat& a, const Quat& b) { return a.coeffs() == b.coeffs(); }

}  // namespace

bool same(const BodyState& a, const BodyState& b) {
  return a.X_WI.p == b.X_WI.p && same(a.X_WI.q, b.X_WI.q) && a.v_W == b.v_W && a.L_W == b.L_W;
}
bool same(const ContactMemory& a, const ContactMemory& b) {
  return a.id == b.id && a.r == b.r && a.offset_C == b.offset_C && a.t1_W == b.t1_W && a.n_W == b.n_W &&
         a.arm_a_W == b.arm_a_W && a.arm_b_W == b.arm_b_W && a.active == b.active && a.sliding == b.sliding &&
         a.closing == b.closing && a.anchored == b.anchored && a.open_ticks == b.open_ticks && a.settling == b.settling;
}
bool same(const MotionInput& a, const MotionInput& b) {
  return a.X_WB.p == b.X_WB.p && same(a.X_WB.q, b.X_WB.q) && a.motion.v_W == b.motion.v_W &&
         a.motion.w_W == b.motion.w_W;
}

namespace {

bool same(const PointState& a, const PointState& b) {
  return a.p_W == b.p_W && a.v_W == b.v_W && a.p_target_W == b.p_target_W && a.v_target_W == b.v_target_W &&
         a.touching == b.touching && a.twist == b.twist && a.twist_rate == b.twist_rate && a.turn_W == b.turn_W &&
         a.turn_rate_W == b.turn_rate_W;
}
bool same(const PointInput& a, const PointInput& b) {
  return a.p_target_W == b.p_target_W && a.v_target_W == b.v_target_W && a.f_W == b.f_W && a.w_W == b.w_W &&
         a.turned == b.turned && a.n_W == b.n_W;
}

bool same(const BodyForce& a, const BodyForce& b) { return a.f_W == b.f_W && a.tau_W == b.tau_W; }

template <class Range>
bool sameRange(const Range& a, const Range& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) { return same(x, y); });
}

std::span<const ContactMemory> contactsOf(const WorldState& state) {
  return {state.contacts.data(), static_cast<std::size_t>(state.contact_count)};
}

// All but the time.
bool sameState(const WorldState& a, const WorldState& b) {
  return a.h_last == b.h_last && a.parts == b.parts && a.tree_q == b.tree_q && a.tree_v == b.tree_v &&
         a.brakes == b.brakes && a.drives == b.drives && a.controls == b.controls && sameRange(a.bodies, b.bodies) &&
         a.driven_w_W == b.driven_w_W && sameRange(a.points, b.points) && sameRange(contactsOf(a), contactsOf(b));
}

void copyState(const WorldState& from, WorldState& to) {
  PINCER_ASSERT(from.bodies.size() == to.bodies.size() && from.points.size() == to.points.size());
  PINCER_ASSERT(from.contact_count <= static_cast<int>(to.contacts.size()));
  to.h_last = from.h_last;
  to.parts = from.parts;
  to.contact_count = from.contact_count;
  to.tree_q = from.tree_q;
  to.tree_v = from.tree_v;
  to.brakes = from.brakes;
  to.drives = from.drives;
  to.controls = from.controls;
  std::copy(from.bodies.begin(), from.bodies.end(), to.bodies.begin());
  std::copy(from.driven_w_W.begin(), from.driven_w_W.end(), to.driven_w_W.begin());
  std::copy(from.points.begin(), from.points.end(), to.points.begin());
  std::copy(from.contacts.begin(), from.contacts.begin() + from.contact_count, to.contacts.begin());
}

// The controls are those of the last tick, and lead nowhere. The state remembers them cut off at their drives' ranges.
bool sameControls(const WorldModel& model, std::span<const DriveInput> controls, const WorldState& state) {
  for (std::size_t d = 0; d < controls.size(); ++d) {
    if (withinControls(model.drives[d], controls[d]) != state.controls[d]) return false;
  }
  return true;
}

bool isStill(const WorldState& state) {
  const auto stands = [](const auto& s) { return s.v_W.isZero(0); };
  return std::all_of(state.bodies.begin(), state.bodies.end(), stands) &&
         std::all_of(state.points.begin(), state.points.end(), stands);
}

}  // namespace

bool repeatsItself(const WorldModel& model, const WorldState& state, const WorldScratch& scratch,
                   const StepInputs& inputs) {
  const RestMemory& rest = scratch.sleep.rest;
  return rest.holds && sameControls(model, inputs.controls, state) &&
         sameRange(inputs.points, std::span<const PointInput>(rest.points)) &&
         sameRange(inputs.motions, std::span<const MotionInput>(rest.motions)) &&
         inputs.applied.gravity_W == rest.gravity_W &&
         sameRange(inputs.applied.forces, std::span<const BodyForce>(rest.forces)) && sameState(state, rest.state);
}

void noteRest(const WorldState& state, const StepInputs& inputs, bool calm, WorldScratch& scratch) {
  RestMemory& rest = scratch.sleep.rest;
  rest.holds = false;
  if (!calm || inputs.points.size() != rest.points.size() || inputs.motions.size() != rest.motions.size() ||
      !isStill(state)) {
    rest.candidate = false;
    return;
  }
  if (rest.candidate && sameState(state, rest.state)) {
    rest.holds = true;
    std::copy(inputs.points.begin(), inputs.points.end(), rest.points.begin());
    std::copy(inputs.motions.begin(), inputs.motions.end(), rest.motions.begin());
    rest.forces.assign(inputs.applied.forces.begin(), inputs.applied.forces.end());
    rest.gravity_W = inputs.applied.gravity_W;
    return;
  }
  rest.candidate = true;
  copyState(state, rest.state);
}

}  // namespace pincer::engine
