#include "pincer/tasks/judge/exact/clearance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/judge/exact/runge_kutta.h"

namespace pincer::exact {
namespace {

using Model = ClearanceCrank;
using State = ClearanceCrank::State;
using Six = Eigen::Matrix<double, 6, 1>;

constexpr int kCorners = 4;
constexpr double kStep = 5e-6;       // of Runge-Kutta's method [s]
constexpr double kTouching = 1e-12;  // gap below which a corner touches [m]
constexpr double kLanding = 1e-5;    // a corner that would bounce with less stays: its flight were 1e-7 s [m/s]
constexpr double kAtRest = 1e-9;     // below it a corner neither closes nor slides [m/s]
constexpr double kGone = 1e-15;      // an open corner this far beyond its side has hit [m]
constexpr double kRoundOff = 1e-11;  // of the largest force and acceleration, or impulse and velocity [-]

enum class Touch { kOpen, kStick, kForth, kBack };  // slides along x or against it
using Touches = std::array<Touch, kCorners>;
constexpr Touches kFlies{Touch::kOpen, Touch::kOpen, Touch::kOpen, Touch::kOpen};

double sideOf(int corner) { return corner < 2 ? 1 : -1; }
Vec2 along(double angle) { return {math::cos(angle), math::sin(angle)}; }
Vec2 across(const Vec2& r) { return {-r.y(), r.x()}; }
Vec2 arm(const Model& m, int corner, const Vec3& angle) {
  const Vec2 u = along(angle[2]);
  return (corner % 2 == 0 ? -m.half_length : m.half_length) * u + sideOf(corner) * m.half_height * across(u);
}

Mat3 massMatrix(const Model& m, const Vec3& angle) {
  const double outer = m.rod_mass / 2 + m.slider_mass;
  Mat3 M = Mat3::Zero();
  M(0, 0) = m.crank_inertia + (m.crank_mass / 4 + m.rod_mass + m.slider_mass) * m.crank * m.crank;
  M(1, 1) = m.rod_inertia + (m.rod_mass / 4 + m.slider_mass) * m.rod * m.rod;
  M(0, 1) = M(1, 0) = outer * m.crank * m.rod * math::cos(angle[0] - angle[1]);
  M(2, 2) = m.slider_inertia;
  return M;
}
Vec3 smoothForce(const Model& m, const State& s) {
  const double outer = m.rod_mass / 2 + m.slider_mass;
  const double k = outer * m.crank * m.rod * math::sin(s.angle[0] - s.angle[1]);
  return {-k * s.rate[1] * s.rate[1] -
              (m.crank_mass / 2 + m.rod_mass + m.slider_mass) * m.g * m.crank * math::cos(s.angle[0]),
          k * s.rate[0] * s.rate[0] - outer * m.g * m.rod * math::cos(s.angle[1]), 0};
}

// Rows: a corner's way along x, and its gap's.
Eigen::Matrix<double, 2, 3> slopes(const Model& m, int corner, const Vec3& angle) {
  Eigen::Matrix<double, 2, 3> J;
  J << m.crank * across(along(angle[0])), m.rod * across(along(angle[1])), across(arm(m, corner, angle));
  J.row(1) *= -sideOf(corner);
  return J;
}
// Of the accelerations of both at a'' = 0.
Vec2 turning(const Model& m, int corner, const State& s) {
  const Vec2 p = -s.rate[0] * s.rate[0] * m.crank * along(s.angle[0]) -
                 s.rate[1] * s.rate[1] * m.rod * along(s.angle[1]) - s.rate[2] * s.rate[2] * arm(m, corner, s.angle);
  return {p.x(), -sideOf(corner) * p.y()};
}

// The corners together, (x, gap) of each in turn: impulses r [N s] and velocities y [m/s], or forces and
// accelerations. y = W r + b, W = J M^-1 J^T.
using Eight = Eigen::Matrix<double, 2 * kCorners, 1>;

class Corners {
 public:
  Corners(const Model& model, const Vec3& angle) : friction_(model.friction) {
    for (int i = 0; i < kCorners; ++i) J_.middleRows<2>(2 * i) = slopes(model, i, angle);
    push_ = massMatrix(model, angle).ldlt().solve(J_.transpose());
    W_ = J_ * push_;
  }

  const Eigen::Matrix<double, 2 * kCorners, 3>& slope() const { return J_; }
  Vec3 change(const Eight& r) const { return push_ * r; }  // of the rates, or accelerations

