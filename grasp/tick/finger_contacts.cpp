#include "pincer/grasp/tick/finger_contacts.h"

#include <cstdint>
#include <limits>
#include <type_traits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/colliders.h"
#include "pincer/engine/world/thin_contacts.h"
#include "pincer/grasp/tick/followed_shapes.h"

namespace pincer::grasp {
namespace {

using engine::SideKind;

// One finger, in the middle of the tick, in front of all bodies.
class FingerLook {
 public:
  FingerLook(const GraspModel& model, GraspState& state, GraspScratch& scratch, int finger)
      : model_(model),
        follower_(state.followed, finger, scratch.spare_tracker),
        state_(state),
        scratch_(scratch),
        finger_(finger),
        f_(model.fingers[finger]),
        point_(scratch.world.points[finger]),
        moves_(!point_.inverse_mass.isZero(0)),
        nearest_(scratch.nearest[finger]) {}

  void at(int body) {
    const engine::BodyModel& b = model_.world.bodies[body];
    const engine::BodyScratch& mid = scratch_.world.bodies[body];
    if (const engine::ColliderModel* const lone = engine::loneCollider(model_.world, b))
      return at({*lone, mid, mid.X_WB_mid.p, mid.R_WB_mid}, mid.X_WI_mid.p, b.bounding_radius);
    const std::size_t first = scratch_.world.contacts.size();
    for (const engine::ColliderModel& c : engine::collidersOf(model_.world, b)) {
      const Vec3 p_WS = mid.X_WB_mid.p + mid.R_WB_mid * c.X_BS.p;
      const Mat3 R_WS = mid.R_WB_mid * c.X_BS.q.toRotationMatrix();
      at({c, mid, p_WS, R_WS}, p_WS, c.bounding_radius);
    }
    engine::thinContacts(state_.world, first, scratch_.world);
  }

  // Distance of the finger's centre from a body's box, which holds the body's own way in the tick,
  // beyond which it needn't be looked at [m].
  double furthest() const {
    const engine::WorldOptions& options = model_.world.options;
    return f_.radius + std::max(f_.reach, options.contact_margin) + options.h * point_.start.v_W.norm();
  }

 private:
  // A body's shape in the middle of the tick.
  struct Place {
    const engine::ColliderModel& collider;
    const engine::BodyScratch& mid;  // of its body
    const Vec3& p_WS;
    const Mat3& R_WS;
  };

  struct Touching {
    engine::Side a, b;       // the finger and a body's shape
    std::uint64_t first_id;  // of their contacts
  };

  // Its bounds are a sphere about `centre_W`.
  void at(const Place& place, const Vec3& centre_W, double bounding_radius) {
    if (engine::isOnlySeen(place.collider.bits)) return;
    const Vec3& p_WC = point_.p_mid_W;
    const Vec3 p_SC = place.R_WS.transpose() * (p_WC - place.p_WS);
    const int number = static_cast<int>(&place.collider - model_.world.colliders.data());
    const contact::Shape& shape = feltShape(model_, number);
    if (!isWithinReach(centre_W, bounding_radius)) {
      const double bound = bounding_radius < kInfinity ? (p_WC - centre_W).norm() - bounding_radius - f_.radius
                                                       : contact::lowerBoundOfGap(shape, p_SC, f_.radius);
      if (bound > f_.reach && isBeyondMargin(bound, place.mid)) {
        nearest_.gap = std::min(nearest_.gap, bound);
        return;
      }
    }
    const double margin = marginTo(place.mid);
    contact::PatchCache& patches = scratch_.world.patches;
    const bool is_followed = f_.shape || std::holds_alternative<contact::Mesh>(shape);
    if (!is_followed)  // a sphere on a closed form
      return take(contact::querySphere(shape, p_SC, f_.radius, margin, scratch_.spare_tracker.main.ball, patches),
                  place, margin);
    contact::FingerTracker& tracker = follower_.of(number);
    if (!f_.shape)
      return follow(contact::querySphere(shape, p_SC, f_.radius, margin, tracker.main.ball, patches), place, margin);
    const Pose X_SF{shapeTurn(place).conjugate() * scratch_.q_mid_WF[finger_], p_SC};
    follow(contact::queryFinger(shape, *f_.shape, X_SF, margin, tracker, patches), place, margin);
  }

  static Quat shapeTurn(const Place& place) {
    const Quat& q_WB = place.mid.X_WB_mid.q;
    return place.collider.is_posed ? q_WB * place.collider.X_BS.q : q_WB;
  }

  template <class Found>
  void follow(const Found& found, const Place& place, double margin) {
    follower_.noteGap(found.main().phi);
    take(found, place, margin);
  }

  // Without a root: of what fingers hold, as a rule, the bounding sphere is.
  bool isWithinReach(const Vec3& centre_W, double bounding_radius) const {
    const double distance = f_.reach + bounding_radius + f_.radius;
    return distance < kInfinity && (point_.p_mid_W - centre_W).squaredNorm() <= distance * distance;
  }

