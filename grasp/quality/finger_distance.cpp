#include "pincer/grasp/finger_distance.h"

#include <optional>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/colliders.h"
#include "pincer/grasp/tick/finger_contacts.h"

namespace pincer::grasp {
namespace {

// Of a body's shapes that can be touched; none if it has none.
std::optional<FingerDistance> nearestOf(const GraspModel& model, const GraspState& state, contact::PatchCache& patches,
                                        int finger, int body, const Pose& X_WF) {
  const engine::BodyModel& b = model.world.bodies[static_cast<std::size_t>(body)];
  const Pose X_WB = engine::bodyPose(model.world, state.world, body);
  const FingerModel& f = model.fingers[static_cast<std::size_t>(finger)];
  std::optional<FingerDistance> nearest;
  for (int collider = b.first_collider; collider < b.first_collider + b.collider_count; ++collider) {
    const engine::ColliderModel& c = model.world.colliders[static_cast<std::size_t>(collider)];
    if (engine::isOnlySeen(c.bits)) continue;
    const Pose X_WS = engine::poseOf(c, X_WB);
    contact::FingerTracker searches;
    const contact::FingerContacts found =
        fingerOnShape(f, feltShape(model, collider), X_WS, X_WF, 0, searches, patches);
    const contact::SurfaceContact& s = found.main();
    if (nearest && !(s.phi < nearest->gap)) continue;
    const Vec3 p_finger_W = X_WS * found.p_BT[0], n_W = X_WS.q * s.n_B;
    const Vec2 place_L = placeOnPad(f, X_WF.inverse() * p_finger_W, X_WF.q.conjugate() * -n_W);
    nearest = {finger, body, s.phi, p_finger_W, X_WS * s.p_BS, n_W, place_L};
  }
  return nearest;
}

}  // namespace

std::vector<FingerDistance> fingerDistances(const GraspModel& model, const GraspState& state) {
  PINCER_DEMAND(state.fingers.size() == model.fingers.size(),
                "fingerDistances: the state is one of this model (makeState)");
  contact::PatchCache patches(1024);
  std::vector<FingerDistance> all;
  for (int finger = 0; finger < static_cast<int>(model.fingers.size()); ++finger) {
    const auto f = static_cast<std::size_t>(finger);
    const Pose X_WF{state.fingers[f].q_WF, state.world.points[f].p_W};
    PINCER_ASSERT(X_WF.p.allFinite() && isUnit(X_WF.q));
    for (int body = 0; body < static_cast<int>(model.world.bodies.size()); ++body) {
      if (const auto nearest = nearestOf(model, state, patches, finger, body, X_WF)) all.push_back(*nearest);
    }
  }
  return all;
}

}  // namespace pincer::grasp
