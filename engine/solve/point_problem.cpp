#include "pincer/engine/solve/point_problem.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pincer/engine/solve/inverse3.h"
#include "pincer/engine/solve/local_contact.h"
#include "pincer/engine/solve/residual.h"

namespace pincer::engine {
namespace {

constexpr int kMostWalls = 4;  // of one point; more go to the general methods
constexpr int kSteps = 48;     // to each side of where a wall's slip is least, each
constexpr double kGrowth = 2;  // times as long as the one before: from a tenth of its width there over fourteen decades
constexpr double kNarrow = 1e-12;           // of y_0: walls that agree have no width
constexpr int kHalvings = 100;              // at most: until there is no number in between
constexpr int kTurnSteps = 20;              // of a search for two roots between two steps
constexpr double kFlat = 1e-12;             // |a_0 x a_1| of |a_0| |a_1|: of walls in one plane there is no groove
constexpr std::int64_t kPerGroove = 40000;  // multiplications: some 400 looks at f
constexpr std::int64_t kPerAttempt = 500;   // of a set of one or three walls

const ContactSide& pointSide(const ContactProblem& problem, int i) {
  const std::span<const ContactSide> sides = problem.sidesOf(i);
  return sides[0].mover >= 0 ? sides[0] : sides[1];
}

// One wall: what the point's motion does at it, and what its unit impulse does to y.
struct Wall {
  Vec3 a, row[2];  // A's normal row and the others
  Vec3 q;
  double mu;

  Wall(const ContactProblem& problem, int i) : q(problem.q.data() + problem.firstRow(i)), mu(problem.friction(i)) {
    const ContactSide& side = pointSide(problem, i);
    a = Vec3(side.A[kNormalRow]);
    for (int k = 0; k < 2; ++k) row[k] = Vec3(side.A[k]);
  }
  // The direction of its impulse while the point slides by `u_T`: the normal row of 1; without slip no friction.
  Vec3 impulse(const double (&u_T)[2]) const {
    const double slip = std::sqrt(u_T[0] * u_T[0] + u_T[1] * u_T[1]), share = slip > 0 ? -mu / slip : 0;
    return {share * u_T[0], share * u_T[1], 1};
  }
  Vec3 impulse(const Vec3& y) const { return impulse({row[0].dot(y) + q[0], row[1].dot(y) + q[1]}); }
  Vec3 push(const Vec3& impulse) const { return a + impulse[0] * row[0] + impulse[1] * row[1]; }
};

// Two walls, and where the point may be without leaving either: s = s_0 + sigma, s_0 where the slip of that wall is
// least which is quicker to turn, so that there is a number for each direction of friction.
class Groove {
 public:
  Groove(const Wall& x, const Wall& y) : wall_{&x, &y} {
    const Vec3 &a = x.a, &b = y.a, across = a.cross(b);
    const double length = across.norm();
    if (!(length > kFlat * a.norm() * b.norm())) return;
    e_ = across / length;
    // a . y_0 = -q_0n, b . y_0 = -q_1n, e . y_0 = 0
    y_0_ = (-x.q[kNormalRow] * b.cross(e_) - y.q[kNormalRow] * e_.cross(a)) / length;
    for (int i = 0; i < 2; ++i) setSlip(i);
    const double s_0 = slip_[std::abs(slip_[0].width) <= std::abs(slip_[1].width) ? 0 : 1].least;
    narrow_ = kNarrow * (y_0_.norm() + std::abs(s_0));
    for (Slip& slip : slip_) slip.least -= s_0;
    y_0_ += s_0 * e_;
    is_sound_ = true;
  }
  bool isSound() const { return is_sound_; }

  // Calls act(r_0, r_1) with the impulses at each root that has rho_i >= 0, until it returns true; whether it did.
  template <class Act>
  bool untilRoot(const Act& act) const {
    double places[kPlaces];
    Point before[2] = {};
    fillPlaces(places);
    for (int n = 0; n < kPlaces; ++n) {
      const Point point = at(places[n]);
      if (n > 0 && tryBetween(before[1], point, act)) return true;
      if (n > 1 && turnsBack(before[0], before[1], point) && tryTurn(before[0], before[1], point, act)) return true;
      before[0] = before[1];
      before[1] = point;
    }
    return false;
  }

 private:
  static constexpr int kPlaces = 2 * (2 * kSteps + 1);  // of both walls: the least, kSteps on either side

  struct Slip {
    double d[2];   // u_T = (sigma - least) d + width (-d_2, d_1): how fast it grows, from where it is least
    double least;  // how far from there it is 1.4 times that is |width|
    double width;
  };
  struct Point {
    double sigma, f;
  };

