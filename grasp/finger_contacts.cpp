#include "grasp/finger_contacts.h"

#include <limits>

namespace pincer::grasp {
namespace {

using engine::SideKind;

// The two touch midway between the body's surface and the fingertip's, on the normal n_W but for meshes with force shading.
void addFingerContact(const GraspModel& model, GraspScratch& scratch, int finger, int body, const contact::SurfaceContact& found) {
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
}

// What closes within the tick must be seen at its middle.
double contactMargin(const GraspModel& model, const GraspState& state, const GraspScratch& scratch, int finger, int body) {
  const double speed = (state.world.points[finger].v_W - scratch.world.bodies[body].start.v_W).norm();
  return model.world.options.contact_margin + model.world.options.h * speed;
}

void queryBody(const GraspModel& model, GraspState& state, GraspScratch& scratch, int finger, int body) {
  const engine::BodyModel& b = model.world.bodies[body];
  const FingerModel& f = model.fingers[finger];
  FingerReport& report = scratch.fingers[finger];
  const engine::BodyScratch& mid = scratch.world.bodies[body];
  const Vec3 p_BC = mid.R_WB_mid.transpose() * (scratch.world.points[finger].p_mid_W - mid.X_WB_mid.p);
  const double margin = contactMargin(model, state, scratch, finger, body);
  const double bound = contact::lowerBoundOfGap(b.shape, p_BC, f.radius);
  contact::SurfaceTracker& tracker =
      state.trackers[static_cast<std::size_t>(finger) * model.world.bodies.size() + static_cast<std::size_t>(body)];
  if (bound > std::max(f.reach, margin)) {
    report.gap = std::min(report.gap, bound);
    tracker = {};
    return;
  }
  const contact::SurfaceContacts found = contact::querySphere(b.shape, p_BC, f.radius, margin, tracker, scratch.world.patches);
  // Static supports don't pre-position the tactor: what the hand looks for is an object.
  if (b.dynamic && found.main().phi < report.gap) {
    report.gap = found.main().phi;
    scratch.nearest_n_W[finger] = mid.R_WB_mid * (p_BC - found.main().p_BS).normalized();
  }
  const bool neither_moves = !b.dynamic && scratch.world.points[finger].inverse_mass.isZero(0);
  for (int i = 0; i < found.count && !neither_moves; ++i) {
    if (found.points[i].phi < margin) addFingerContact(model, scratch, finger, body, found.points[i]);
  }
}

}  // namespace

void findFingerContacts(const GraspModel& model, GraspState& state, GraspScratch& scratch) {
  for (int finger = 0; finger < static_cast<int>(model.fingers.size()); ++finger) {
    scratch.fingers[finger] = {};
    scratch.fingers[finger].gap = std::numeric_limits<double>::max();
    scratch.nearest_n_W[finger].setZero();
    for (int body = 0; body < static_cast<int>(model.world.bodies.size()); ++body) queryBody(model, state, scratch, finger, body);
  }
}

}  // namespace pincer::grasp
