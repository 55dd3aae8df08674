#include "engine/solve/point_wedge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pincer::engine {
namespace {

constexpr int kSteps = 24;         // to each side of where a wall's slip is least, each
constexpr double kGrowth = 4;      // times as long as the one before: from a tenth of its width there over some ten decades
constexpr double kNarrow = 1e-12;  // of y_0: walls that agree have no width
constexpr int kHalvings = 100;     // at most: until there is no number in between
constexpr double kFlat = 1e-12;    // |a_0 x a_1| of |a_0| |a_1|: of walls in one plane there is no groove

const ContactSide& pointSide(const ContactProblem& problem, int i) {
  const ContactSides& sides = problem.sides[static_cast<std::size_t>(i)];
  return sides[0].mover >= 0 ? sides[0] : sides[1];
}

// One wall: its slip as a function of s, and what its unit impulse does to y.
struct Wall {
  Vec3 a, row[2];     // A's normal row and the others
  double c[2], d[2];  // u_T = c + s d
  double mu;
  double least, width;  // s where |u_T| is least, and how far from there it is 1.4 times that

  Wall(const ContactProblem& problem, int i) : mu(problem.friction(i)) {
    const ContactSide& side = pointSide(problem, i);
    a = Vec3(side.A[kNormalRow]);
    for (int k = 0; k < 2; ++k) row[k] = Vec3(side.A[k]);
  }
  void setGroove(const double* q, const Vec3& y_0, const Vec3& e) {
    for (int k = 0; k < 2; ++k) {
      c[k] = row[k].dot(y_0) + q[k];
      d[k] = row[k].dot(e);
    }
    const double d2 = d[0] * d[0] + d[1] * d[1];
    least = -(c[0] * d[0] + c[1] * d[1]) / d2;
    width = std::abs(c[0] * d[1] - c[1] * d[0]) / d2;
  }
  // Slips' directions times -mu, zero where it doesn't slip.
  void friction(double s, double (&t)[2]) const {
    for (int k = 0; k < 2; ++k) t[k] = c[k] + s * d[k];
    const double slip = std::sqrt(t[0] * t[0] + t[1] * t[1]);
    for (double& component : t) component *= slip > 0 ? -mu / slip : 0;
  }
  Vec3 push(double s) const {
    double t[2];
    friction(s, t);
    return a + t[0] * row[0] + t[1] * row[1];
  }
};

struct Groove {
  Wall wall[2];
  Vec3 e, y_0;
  bool is_sound = false;

  explicit Groove(const ContactProblem& problem) : wall{{problem, 0}, {problem, 1}} {
    const Vec3 &a = wall[0].a, &b = wall[1].a;
    const Vec3 across = a.cross(b);
    const double length = across.norm();
    if (!(length > kFlat * a.norm() * b.norm())) return;
    e = across / length;
    // a . y_0 = -q_0n, b . y_0 = -q_1n, e . y_0 = 0
    const double* const q = problem.q.data();
    y_0 = (-q[kNormalRow] * b.cross(e) - q[problem.firstRow(1) + kNormalRow] * e.cross(a)) / length;
    for (int i = 0; i < 2; ++i) wall[i].setGroove(q + problem.firstRow(i), y_0, e);
    is_sound = true;
  }
  double f(double s) const { return wall[0].push(s).cross(wall[1].push(s)).dot(y_0 + s * e); }

  // Whether rho_0, rho_1 >= 0 there, by least squares, of which nothing is left over at a root: f also changes its sign where a wall sticks, and jumps.
  bool impulses(double s, double (&rho)[2]) const {
    const Vec3 g = wall[0].push(s), h = wall[1].push(s), y = y_0 + s * e, normal = g.cross(h);
    const double n2 = normal.squaredNorm();
    rho[0] = y.cross(h).dot(normal) / n2;
    rho[1] = g.cross(y).dot(normal) / n2;
    constexpr double kLeftOver = 1e-6;  // relative; the residual of the law judges in the end
    return rho[0] >= 0 && rho[1] >= 0 && (rho[0] * g + rho[1] * h - y).norm() <= kLeftOver * y.norm();
  }
  double root(double low, double high) const {
    const bool rises = f(low) < 0;
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = 0.5 * (low + high);
      if (!(middle > low && middle < high)) break;
      ((f(middle) < 0) == rises ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

}  // namespace

bool isPointWedge(const ContactProblem& problem) {
  if (problem.contactCount() != 2 || problem.movers != 1) return false;
  for (int i = 0; i < 2; ++i) {
    if (problem.rows(i) != kTorsionRow || !(problem.friction(i) > 0) || !pointSide(problem, i).is_point) return false;
  }
  return true;
}

bool slideInWedge(const ContactProblem& problem, VectorMap r) {
  const Groove groove(problem);
  if (!groove.is_sound) return false;
  double places[4 * kSteps + 2];
  int count = 0;
  for (const Wall& wall : groove.wall) {
    double step = 0.1 * std::max(wall.width, kNarrow * (groove.y_0.norm() + std::abs(wall.least)));
    places[count++] = wall.least;
    for (int n = 0; n < kSteps; ++n, step *= kGrowth) {
      places[count++] = wall.least - step;
      places[count++] = wall.least + step;
    }
  }
  std::sort(places, places + count);
  bool found = false;
  double best = 0;
  for (int n = 0; n + 1 < count; ++n) {
    if (!(places[n] < places[n + 1]) || (groove.f(places[n]) < 0) == (groove.f(places[n + 1]) < 0)) continue;
    const double s = groove.root(places[n], places[n + 1]);
    double rho[2];
    if (!groove.impulses(s, rho) || (found && std::abs(s) >= std::abs(best))) continue;
    found = true;
    best = s;
    for (int i = 0; i < 2; ++i) {
      double t[2];
      groove.wall[i].friction(s, t);
      double* const r_i = r.data() + problem.firstRow(i);
      for (int k = 0; k < 2; ++k) r_i[k] = rho[i] * t[k];
      r_i[kNormalRow] = rho[i];
    }
  }
  return found;
}

}  // namespace pincer::engine
