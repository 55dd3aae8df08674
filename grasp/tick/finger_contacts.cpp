#include "pincer/grasp/tick/finger_contacts.h"

#include <limits>
#include <type_traits>

#include "pincer/contact/functions/invariants.h"

namespace pincer::grasp {
namespace {

using engine::SideKind;

constexpr double kEndless = std::numeric_limits<double>::infinity();  // radius of a half-space

// One finger, in the middle of the tick, in front of all bodies.
class FingerLook {
 public:
  FingerLook(const GraspModel& model, GraspState& state, GraspScratch& scratch, int finger)
      : model_(model),
        state_(state),
        scratch_(scratch),
        finger_(finger),
        f_(model.fingers[finger]),
        point_(scratch.world.points[finger]),
        moves_(!point_.inverse_mass.isZero(0)),
        report_(scratch.fingers[finger]) {}

  void at(int body) {
    const engine::BodyModel& b = model_.world.bodies[body];
    const engine::BodyScratch& mid = scratch_.world.bodies[body];
    const Vec3& p_WC = point_.p_mid_W;
    const Vec3 p_BC = mid.R_WB_mid.transpose() * (p_WC - mid.X_WB_mid.p);
    const std::size_t pair = static_cast<std::size_t>(finger_) * model_.world.bodies.size() + static_cast<std::size_t>(body);
    if (!isWithinReach(b, mid)) {
      const double bound = b.bounding_radius < kEndless ? (p_WC - mid.X_WI_mid.p).norm() - b.bounding_radius - f_.radius
                                                        : contact::lowerBoundOfGap(b.shape, p_BC, f_.radius);
      if (bound > f_.reach && isBeyondMargin(bound, mid)) {
        report_.gap = std::min(report_.gap, bound);
        if (std::holds_alternative<contact::Mesh>(b.shape)) state_.trackers[pair] = {};  // closed forms don't use it
        if (f_.shape) state_.tips[pair] = {};
        return;
      }
    }
    const double margin = marginTo(mid);
    if (f_.shape) {
      const Pose X_WF{scratch_.q_mid_WF[finger_], p_WC};
      return take(fingerOnBody(model_, state_, scratch_.world.patches, finger_, body, mid.X_WB_mid, X_WF, margin), body, margin);
    }
    take(contact::querySphere(b.shape, p_BC, f_.radius, margin, state_.trackers[pair], scratch_.world.patches), body, margin);
  }

  // Distance of the finger's centre from a body's box, which holds the body's own way in the tick, beyond which it needn't be looked at [m].
  double furthest() const {
    const engine::WorldOptions& options = model_.world.options;
    return f_.radius + std::max(f_.reach, options.contact_margin) + options.h * point_.start.v_W.norm();
  }

 private:
  // Without a root: of what fingers hold, as a rule, the bounding sphere is.
  bool isWithinReach(const engine::BodyModel& b, const engine::BodyScratch& mid) const {
    const double distance = f_.reach + b.bounding_radius + f_.radius;
    return distance < kEndless && (point_.p_mid_W - mid.X_WI_mid.p).squaredNorm() <= distance * distance;
  }

  // What closes within the tick must be seen at its middle.
  double marginTo(const engine::BodyScratch& mid) const {
    return model_.world.options.contact_margin + model_.world.options.h * (point_.start.v_W - mid.start.v_W).norm();
  }
  bool isBeyondMargin(double bound, const engine::BodyScratch& mid) const {
    const double h = model_.world.options.h, way = bound - model_.world.options.contact_margin;
    return way > 0 && way * way > h * h * (point_.start.v_W - mid.start.v_W).squaredNorm();
  }

  // The nearest point for the pad, and the contacts for the solve.
  template <class Found>
  void take(const Found& found, int body, double margin) {
    const engine::BodyModel& b = model_.world.bodies[body];
    const engine::BodyScratch& mid = scratch_.world.bodies[body];
    const contact::SurfaceContact& main = found.main();
    // Static supports don't pre-position the tactor: what the hand looks for is an object.
    if (b.dynamic && main.phi < report_.gap) {
      report_.gap = main.phi;
      const Vec3 to_tip_W = mid.X_WB_mid.p + mid.R_WB_mid * main.p_BS - point_.p_mid_W;
      Vec3& nearest_n_W = scratch_.nearest_n_W[finger_];
      if constexpr (std::is_same_v<Found, contact::FingerContacts>) {
        nearest_n_W = mid.R_WB_mid * main.n_B;
        scratch_.nearest_d_W[finger_] = to_tip_W + main.phi * nearest_n_W;
      } else {
        nearest_n_W = -to_tip_W;  // where the facet is, whatever its shading says
      }
    }
    if (!b.dynamic && !moves_) return;
    for (int i = 0; i < found.count; ++i) {
      if (found.points[i].phi < margin) add(found.points[i], body, b.material, mid);
    }
  }

  // The two touch midway between the body's surface and the fingertip's, on the normal n_W but for meshes with force shading.
  void add(const contact::SurfaceContact& found, int body, const engine::Material& material, const engine::BodyScratch& mid) {
    engine::Contact* const c = engine::addContact(scratch_.world, found.phi);
    if (!c) return;
    const Vec3 n_W = mid.R_WB_mid * found.n_B;
    PINCER_ASSERT(isUnitIfFinite(n_W));
    c->id = engine::contactId(1, finger_, body, found.feature);
    c->a = {SideKind::kPoint, finger_};
    c->b = {SideKind::kBody, body};
    c->R_WC.col(2) = n_W;
    c->p_W = mid.X_WB_mid.p + mid.R_WB_mid * found.p_BS + 0.5 * found.phi * n_W;
    c->material = material;
    if (f_.pad.isSoft()) c->material.torsion_radius = torsionRadius(f_.pad, f_.radius, state_.fingers[finger_].normal_force);
  }

  const GraspModel& model_;
  GraspState& state_;
  GraspScratch& scratch_;
  const int finger_;
  const FingerModel& f_;
  const engine::PointScratch& point_;
  const bool moves_;
  FingerReport& report_;
};

}  // namespace

contact::FingerContacts fingerOnBody(const GraspModel& model, GraspState& state, contact::PatchCache& patches, int finger, int body,
                                     const Pose& X_WB, const Pose& X_WF, double margin) {
  PINCER_ASSERT(isIndex(finger, model.fingers.size()) && isIndex(body, model.world.bodies.size()));
  const FingerModel& f = model.fingers[finger];
  const contact::Shape& shape = model.world.bodies[body].shape;
  const std::size_t pair = static_cast<std::size_t>(finger) * model.world.bodies.size() + static_cast<std::size_t>(body);
  const Pose X_BF = X_WB.inverse() * X_WF;
  PINCER_ASSERT(!f.shape || state.tips.size() == state.trackers.size());
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

void findFingerContacts(const GraspModel& model, int finger, GraspState& state, GraspScratch& scratch) {
  scratch.fingers[finger] = {};
  scratch.fingers[finger].gap = std::numeric_limits<double>::max();
  scratch.nearest_n_W[finger].setZero();
  FingerLook look(model, state, scratch, finger);
  if (scratch.world.broad_phase) {
    const double reach = look.furthest();
    scratch.fingers[finger].gap = reach - model.fingers[finger].radius;  // nothing else is nearer
    for (const int body : scratch.world.broad_phase->bodiesNear(scratch.world.points[finger].p_mid_W, reach)) look.at(body);
    return;
  }
  const int bodies = static_cast<int>(model.world.bodies.size());
  for (int body = 0; body < bodies; ++body) look.at(body);
}

}  // namespace pincer::grasp