  void setSlip(int i) {
    Slip& slip = slip_[i];
    double c[2];  // u_T = c + s d
    for (int k = 0; k < 2; ++k) {
      c[k] = wall_[i]->row[k].dot(y_0_) + wall_[i]->q[k];
      slip.d[k] = wall_[i]->row[k].dot(e_);
    }
    const double d2 = slip.d[0] * slip.d[0] + slip.d[1] * slip.d[1];
    slip.least = -(c[0] * slip.d[0] + c[1] * slip.d[1]) / d2;
    slip.width = (c[1] * slip.d[0] - c[0] * slip.d[1]) / d2;
  }

  void fillPlaces(double (&places)[kPlaces]) const {
    int count = 0;
    for (const Slip& slip : slip_) {
      double step = 0.1 * std::max(std::abs(slip.width), narrow_);
      places[count++] = slip.least;
      for (int n = 0; n < kSteps; ++n, step *= kGrowth) {
        places[count++] = slip.least - step;
        places[count++] = slip.least + step;
      }
    }
    std::sort(places, places + kPlaces);
  }

  Vec3 impulse(int i, double sigma) const {
    const Slip& slip = slip_[i];
    const double along = sigma - slip.least;
    return wall_[i]->impulse({along * slip.d[0] - slip.width * slip.d[1], along * slip.d[1] + slip.width * slip.d[0]});
  }
  Vec3 push(int i, double sigma) const { return wall_[i]->push(impulse(i, sigma)); }
  Point at(double sigma) const { return {sigma, push(0, sigma).cross(push(1, sigma)).dot(y_0_ + sigma * e_)}; }

  template <class Act>
  bool tryBetween(Point low, Point high, const Act& act) const {
    if (!(low.sigma < high.sigma) || (low.f < 0) == (high.f < 0)) return false;
    for (int n = 0; n < kHalvings; ++n) {
      const Point middle = at(0.5 * (low.sigma + high.sigma));
      if (!(middle.sigma > low.sigma && middle.sigma < high.sigma)) break;
      ((middle.f < 0) == (low.f < 0) ? low : high) = middle;
    }
    Vec3 r[2];
    return impulses(0.5 * (low.sigma + high.sigma), r) && act(r[0], r[1]);
  }

  // True if f comes nearest to 0 in the middle, without a change of its sign.
  static bool turnsBack(const Point& x, const Point& y, const Point& z) {
    return x.sigma < y.sigma && y.sigma < z.sigma && (x.f < 0) == (y.f < 0) && (y.f < 0) == (z.f < 0) &&
           std::abs(y.f) < std::abs(x.f) && std::abs(y.f) <= std::abs(z.f);
  }
  // Follows f to where it is nearest to 0, in case that it is beyond.
  template <class Act>
  bool tryTurn(Point low, Point middle, Point high, const Act& act) const {
    for (int n = 0; n < kTurnSteps; ++n) {
      const bool is_below = middle.sigma - low.sigma > high.sigma - middle.sigma;
      const Point next = at(0.5 * (middle.sigma + (is_below ? low : high).sigma));
      if ((next.f < 0) != (middle.f < 0)) {
        return is_below ? tryBetween(low, next, act) || tryBetween(next, middle, act)
                        : tryBetween(middle, next, act) || tryBetween(next, high, act);
      }
      const bool is_nearer = std::abs(next.f) < std::abs(middle.f);
      if (is_nearer) {
        (is_below ? high : low) = middle;
        middle = next;
      } else {
        (is_below ? low : high) = next;
      }
    }
    return false;
  }

  // rho_i by least squares, of which nothing is left over at a root: f also changes its sign where a wall sticks,
  // and jumps. The residual of the law judges.
  bool impulses(double sigma, Vec3 (&r)[2]) const {
    const Vec3 g = push(0, sigma), h = push(1, sigma), y = y_0_ + sigma * e_, normal = g.cross(h);
    const double n2 = normal.squaredNorm(), rho[2] = {y.cross(h).dot(normal) / n2, g.cross(y).dot(normal) / n2};
    for (int i = 0; i < 2; ++i) r[i] = rho[i] * impulse(i, sigma);
    return rho[0] >= 0 && rho[1] >= 0;
  }

  const Wall* wall_[2];
  Slip slip_[2];
  Vec3 e_, y_0_;
  double narrow_ = 0;
  bool is_sound_ = false;
};

class PointSearch {
 public:
  PointSearch(const ContactProblem& problem, double enough, SolverScratch& scratch, double* r, double* u)
      : problem_(problem), enough_(enough), scratch_(scratch), r_(r), u_(u), count_(problem.contactCount()) {}

