#include "pincer/tasks/judge/verify/textbook_tree.h"

#include <Eigen/Dense>
#include <algorithm>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/judge/verify/scene_run.h"

namespace pincer::tasks {
namespace {

// By differences of 4th order, error below 1e-11 of the function at this step.
template <class F>
Eigen::MatrixXd slopeAlong(const Eigen::VectorXd& q, Eigen::Index k, const F& f) {
  constexpr double kStep = 1e-3;  // [rad or m]
  const auto at = [&](double way) {
    Eigen::VectorXd moved = q;
    moved[k] += way;
    return f(moved);
  };
  return (8 * (at(kStep) - at(-kStep)) - (at(2 * kStep) - at(-2 * kStep))) / (12 * kStep);
}

Pose anyPose(Random& random, double reach) {
  const Vec3 turn = random.normal3(), p = random.normal3();
  return {quatFromRotationVector(turn), reach * p};
}

}  // namespace

Eigen::VectorXd TextbookTree::accelerations(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                            const Eigen::VectorXd& tau) const {
  const Eigen::Index n = q.size();
  std::vector<Eigen::MatrixXd> slope;
  Eigen::VectorXd bias = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    slope.push_back(slopeAlong(q, k, [this](const Eigen::VectorXd& at) { return massMatrix(at); }));
    bias[k] = slopeAlong(q, k, [this](const Eigen::VectorXd& at) {
      return Eigen::MatrixXd(Eigen::MatrixXd::Constant(1, 1, potential(at)));
    })(0, 0);
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    bias += v[k] * (slope[static_cast<std::size_t>(k)] * v);
    bias[k] -= 0.5 * v.dot(slope[static_cast<std::size_t>(k)] * v);
  }
  return massMatrix(q).ldlt().solve(tau - bias);
}

std::vector<Pose> TextbookTree::posesAt(const Eigen::VectorXd& q) const {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const TextbookLink& link = links_[i];
    const double way = q[static_cast<Eigen::Index>(i)];
    const Pose moved =
        link.slides ? Pose{Quat::Identity(), {0, 0, way}} : Pose{quatFromRotationVector({0, 0, way}), Vec3::Zero()};
    const Pose X_WP = link.parent < 0 ? Pose{} : poses[static_cast<std::size_t>(link.parent)];
    poses.push_back(X_WP * link.X_PJ * moved * link.X_LJ.inverse());
  }
  return poses;
}

// A column per joint between the link and the world.
Eigen::MatrixXd TextbookTree::jacobian(const Eigen::VectorXd& q, int link, const Vec3& p_W) const {
  const std::vector<Pose> poses = posesAt(q);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, q.size());
  for (int at = link; at >= 0; at = links_[static_cast<std::size_t>(at)].parent) {
    const TextbookLink& own = links_[static_cast<std::size_t>(at)];
    const Pose X_WJ = poses[static_cast<std::size_t>(at)] * own.X_LJ;
    const Vec3 axis = X_WJ.q * Vec3::UnitZ();
    J.col(at) = own.slides ? axis : Vec3(axis.cross(p_W - X_WJ.p));
  }
  return J;
}

Eigen::MatrixXd TextbookTree::massMatrix(const Eigen::VectorXd& q) const {
  const std::vector<Pose> poses = posesAt(q);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(q.size(), q.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Eigen::MatrixXd J_v = jacobian(q, static_cast<int>(i), poses[i].p);
    Eigen::MatrixXd J_w = Eigen::MatrixXd::Zero(3, q.size());
    for (int at = static_cast<int>(i); at >= 0; at = links_[static_cast<std::size_t>(at)].parent) {
      const TextbookLink& own = links_[static_cast<std::size_t>(at)];
      if (!own.slides) J_w.col(at) = poses[static_cast<std::size_t>(at)].q * (own.X_LJ.q * Vec3::UnitZ());
    }
    const Mat3 R = poses[i].q.toRotationMatrix();
    const Mat3 I_W = R * links_[i].moments.asDiagonal() * R.transpose();
    M += links_[i].mass * J_v.transpose() * J_v + J_w.transpose() * I_W * J_w;
  }
  return M;
}

double TextbookTree::potential(const Eigen::VectorXd& q) const {
  const std::vector<Pose> poses = posesAt(q);
  double sum = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) sum += links_[i].mass * kVerifyG * poses[i].p.z();
  return sum;
}

TextbookTree randomTree(Random& random, int count) {
  std::vector<TextbookLink> links;
  for (int i = 0; i < count; ++i) {
    TextbookLink link;
    link.parent =
        static_cast<int>(random.below(static_cast<std::uint64_t>(std::min(i, 3)) + 1)) + std::max(i - 3, 0) - 1;
    link.slides = random.below(4) == 0;
    link.X_PJ = anyPose(random, 0.1);
    link.X_LJ = anyPose(random, 0.05);
    link.mass = 0.1 * math::pow(30, random.uniform());
    const double a = random.uniform(0.5, 1), b = random.uniform(0.5, 1), c = random.uniform(0.5, 1);
    link.moments = 1e-3 * link.mass * Vec3(b + c, a + c, a + b);
    links.push_back(link);
  }
  return TextbookTree(std::move(links));
}

}  // namespace pincer::tasks