  // r with y_gap = 0 where they touch, and y_x = 0 where they stick.
  Eight answer(const Touches& touches, const Eight& b) const {
    Eigen::MatrixXd pushes = Eigen::MatrixXd::Zero(2 * kCorners, 2 * kCorners), zeros = pushes;
    Eigen::Index n = 0;
    for (int i = 0; i < kCorners; ++i) {
      const Touch touch = touches[static_cast<std::size_t>(i)];
      if (touch == Touch::kOpen) continue;
      pushes(2 * i + 1, n) = zeros(2 * i + 1, n) = 1;
      if (touch == Touch::kForth) pushes(2 * i, n) = -friction_;
      if (touch == Touch::kBack) pushes(2 * i, n) = friction_;
      ++n;
      if (touch == Touch::kStick) pushes(2 * i, n) = zeros(2 * i, n) = 1, ++n;
    }
    if (n == 0) return Eight::Zero();
    const Eigen::MatrixXd F = pushes.leftCols(n), L = zeros.leftCols(n).transpose();
    return F * Eigen::MatrixXd(L * W_ * F).completeOrthogonalDecomposition().solve(-L * b);
  }

  // The first of all ways to touch that keeps the laws. `slides`: which way a corner goes whose way is known, else 0.
  Touches lawful(const std::array<bool, kCorners>& close, const std::array<int, kCorners>& slides,
                 const Eight& b) const {
    for (int code = 0; code < 256; ++code) {
      Touches touches = kFlies;
      bool possible = true;
      for (std::size_t i = 0; i < kCorners; ++i) {
        touches[i] = static_cast<Touch>(code >> (2 * i) & 3);
        if (touches[i] == Touch::kOpen) continue;
        possible =
            possible && close[i] && (slides[i] == 0 || touches[i] == (slides[i] > 0 ? Touch::kForth : Touch::kBack));
      }
      if (possible && keepsLaws(touches, close, slides, b)) return touches;
    }
    PINCER_ASSERT(false);
    return kFlies;
  }

 private:
  bool keepsLaws(const Touches& touches, const std::array<bool, kCorners>& close,
                 const std::array<int, kCorners>& slides, const Eight& b) const {
    const Eight r = answer(touches, b), y = W_ * r + b;
    const double dr = kRoundOff * r.lpNorm<Eigen::Infinity>(), dy = kRoundOff * b.lpNorm<Eigen::Infinity>();
    for (int i = 0; i < kCorners; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!close[k]) continue;
      const Touch touch = touches[k];
      const Vec2 r_i = r.segment<2>(2 * i), y_i = y.segment<2>(2 * i);
      if (touch == Touch::kOpen ? y_i[1] < -dy : r_i[1] < -dr || std::abs(y_i[1]) > dy) return false;
      if (touch == Touch::kStick && (std::abs(y_i[0]) > dy || std::abs(r_i[0]) > friction_ * r_i[1] + dr)) return false;
      if (slides[k] != 0 || friction_ == 0) continue;
      if ((touch == Touch::kForth && y_i[0] < -dy) || (touch == Touch::kBack && y_i[0] > dy)) return false;
    }
    return true;
  }

  double friction_;
  Eigen::Matrix<double, 2 * kCorners, 3> J_;
  Eigen::Matrix<double, 3, 2 * kCorners> push_;
  Eigen::Matrix<double, 2 * kCorners, 2 * kCorners> W_;
};

Eight smoothAccelerations(const Model& m, const State& s, const Corners& corners) {
  Eight b = corners.slope() * massMatrix(m, s.angle).ldlt().solve(smoothForce(m, s));
  for (int i = 0; i < kCorners; ++i) b.segment<2>(2 * i) += turning(m, i, s);
  return b;
}
Eight forces(const Model& m, const State& s, const Touches& touches, const Corners& corners) {
  return corners.answer(touches, smoothAccelerations(m, s, corners));
}

class Course {
 public:
  Course(const Model& model, const State& start) : m_(model), s_(start) { settle(); }

  const State& state() const { return s_; }

  // To the first event in this time, if there is one; returns the time that passed. A hit is told to `hits`.
  double advance(double time, double now, std::vector<ClearanceCrank::Hit>& hits) {
    const State end = after(time);
    if (!happens(end)) {
      s_ = end;
      return time;
    }
    double low = 0, high = time;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (happens(after(middle)) ? high : low) = middle;
    }
    s_ = after(high);
    const std::vector<int> struck = hit();
    if (!struck.empty()) hits.push_back({now + high, struck});
    settle();
    return high;
  }