  bool run(double& residual) {
    const bool found = pushedByOne() || pushedByTwo() || pushedByThree();
    if (found) residual = residual_;
    return found;
  }

 private:
  Wall wall(int i) const { return {problem_, i}; }

  struct Pushed {
    int wall;
    Vec3 r;
  };
  // True if the impulses of these walls alone are the answer.
  bool isAnswer(std::initializer_list<Pushed> pushed) {
    std::fill(r_, r_ + problem_.rowCount(), 0.0);
    for (const Pushed& p : pushed) std::copy(p.r.data(), p.r.data() + kTorsionRow, r_ + problem_.firstRow(p.wall));
    residual_ = errorOf(problem_, r_, scratch_, u_).residual;
    return residual_ <= enough_;
  }

  bool pushedByOne() {
    for (int i = 0; i < count_; ++i) {
      if (!spend(kPerAttempt, scratch_)) return false;
      const Wall w = wall(i);
      const Vec3* const rows[] = {&w.row[0], &w.row[1], &w.a};
      double W[kTorsionRow * kTorsionRow];
      for (int k = 0; k < kTorsionRow; ++k) {
        for (int l = 0; l < kTorsionRow; ++l) W[kTorsionRow * k + l] = rows[k]->dot(*rows[l]);
      }
      Vec3 r;
      solveOneContact(W, kTorsionRow, w.q.data(), kTorsionRow, w.mu, r.data());
      if (isAnswer({{i, r}})) return true;
    }
    return false;
  }

  bool pushedByTwo() {
    for (int i = 0; i < count_; ++i) {
      for (int j = i + 1; j < count_; ++j) {
        if (!spend(kPerGroove, scratch_)) return false;
        const Wall walls[] = {wall(i), wall(j)};
        const Groove groove(walls[0], walls[1]);
        if (groove.isSound() && groove.untilRoot([&](const Vec3& r_i, const Vec3& r_j) {
              return isAnswer({{i, r_i}, {j, r_j}});
            }))
          return true;
      }
    }
    return false;
  }

  bool pushedByThree() {
    for (int i = 0; i < count_; ++i) {
      for (int j = i + 1; j < count_; ++j) {
        for (int k = j + 1; k < count_; ++k) {
          if (!spend(kPerAttempt, scratch_)) return false;
          if (isSlideOnThree({i, j, k})) return true;
        }
      }
    }
    return false;
  }

  bool isSlideOnThree(const std::array<int, 3>& of) {
    const Wall walls[] = {wall(of[0]), wall(of[1]), wall(of[2])};
    Mat3 normals, pushes;
    Vec3 asked, impulses[3];
    for (int n = 0; n < 3; ++n) {
      normals.col(n) = walls[n].a;
      asked[n] = -walls[n].q[kNormalRow];
    }
    Vec3 y, rho;
    if (!solve(normals.transpose(), asked, y)) return false;
    for (int n = 0; n < 3; ++n) {
      impulses[n] = walls[n].impulse(y);
      pushes.col(n) = walls[n].push(impulses[n]);
    }
    if (!solve(pushes, y, rho) || !(rho.minCoeff() >= 0)) return false;
    return isAnswer({{of[0], rho[0] * impulses[0]}, {of[1], rho[1] * impulses[1]}, {of[2], rho[2] * impulses[2]}});
  }

  // False if A is singular or not finite.
  static bool solve(const Mat3& A, const Vec3& b, Vec3& x) {
    Mat3 inverse;
    if (!invert3<3>(A.data(), inverse.data())) return false;
    x = inverse * b;
    return true;
  }

  const ContactProblem& problem_;
  const double enough_;
  SolverScratch& scratch_;
  double *const r_, *const u_;
  const int count_;
  double residual_ = 0;
};

}  // namespace

bool isPointProblem(const ContactProblem& problem) {
  const int n = problem.contactCount();
  if (n < 2 || n > kMostWalls || problem.movers != 1) return false;
  for (int i = 0; i < n; ++i) {
    if (problem.rows(i) != kTorsionRow || !pointSide(problem, i).is_point) return false;
  }
  return true;
}

bool solvePointProblem(const ContactProblem& problem, double enough, SolverScratch& scratch, double* r, double* u,
                       double& residual) {
  double before[kMostWalls * kTorsionRow];
  const int m = problem.rowCount();
  std::copy(r, r + m, before);
  if (PointSearch(problem, enough, scratch, r, u).run(residual)) return true;
  std::copy(before, before + m, r);
  errorOf(problem, r, scratch, u);
  return false;
}

}  // namespace pincer::engine
