#include "pincer/tasks/run/servo/touch_calibration.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

using Unknowns = Eigen::Matrix<double, 5, 1>;  // psi, t, d
using Normal = Eigen::Matrix<double, 5, 5>;

constexpr int kMostSteps = 60;           // of Gauss and Newton: ends a search that doesn't converge; chosen
constexpr double kEnough = 1e-12;        // of a step [rad, m]
constexpr double kStartDistance = 0.02;  // [m]
constexpr double kStartTurns[] = {0, -0.3, 0.3, -0.6, 0.6};  // a session takes bases within 30 degrees [rad]
constexpr double kMostResidual = 1e-3;                       // the handles weren't together [m]
constexpr double kMostOffsetError = 0.5e-3, kMostTurnError = 0.2 * std::numbers::pi / 180;  // [m], [rad]

Mat3 aboutZ(double psi) {
  const double c = math::cos(psi), s = math::sin(psi);
  Mat3 R;
  R << c, -s, 0, s, c, 0, 0, 0, 1;
  return R;
}

class Fit {
 public:
  Fit(std::span<const HandleTouch> touches, const Vec3& centre) : touches_(touches), centre_(centre) {}

  double errorAt(const Unknowns& x, const HandleTouch& touch) const { return gap(x, touch).norm() - x[4]; }
  double squares(const Unknowns& x) const {
    double sum = 0;
    for (const HandleTouch& touch : touches_) sum += errorAt(x, touch) * errorAt(x, touch);
    return sum;
  }
  Unknowns from(double psi) const {
    Unknowns x = Unknowns::Zero();
    x[0] = psi;
    Vec3 mean = Vec3::Zero();
    for (const HandleTouch& touch : touches_) mean += gap(x, touch);
    x.segment<3>(1) = mean / static_cast<double>(touches_.size());
    x[4] = kStartDistance;
    return x;
  }
  // Steps that are halved until they help.
  Unknowns solved(Unknowns x) const {
    double now = squares(x);
    for (int k = 0; k < kMostSteps; ++k) {
      Unknowns rhs;
      const Normal N = normal(x, rhs);
      // A hair of damping: where all directions of the gaps are alike, d and t can't be
      // told apart, and the errors below say so.
      const Unknowns step = (N + 1e-9 * Normal::Identity()).ldlt().solve(rhs);
      double share = 1;
      while (share > 1e-6 && squares(x - share * step) > now) share *= 0.5;
      x -= share * step;
      now = squares(x);
      if (share * step.cwiseAbs().maxCoeff() < kEnough) break;
    }
    return x;
  }
  Normal normal(const Unknowns& x, Unknowns& rhs) const {
    Normal N = Normal::Zero();
    rhs.setZero();
    for (const HandleTouch& touch : touches_) {
      const Unknowns g = slope(x, touch);
      N += g * g.transpose();
      rhs += errorAt(x, touch) * g;
    }
    return N;
  }

 private:
  Vec3 gap(const Unknowns& x, const HandleTouch& touch) const {
    return touch.a_W - centre_ - x.segment<3>(1) - aboutZ(x[0]) * (touch.b_W - centre_);
  }
  Unknowns slope(const Unknowns& x, const HandleTouch& touch) const {
    const Vec3 g = gap(x, touch), n = g / std::max(g.norm(), 1e-12);
    Unknowns row;
    row[0] = -n.dot(Vec3::UnitZ().cross(aboutZ(x[0]) * (touch.b_W - centre_)));
    row.segment<3>(1) = -n;
    row[4] = -1;
    return row;
  }

  std::span<const HandleTouch> touches_;
  Vec3 centre_;
};

// The best of several turns to start from.
Unknowns bestOf(const Fit& fit) {
  Unknowns best = fit.solved(fit.from(0));
  for (const double psi : kStartTurns) {
    const Unknowns x = fit.solved(fit.from(psi));
    if (x[4] > 0 && (best[4] <= 0 || fit.squares(x) < fit.squares(best))) best = x;
  }
  return best;
}

// The place without which the others fit best, and how far it is from their fit. (The largest error
// of a common fit may be a sound place's.)
void findWorst(std::span<const HandleTouch> touches, const Vec3& reset_B_W, TouchFinding& found) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    std::vector<HandleTouch> others(touches.begin(), touches.end());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const Fit fit(others, reset_B_W);
    const Unknowns x = bestOf(fit);
    if (fit.squares(x) >= least) continue;
    least = fit.squares(x);
    found.worst = i;
    found.worst_error = std::abs(fit.errorAt(x, touches[i]));
  }
}

}  // namespace

TouchFinding findBase(std::span<const HandleTouch> touches, const Vec3& reset_B_W) {
  if (touches.size() < kFewestTouches)
    throw InputError(
        fmt::format("{} places are too few: hold the handles together at {} or more.", touches.size(), kFewestTouches));
  const Fit fit(touches, reset_B_W);
  const Unknowns best = bestOf(fit);
  TouchFinding found{{best.segment<3>(1), best[0]}, best[4]};
  found.residual = std::sqrt(fit.squares(best) / static_cast<double>(touches.size()));
  findWorst(touches, reset_B_W, found);
  Unknowns unused;
  const Normal inverse = (fit.normal(best, unused) + 1e-12 * Normal::Identity()).ldlt().solve(Normal::Identity());
  constexpr double kSmallest = 20e-6;  // of an encoder's steps: a fit that is better than they are is luck [m]
  const double freedom = static_cast<double>(touches.size()) - 5;
  const double sigma = std::max(kSmallest, std::sqrt(fit.squares(best) / freedom));
  found.sure_turn = sigma * std::sqrt(inverse(0, 0));
  found.sure_offset = sigma * std::sqrt(inverse.diagonal().segment<3>(1).maxCoeff());
  return found;
}

std::string touchOddity(const TouchFinding& found) {
  if (found.residual > kMostResidual) {
    return fmt::format(
        "The places don't fit: {:.1f} mm (rms), place {} by {:.1f} mm. The handles weren't together there, or one let "
        "go. Again.",
        1e3 * found.residual, found.worst + 1, 1e3 * found.worst_error);
  }
  if (!(found.sure_offset <= kMostOffsetError) || !(found.sure_turn <= kMostTurnError)) {
    return fmt::format(
        "The places don't say it well enough: {:.1f} mm and {:.2f} degrees may be wrong. Go farther apart with them, "
        "and turn the pair of "
        "handles about each other: one above the other, beside it, before it.",
        1e3 * found.sure_offset, 180 / std::numbers::pi * found.sure_turn);
  }
  return "";
}

}  // namespace pincer::tasks
