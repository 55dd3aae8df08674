#include "pincer/grasp/quality/grasp_contact.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/grasp/tick/scratch.h"

namespace pincer::grasp {

std::vector<GraspContact> graspContacts(const GraspModel& model, const GraspScratch& scratch, int body) {
  PINCER_DEMAND(isIndex(body, model.world.bodies.size()), "graspContacts: there is no such body");
  PINCER_DEMAND(scratch.world.h > 0, "graspContacts: step the world first");
  const double h = scratch.world.h;
  std::vector<GraspContact> contacts;
  for (const engine::Contact& c : scratch.world.contacts) {
    const bool finger_on_body = c.a.kind == engine::SideKind::kPoint &&
                                c.a.index < static_cast<int>(model.fingers.size()) &&
                                c.b.kind == engine::SideKind::kBody && c.b.index == body;
    if (!finger_on_body || !c.active()) continue;
    // c.r acts on the finger
    contacts.push_back({c.a.index, c.p_W, c.R_WC, c.mu, c.material.torsion_radius, c.r[2] / h, -c.r.head<2>() / h,
                        c.material.torsion_radius * c.r[engine::kTorsionRow] / h});
  }
  return contacts;
}

double slipMargin(const GraspContact& contact) {
  PINCER_ASSERT(contact.mu >= 0 && contact.f_n >= 0);
  const double limit = contact.mu * contact.f_n;
  if (!(limit > 0)) return 0;
  const double torsion = contact.torsion_radius > 0 ? contact.tau_n / contact.torsion_radius : 0;
  return std::max(1 - math::hypot(contact.f_T_C.norm(), torsion) / limit, 0.0);
}

Eigen::Matrix<double, 6, 4> graspColumns(const GraspContact& contact, const Vec3& p_WC, double rho) {
  PINCER_ASSERT(isRotation(contact.R_WC));
  PINCER_ASSERT(rho > 0);
  const Vec3 arm = contact.p_W - p_WC, t1 = contact.R_WC.col(0), t2 = contact.R_WC.col(1), n = contact.R_WC.col(2);
  Eigen::Matrix<double, 6, 4> G;
  G.col(0) << -n, -arm.cross(n) / rho;
  G.col(1) << t1, arm.cross(t1) / rho;
  G.col(2) << t2, arm.cross(t2) / rho;
  G.col(3) << Vec3::Zero(), -n * (contact.torsion_radius / rho);
  return G;
}

}  // namespace pincer::grasp
