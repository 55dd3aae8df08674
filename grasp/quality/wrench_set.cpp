#include "pincer/grasp/quality/wrench_set.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pincer/contact/functions/invariants.h"

namespace pincer::grasp {
namespace {

constexpr double kFlat = 1e-9;           // singular values, and reaches, below this part of the largest don't count
constexpr double kOptimal = 1e-12;       // of a column's price, relative to W's size
constexpr double kPerturbation = 1e-9;   // of the right-hand side, relative: without it every pivot is degenerate
constexpr double kArtificial = 1e4;      // cost of what isn't there
constexpr int kMostPivots = 500;         // of the simplex method
constexpr int kMostTurns = 200;          // of a descent from one direction
constexpr int kRandomDirections = 52;    // to start from, beside the twelve along the axes
constexpr int kVolumeDirections = 2000;  // that the volume is a mean over

// Directions that fill the sphere of any dimension evenly enough: normal deviates of an additive
// recurrence (M. Roberts 2018, R_d sequence).
class Directions {
 public:
  Vec6 next() {
    ++k_;
    Vec6 d;
    for (int i = 0; i < 6; i += 2) {
      const double r = std::sqrt(-2 * math::log(1 - fraction(i))), a = 2 * std::numbers::pi * fraction(i + 1);
      d[i] = r * math::cos(a);
      d[i + 1] = r * math::sin(a);
    }
    return d.normalized();
  }

 private:
  // phi_6, the positive root of x^7 = x + 1
  double fraction(int i) const {
    const double x = 0.5 + k_ * math::pow(1.1127756842787055, -(i + 1));
    return x - std::floor(x);
  }
  int k_ = 0;
};

Eigen::MatrixXd spanOf(const std::vector<Eigen::Matrix<double, 6, 4>>& columns, const std::vector<double>& mu) {
  if (columns.empty()) return Eigen::MatrixXd(6, 0);
  Eigen::MatrixXd all(6, 4 * columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    all.middleCols<4>(static_cast<Eigen::Index>(4 * i)) =
        columns[i] * Eigen::Vector4d(1, mu[i], mu[i], mu[i]).asDiagonal();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(all, Eigen::ComputeFullU);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > kFlat * svd.singularValues()[0]) ++rank;
  return svd.matrixU().leftCols(rank);
}

// max t  subject to  sum_j l_j w_j - t d = 0,  sum_j l_j + s = 1,  l, t, s >= 0:
// a revised simplex with the basis solved anew per pivot.
class RayProgramme {
 public:
  RayProgramme(const Eigen::VectorXd& d, double size)
      : rows_(d.size() + 1), d_(d), b_(rows_), basis_(Eigen::MatrixXd::Identity(rows_, rows_)) {
    for (Eigen::Index i = 0; i < d.size(); ++i) b_[i] = kPerturbation * size * (1 + 0.1 * static_cast<double>(i));
    b_[d.size()] = 1;
    cost_ = Eigen::VectorXd::Constant(rows_, -kArtificial / size);
    cost_[d.size()] = 0;  // the slack
    factorise();
  }

  double price(const Eigen::VectorXd& column, double cost) const { return cost - dual_.dot(column); }
  Eigen::VectorXd rayColumn() const { return (Eigen::VectorXd(rows_) << -d_, 0).finished(); }
  Eigen::VectorXd slackColumn() const { return Eigen::VectorXd::Unit(rows_, rows_ - 1); }
  Eigen::VectorXd normal() const { return -dual_.head(rows_ - 1); }

  // False if nothing bounds the column (which W, being bounded, can't do but by round-off).
  bool enter(const Eigen::VectorXd& column, double cost) {
    const Eigen::VectorXd step = lu_.solve(column);
    Eigen::Index leaving = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < rows_; ++i) {
      if (step[i] <= kFlat * step.cwiseAbs().maxCoeff()) continue;
      const double ratio = std::max(x_[i], 0.0) / step[i];
      if (ratio < least) {
        least = ratio;
        leaving = i;
      }
    }
    if (leaving < 0) return false;
    basis_.col(leaving) = column;
    cost_[leaving] = cost;
    factorise();
    return true;
  }

  double objective() const {
    double t = 0;
    for (Eigen::Index i = 0; i < rows_; ++i) t += cost_[i] > 0 ? x_[i] : 0;
    return t;
  }

 private:
  void factorise() {
    lu_.compute(basis_);
    x_ = lu_.solve(b_);
    dual_ = basis_.transpose().partialPivLu().solve(cost_);
  }

