#include "pincer/grasp/finger_distance.h"

#include "pincer/contact/functions/invariants.h"
#include "pincer/grasp/tick/finger_contacts.h"

namespace pincer::grasp {

std::vector<FingerDistance> fingerDistances(const GraspModel& model, const GraspState& state) {
  PINCER_DEMAND(state.fingers.size() == model.fingers.size(), "fingerDistances: the state is one of this model (makeState)");
  GraspState fresh = state;  // its trackers are searched from, not followed
  fresh.trackers.assign(fresh.trackers.size(), {});
  fresh.tips.assign(fresh.tips.size(), {});
  contact::PatchCache patches(1024);
  std::vector<FingerDistance> all;
  for (int finger = 0; finger < static_cast<int>(model.fingers.size()); ++finger) {
    const auto f = static_cast<std::size_t>(finger);
    const Pose X_WF{state.fingers[f].q_WF, state.world.points[f].p_W};
    PINCER_ASSERT(X_WF.p.allFinite() && isUnit(X_WF.q));
    for (int body = 0; body < static_cast<int>(model.world.bodies.size()); ++body) {
      const Pose X_WB = engine::bodyPose(model.world, state.world, body);
      const contact::FingerContacts found = fingerOnBody(model, fresh, patches, finger, body, X_WB, X_WF, 0);
      const contact::SurfaceContact& s = found.main();
      const Vec3 p_finger_W = X_WB * found.p_BT[0], n_W = X_WB.q * s.n_B;
      const Vec2 place_L = placeOnPad(model.fingers[f], X_WF.inverse() * p_finger_W, X_WF.q.conjugate() * -n_W);
      all.push_back({finger, body, s.phi, p_finger_W, X_WB * s.p_BS, n_W, place_L});
    }
  }
  return all;
}

}  // namespace pincer::grasp
