#include "grasp/finger_contacts.h"

#include <limits>
#include <type_traits>

namespace pincer::grasp {
namespace {

using engine::SideKind;

// The two touch midway between the body's surface and the fingertip's, on the normal n_W but for meshes with force shading.
void addFingerContact(const GraspModel& model, const GraspState& state, GraspScratch& scratch, int finger, int body,
                      const contact::SurfaceContact& found) {
  const engine::BodyScratch& mid = scratch.world.bodies[body];
  const Vec3 n_W = mid.R_WB_mid * found.n_B;
  engine::Contact* const c = engine::addContact(scratch.world, found.phi);
  if (!c) return;
  c->id = engine::contactId(1, finger, body, found.feature);
  c->a = {SideKind::kPoint, finger};
  c->b = {SideKind::kBody, body};
  c->R_WC.col(2) = n_W;
  c->p_W = mid.X_WB_mid.p + mid.R_WB_mid * found.p_BS + 0.5 * found.phi * n_W;
  c->material = model.world.bodies[body].material;
  const FingerModel& f = model.fingers[finger];
  if (f.pad.isSoft()) c->material.torsion_radius = torsionRadius(f.pad, f.radius, state.fingers[finger].normal_force);
}

// What closes within the tick must be seen at its middle.
double contactMargin(const GraspModel& model, const GraspState& state, const GraspScratch& scratch, int finger, int body) {
  const double speed = (state.world.points[finger].v_W - scratch.world.bodies[body].start.v_W).norm();
  return model.world.options.contact_margin + model.world.options.h * speed;
}

// The nearest point for the pad, and the contacts for the solve.
template <class Found>
void takeFound(const Found& found, const GraspModel& model, const GraspState& state, GraspScratch& scratch, int finger, int body,
               double margin) {
  const engine::BodyModel& b = model.world.bodies[body];
  const engine::BodyScratch& mid = scratch.world.bodies[body];
  FingerReport& report = scratch.fingers[finger];
  const contact::SurfaceContact& main = found.main();
  // Static supports don't pre-position the tactor: what the hand looks for is an object.
  if (b.dynamic && main.phi < report.gap) {
    report.gap = main.phi;
    const Vec3 to_tip_W = mid.X_WB_mid.p + mid.R_WB_mid * main.p_BS - scratch.world.points[finger].p_mid_W;
    scratch.nearest_n_W[finger] = mid.R_WB_mid * main.n_B;
    if constexpr (std::is_same_v<Found, contact::FingerContacts>) {
      scratch.nearest_p_F[finger] = scratch.q_mid_WF[finger].conjugate() * (to_tip_W + main.phi * scratch.nearest_n_W[finger]);
    } else {
      scratch.nearest_n_W[finger] = -to_tip_W;  // where the facet is, whatever its shading says
    }
  }
  const bool neither_moves = !b.dynamic && scratch.world.points[finger].inverse_mass.isZero(0);
  for (int i = 0; i < found.count && !neither_moves; ++i) {
    if (found.points[i].phi < margin) addFingerContact(model, state, scratch, finger, body, found.points[i]);
  }
}

void queryBody(const GraspModel& model, GraspState& state, GraspScratch& scratch, int finger, int body) {
  const engine::BodyModel& b = model.world.bodies[body];
  const FingerModel& f = model.fingers[finger];
  FingerReport& report = scratch.fingers[finger];
  const engine::BodyScratch& mid = scratch.world.bodies[body];
  const Vec3& p_WC = scratch.world.points[finger].p_mid_W;
  const Vec3 p_BC = mid.R_WB_mid.transpose() * (p_WC - mid.X_WB_mid.p);
  const double margin = contactMargin(model, state, scratch, finger, body);
  const double bound = contact::lowerBoundOfGap(b.shape, p_BC, f.radius);
  const std::size_t pair = static_cast<std::size_t>(finger) * model.world.bodies.size() + static_cast<std::size_t>(body);
  if (bound > std::max(f.reach, margin)) {
    report.gap = std::min(report.gap, bound);
    state.trackers[pair] = {};
    if (f.shape) state.tips[pair] = {};
    return;
  }
  if (f.shape) {
    const Pose X_WF{scratch.q_mid_WF[finger], p_WC};
    return takeFound(fingerOnBody(model, state, scratch.world.patches, finger, body, mid.X_WB_mid, X_WF, margin), model, state, scratch,
                     finger, body, margin);
  }
  takeFound(contact::querySphere(b.shape, p_BC, f.radius, margin, state.trackers[pair], scratch.world.patches), model, state, scratch,
            finger, body, margin);
}

}  // namespace

contact::FingerContacts fingerOnBody(const GraspModel& model, GraspState& state, contact::PatchCache& patches, int finger, int body,
                                     const Pose& X_WB, const Pose& X_WF, double margin) {
  const FingerModel& f = model.fingers[finger];
  const contact::Shape& shape = model.world.bodies[body].shape;
  const std::size_t pair = static_cast<std::size_t>(finger) * model.world.bodies.size() + static_cast<std::size_t>(body);
  const Pose X_BF = X_WB.inverse() * X_WF;
  if (f.shape) return contact::queryFinger(shape, *f.shape, X_BF, margin, state.tips[pair], patches);
  const contact::SurfaceContacts found = contact::querySphere(shape, X_BF.p, f.radius, margin, state.trackers[pair], patches);
  contact::FingerContacts all;
  all.count = found.count;
  for (int i = 0; i < found.count; ++i) {
    const contact::SurfaceContact& s = all.points[i] = found.points[i];
    all.p_BT[i] = s.p_BS + s.phi * s.n_B;
  }
  return all;
}

void findFingerContacts(const GraspModel& model, GraspState& state, GraspScratch& scratch) {
  for (int finger = 0; finger < static_cast<int>(model.fingers.size()); ++finger) {
    scratch.fingers[finger] = {};
    scratch.fingers[finger].gap = std::numeric_limits<double>::max();
    scratch.nearest_n_W[finger].setZero();
    if (model.fingers[finger].method != FingerMethod::kProxy) continue;
    for (int body = 0; body < static_cast<int>(model.world.bodies.size()); ++body) queryBody(model, state, scratch, finger, body);
  }
}

}  // namespace pincer::grasp
