// textbook_tree: trees of pivots and sliders on the world, as a textbook writes them: Jacobians link by link, the mass
// matrix as a sum over the links, its slopes by differences. No sparse factor, no recursion.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

struct TextbookLink {
  int parent = -1;
  bool slides = false;
  // The joint, its axis z, in the parent's and the link's own frame, whose origin is the centre of mass.
  Pose X_PJ, X_LJ;
  double mass = 0;              // [kg]
  Vec3 moments = Vec3::Zero();  // [kg m^2]
};

class TextbookTree {
 public:
  explicit TextbookTree(std::vector<TextbookLink> links) : links_(std::move(links)) {}

  const std::vector<TextbookLink>& links() const { return links_; }
  Pose linkPose(const Eigen::VectorXd& q, int link) const { return posesAt(q)[static_cast<std::size_t>(link)]; }

  // M = sum of m J_v^T J_v + J_w^T I J_w over the links.
  Eigen::MatrixXd massMatrix(const Eigen::VectorXd& q) const;
  // Velocity of the link's point that is at p_W, by rates (3 x joints).
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& q, int link, const Vec3& p_W) const;
  // v' = M^-1 (tau - C): C_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) v_j v_k + dV/dq_i.
  Eigen::VectorXd accelerations(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau) const;

 private:
  std::vector<Pose> posesAt(const Eigen::VectorXd& q) const;
  double potential(const Eigen::VectorXd& q) const;

  std::vector<TextbookLink> links_;
};

// Links on random parents, so that chains and branches come up: masses over 30, any axes.
TextbookTree randomTree(Random& random, int count);

}  // namespace pincer::tasks