  // A gap that closes within the tick must be seen at its middle.
  double marginTo(const engine::BodyScratch& mid) const {
    return model_.world.options.contact_margin + model_.world.options.h * (point_.start.v_W - mid.start.v_W).norm();
  }
  bool isBeyondMargin(double bound, const engine::BodyScratch& mid) const {
    const double h = model_.world.options.h, way = bound - model_.world.options.contact_margin;
    return way > 0 && way * way > h * h * (point_.start.v_W - mid.start.v_W).squaredNorm();
  }

  // The nearest point for the pad, and the contacts for the solve.
  template <class Found>
  void take(const Found& found, const Place& place, double margin) {
    const engine::BodyModel& b = model_.world.bodies[place.collider.body];
    const contact::SurfaceContact& main = found.main();
    // Static supports don't pre-position the tactor: what the hand looks for is an object.
    if (b.dynamic && main.phi < nearest_.gap) {
      nearest_.gap = main.phi;
      const Vec3 to_tip_W = place.p_WS + place.R_WS * main.p_BS - point_.p_mid_W;
      if constexpr (std::is_same_v<Found, contact::FingerContacts>) {
        nearest_.n_W = place.R_WS * main.n_B;
        nearest_.d_W = to_tip_W + main.phi * nearest_.n_W;
      } else {
        nearest_.n_W = -to_tip_W;  // where the facet is, whatever its shading says
      }
    }
    if (!b.dynamic && !moves_) return;
    Touching two{{SideKind::kPoint, 0, finger_}, engine::sideOf(model_.world, place.collider), 0};
    two.first_id = engine::contactId(model_.world.shape_bits, two.a, two.b, 0);
    for (int i = 0; i < found.count; ++i) {
      if (found.points[i].phi < margin) add(found.points[i], place, two);
    }
    if constexpr (std::is_same_v<Found, contact::FingerContacts>) noteWander(found, place, two);
  }

  // Keeps that of the last shape, where a compound is touched by several.
  void noteWander(const contact::FingerContacts& found, const Place& place, const Touching& two) {
    if (found.wander_B.isZero(0)) return;
    point_.wanders_on = place.collider.body;
    point_.wander_id = two.first_id | found.main().feature;
    point_.wander_W = place.R_WS * found.wander_B * place.R_WS.transpose();
  }

  // The two touch midway between the body's surface and the fingertip's, on the
  // normal n_W but for meshes with force shading.
  void add(const contact::SurfaceContact& found, const Place& place, const Touching& two) {
    engine::Contact* const c = engine::addContact(scratch_.world, found.phi);
    if (!c) return;
    const Vec3 n_W = place.R_WS * found.n_B;
    PINCER_ASSERT(isUnitIfFinite(n_W));
    c->a = two.a;
    c->b = two.b;
    c->id = two.first_id | found.feature;
    c->R_WC.col(2) = n_W;
    c->p_W = place.p_WS + place.R_WS * found.p_BS + 0.5 * found.phi * n_W;
    c->material = place.collider.material;
    if (f_.pad.isSoft())
      c->material.torsion_radius = torsionRadius(f_.pad, f_.radius, state_.fingers[finger_].normal_force);
  }

  const GraspModel& model_;
  FingerFollower follower_;
  const GraspState& state_;
  GraspScratch& scratch_;
  const int finger_;
  const FingerModel& f_;
  engine::PointScratch& point_;
  const bool moves_;
  NearestBody& nearest_;
};

}  // namespace

contact::FingerContacts fingerOnShape(const FingerModel& finger, const contact::Shape& shape, const Pose& X_WS,
                                      const Pose& X_WF, double margin, contact::FingerTracker& tracker,
                                      contact::PatchCache& patches) {
  const Pose X_BF = X_WS.inverse() * X_WF;
  if (finger.shape) return contact::queryFinger(shape, *finger.shape, X_BF, margin, tracker, patches);
  const contact::SurfaceContacts found =
      contact::querySphere(shape, X_BF.p, finger.radius, margin, tracker.main.ball, patches);
  contact::FingerContacts all;
  all.count = found.count;
  for (int i = 0; i < found.count; ++i) {
    const contact::SurfaceContact& s = all.points[i] = found.points[i];
    all.p_BT[i] = s.p_BS + s.phi * s.n_B;
  }
  return all;
}

void findFingerContacts(const GraspModel& model, int finger, GraspState& state, GraspScratch& scratch) {
  NearestBody& nearest = scratch.nearest[finger];
  nearest.gap = std::numeric_limits<double>::max();
  nearest.n_W.setZero();
  FingerLook look(model, state, scratch, finger);
  if (scratch.world.broad_phase) {
    const double reach = look.furthest();
    nearest.gap = reach - model.fingers[finger].radius;  // nothing else is nearer
    for (const int body : scratch.world.broad_phase->bodiesNear(scratch.world.points[finger].p_mid_W, reach))
      look.at(body);
    return;
  }
  const int bodies = static_cast<int>(model.world.bodies.size());
  for (int body = 0; body < bodies; ++body) look.at(body);
}

}  // namespace pincer::grasp
