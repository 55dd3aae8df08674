#include "grasp/finger_contacts.h"

#include <limits>

namespace pincer::grasp {
namespace {

using engine::SideKind;

engine::Contact fingerContact(const GraspModel& model, int finger, int body, const Pose& X_WB, const contact::SurfaceContact& found) {
  engine::Contact c;
  c.id = engine::contactId(1, finger, body, 0);
  c.a = {SideKind::kPoint, finger};
  c.b = {SideKind::kBody, body};
  c.R_WC.col(2) = X_WB.q * found.n_B;
  c.p_W = X_WB * found.p_BS + (0.5 * found.phi) * c.n_W();
  c.phi = found.phi;
  c.material = model.world.bodies[body].material;
  return c;
}

// What closes within the tick must be seen at its middle.
double contactMargin(const GraspModel& model, const GraspState& state, const GraspScratch& scratch, int finger, int body) {
  const double speed = (state.world.points[finger].v_W - scratch.world.bodies[body].v_start_W).norm();
  return model.world.options.contact_margin + model.world.options.h * speed;
}

void queryBody(const GraspModel& model, GraspState& state, GraspScratch& scratch, int finger, int body) {
  const engine::BodyModel& b = model.world.bodies[body];
  const FingerModel& f = model.fingers[finger];
  FingerReport& report = scratch.fingers[finger];
  const Pose X_WB = scratch.world.bodies[body].X_WI_mid * b.X_IB;
  const Vec3 p_BC = X_WB.inverse() * scratch.world.points[finger].p_mid_W;
  const double margin = contactMargin(model, state, scratch, finger, body);
  const double bound = contact::lowerBoundOfGap(b.shape, p_BC, f.radius);
  contact::SurfaceTracker& tracker =
      state.trackers[static_cast<std::size_t>(finger) * model.world.bodies.size() + static_cast<std::size_t>(body)];
  if (bound > std::max(f.reach, margin)) {
    report.gap = std::min(report.gap, bound);
    tracker = {};
    return;
  }
  const contact::SurfaceContact found = contact::querySphere(b.shape, p_BC, f.radius, tracker);
  // Static supports don't pre-position the tactor: what the hand looks for is an object.
  if (b.dynamic && found.phi < report.gap) {
    report.gap = found.phi;
    scratch.nearest_n_W[finger] = X_WB.q * found.n_B;
  }
  if (found.phi < margin) engine::addContact(scratch.world, fingerContact(model, finger, body, X_WB, found));
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
