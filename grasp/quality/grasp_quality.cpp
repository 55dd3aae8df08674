#include "pincer/grasp/grasp_quality.h"

#include <Eigen/QR>
#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/grasp/quality/wrench_set.h"

namespace pincer::grasp {
namespace {

// Forces of all contacts, four numbers each, as graspColumns wants them.
Eigen::VectorXd stackedForces(const std::vector<GraspContact>& contacts) {
  Eigen::VectorXd f(4 * contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const GraspContact& c = contacts[i];
    f.segment<4>(static_cast<Eigen::Index>(4 * i)) << c.f_n, c.f_T_C,
        c.torsion_radius > 0 ? c.tau_n / c.torsion_radius : 0;
  }
  return f;
}

// The part of the forces that lies in the null space of G.
void addInternalForces(GraspQuality& q, const Vec3& p_WC) {
  Eigen::MatrixXd G(6, 4 * q.contacts.size());
  for (std::size_t i = 0; i < q.contacts.size(); ++i) {
    G.middleCols<4>(static_cast<Eigen::Index>(4 * i)) = graspColumns(q.contacts[i], p_WC, q.rho);
  }
  const Eigen::VectorXd f = stackedForces(q.contacts);
  const Eigen::VectorXd internal = f - G.completeOrthogonalDecomposition().solve(G * f);
  for (std::size_t i = 0; i < q.contacts.size(); ++i) {
    const auto f_C = internal.segment<4>(static_cast<Eigen::Index>(4 * i));
    q.internal_f_W.emplace_back(q.contacts[i].R_WC * Vec3(f_C[1], f_C[2], -f_C[0]));
  }
}

}  // namespace

GraspQuality graspQuality(std::vector<GraspContact> contacts, const Vec3& p_WC, const Vec3& weight_W) {
  GraspQuality q;
  q.contacts = std::move(contacts);
  q.least_squeeze = std::numeric_limits<double>::infinity();
  for (const GraspContact& c : q.contacts) {
    q.rho = std::max(q.rho, (c.p_W - p_WC).norm());
    q.slip_margins.push_back(slipMargin(c));
    q.squeeze += c.f_n;
  }
  if (!(q.rho > 0)) return q;
  const WrenchSet wrenches(q.contacts, p_WC, q.rho);
  q.rank = wrenches.rank();
  const WrenchSet::Ball ball = wrenches.largestBall();
  q.epsilon = ball.radius;
  q.weakest_W = ball.weakest;
  q.force_closure = q.epsilon > 0;
  q.volume = wrenches.volume();
  Vec6 held;
  held << -weight_W, Vec3::Zero();
  const double reach = weight_W.isZero(0) ? 0 : wrenches.shoot(held).t;
  if (weight_W.isZero(0)) q.least_squeeze = 0;
  if (reach > 0) q.least_squeeze = 1 / reach;
  for (int k = 0; k < 12; ++k) {
    const Vec6 w = (k % 2 == 0 ? -1 : 1) * Vec6::Unit(k / 2);  // what the contacts must give
    q.resisted[static_cast<std::size_t>(k)] = wrenches.shoot(w).t * (k < 6 ? 1 : q.rho);
  }
  addInternalForces(q, p_WC);
  return q;
}

GraspQuality graspQuality(const GraspModel& model, const GraspState& state, const GraspScratch& scratch, int body) {
  PINCER_DEMAND(isIndex(body, model.world.bodies.size()), "graspQuality: there is no such body");
  const auto i = static_cast<std::size_t>(body);
  return graspQuality(graspContacts(model, scratch, body), state.world.bodies[i].X_WI.p,
                      model.world.bodies[i].mass * model.world.options.gravity_W);
}

}  // namespace pincer::grasp