  Eigen::Index rows_;
  Eigen::VectorXd d_, b_, cost_, x_, dual_;
  Eigen::MatrixXd basis_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace

WrenchSet::WrenchSet(const std::vector<GraspContact>& contacts, const Vec3& p_WC, double rho) {
  if (!(rho > 0 && std::isfinite(rho))) {
    throw InputError(
        fmt::format("length for torques = {} is out of range (0, inf). It is in metres; take the body's radius.", rho));
  }
  for (const GraspContact& c : contacts) {
    columns_.push_back(graspColumns(c, p_WC, rho));
    mu_.push_back(c.mu);
    size_ = std::max(size_, columns_.back().col(0).norm() + c.mu * columns_.back().rightCols<3>().norm());
  }
  basis_ = spanOf(columns_, mu_);
  PINCER_ASSERT((basis_.transpose() * basis_).isIdentity(1e-12));
}

double WrenchSet::support(const Vec6& d) const {
  double h = 0;
  extreme(d, h);
  return std::max(h, 0.0);
}

// The wrench, in the span's coordinates, that goes furthest along d, 0 not among the choices; `h`: how far.
Eigen::VectorXd WrenchSet::extreme(const Vec6& d, double& h) const {
  h = -std::numeric_limits<double>::infinity();
  Vec6 furthest = Vec6::Zero();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    Eigen::Vector4d s = columns_[i].transpose() * d;
    const double length = s.tail<3>().norm(), reach = s[0] + mu_[i] * length;
    if (!(reach > h)) continue;
    h = reach;
    s[0] = 1;
    s.tail<3>() *= length > 0 ? mu_[i] / length : 0;
    furthest = columns_[i] * s;
  }
  return basis_.transpose() * furthest;
}

WrenchSet::Exit WrenchSet::shoot(const Vec6& w) const {
  PINCER_ASSERT(w.allFinite() && !w.isZero(0));  // a direction
  const Eigen::VectorXd d = basis_.transpose() * w.normalized();
  if (rank() == 0 || (basis_ * d - w.normalized()).norm() > kFlat) return {};
  RayProgramme programme(d, size_);
  const Eigen::VectorXd ray = programme.rayColumn();
  for (int pivot = 0; pivot < kMostPivots; ++pivot) {
    double h = 0;
    Eigen::VectorXd column(d.size() + 1);
    column << extreme(basis_ * programme.normal(), h), 1;
    const double of_ray = programme.price(ray, 1), of_wrench = programme.price(column, 0);
    const double of_slack = programme.price(programme.slackColumn(), 0);
    if (std::max({of_ray, of_wrench, of_slack}) <= kOptimal * size_) break;
    const bool entered = of_ray >= std::max(of_wrench, of_slack) ? programme.enter(ray, 1)
                         : of_wrench >= of_slack                 ? programme.enter(column, 0)
                                                                 : programme.enter(programme.slackColumn(), 0);
    if (!entered) break;
  }
  const double t = programme.objective();
  if (!(t > 1e2 * kPerturbation * size_)) return {};
  return {t / w.norm(), (basis_ * programme.normal()).normalized()};
}

std::vector<Vec6> WrenchSet::searchDirections() const {
  std::vector<Vec6> all;
  for (int i = 0; i < 6; ++i) {
    all.push_back(basis_.col(i));
    all.push_back(-basis_.col(i));
  }
  Directions more;
  for (int i = 0; i < kRandomDirections; ++i) all.push_back(more.next());
  return all;
}

WrenchSet::Ball WrenchSet::largestBall() const {
  Ball ball;
  if (rank() < 6) {
    if (rank() > 0) ball.weakest = Eigen::JacobiSVD<Eigen::MatrixXd>(basis_, Eigen::ComputeFullU).matrixU().col(5);
    return ball;
  }
  ball.radius = std::numeric_limits<double>::infinity();
  for (Vec6 d : searchDirections()) {
    for (int turn = 0; turn < kMostTurns; ++turn) {
      const Exit exit = shoot(d);
      if (exit.t == 0) return {0, d};
      const bool settled = exit.normal.dot(d) > 1 - 1e-15;
      d = exit.normal;
      if (settled) break;
    }
    const double radius = support(d);
    if (radius < ball.radius) ball = {radius, d};
  }
  return ball;
}

double WrenchSet::volume() const {
  if (rank() < 6) return 0;
  Directions directions;
  double sum = 0;
  for (int k = 0; k < kVolumeDirections; ++k) {
    const double t = shoot(directions.next()).t;
    if (t == 0) return 0;
    sum += math::cube(t * t);
  }
  return math::cube(std::numbers::pi) / 6 * sum / kVolumeDirections;
}

}  // namespace pincer::grasp