 private:
  State after(double time) const {
    Six y;
    y << s_.angle, s_.rate;
    const auto slope = [&](double, const Six& at) {
      const State s{at.head<3>(), at.tail<3>()};
      const Corners corners(m_, s.angle);
      Six change;
      change << s.rate,
          massMatrix(m_, s.angle).ldlt().solve(smoothForce(m_, s)) + corners.change(forces(m_, s, touches_, corners));
      return change;
    };
    y = rungeKutta(y, 0.0, time, slope);
    return {y.head<3>(), y.tail<3>()};
  }

  // True if the corners no longer do what they do in this course.
  bool happens(const State& s) const {
    const Corners corners(m_, s.angle);
    const Eight u = corners.slope() * s.rate, r = forces(m_, s, touches_, corners);
    for (int i = 0; i < kCorners; ++i) {
      const Touch touch = touches_[static_cast<std::size_t>(i)];
      const double push = r[2 * i + 1], pull = std::abs(r[2 * i]), slip = touch == Touch::kForth ? u[2 * i] : -u[2 * i];
      if (touch == Touch::kOpen) {
        if (m_.gap(i, s.angle) < -kGone && u[2 * i + 1] < 0) return true;
      } else if (push < 0 || (touch == Touch::kStick && pull > m_.friction * push * (1 + kRoundOff))) {
        return true;
      } else if (touch != Touch::kStick && m_.friction > 0 && slip < -kAtRest / 2) {
        return true;
      }
    }
    return false;
  }

  // Newton's and Coulomb's law for all corners that touch; returns those that hit.
  std::vector<int> hit() {
    const Corners corners(m_, s_.angle);
    const Eight u = corners.slope() * s_.rate;
    Eight b = u;
    std::array<bool, kCorners> close{};
    std::vector<int> struck;
    for (int i = 0; i < kCorners; ++i) {
      close[static_cast<std::size_t>(i)] = std::abs(m_.gap(i, s_.angle)) <= kTouching;
      if (!close[static_cast<std::size_t>(i)] || u[2 * i + 1] >= -kAtRest) continue;
      struck.push_back(i);
      if (-m_.restitution * u[2 * i + 1] > kLanding) b[2 * i + 1] *= 1 + m_.restitution;
    }
    if (!struck.empty()) s_.rate += corners.change(corners.answer(corners.lawful(close, {}, b), b));
    return struck;
  }

  void settle() {
    const Corners corners(m_, s_.angle);
    const Eight u = corners.slope() * s_.rate;
    std::array<bool, kCorners> close{};
    std::array<int, kCorners> slides{};
    for (int i = 0; i < kCorners; ++i) {
      const auto k = static_cast<std::size_t>(i);
      close[k] = std::abs(m_.gap(i, s_.angle)) <= kTouching && std::abs(u[2 * i + 1]) <= kAtRest;
      if (std::abs(u[2 * i]) > kAtRest || m_.friction == 0) slides[k] = u[2 * i] > 0 ? 1 : -1;
    }
    touches_ = corners.lawful(close, slides, smoothAccelerations(m_, s_, corners));
  }

  Model m_;
  State s_;
  Touches touches_ = kFlies;
};

}  // namespace

ClearanceCrank::Run ClearanceCrank::run(const State& start, double step, int hits, double longest) const {
  Course course(*this, start);
  Run run{{start}, {}};
  const int parts = static_cast<int>(std::ceil(step / kStep));
  for (double now = 0; now < longest && std::ssize(run.hits) < hits;) {
    for (int part = 0; part < parts; ++part) {
      const double part_step = step / parts;
      for (double past = 0; past < part_step;)
        past += course.advance(part_step - past, now + part * part_step + past, run.hits);
    }
    now = step * static_cast<double>(run.states.size());
    run.states.push_back(course.state());
  }
  return run;
}

Vec2 ClearanceCrank::sliderCentre(const Vec3& angle) const { return crank * along(angle[0]) + rod * along(angle[1]); }
Vec2 ClearanceCrank::corner(int which, const Vec3& angle) const {
  return sliderCentre(angle) + arm(*this, which, angle);
}
double ClearanceCrank::gap(int which, const Vec3& angle) const {
  return half_height + clearance - sideOf(which) * corner(which, angle).y();
}
double ClearanceCrank::energy(const State& s) const {
  const double height = (crank_mass / 2 + rod_mass + slider_mass) * crank * math::sin(s.angle[0]) +
                        (rod_mass / 2 + slider_mass) * rod * math::sin(s.angle[1]);
  return 0.5 * s.rate.dot(massMatrix(*this, s.angle) * s.rate) + g * height;
}

}  // namespace pincer::exact
