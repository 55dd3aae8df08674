#include "pincer/engine/solve/pad_problem.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/inverse3.h"
#include "pincer/engine/solve/lanes.h"
#include "pincer/engine/solve/linear.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/squeeze.h"
#include "pincer/engine/solve/stuck_contacts.h"
#include "pincer/engine/solve/stuck_steps.h"

namespace pincer::engine {
namespace {

constexpr int kMostPoints = 4, kMostContacts = 16, kFewestContacts = 4;
constexpr int kGroups = kMostPoints + 1;                // the last is of contacts without a point
constexpr int kPadLanes = kMostContacts + kGroups + 1;  // a group begins at an even one
constexpr int kPadRows = kTorsionRow, kPointFreedoms = 3;

using Lanes = double[kPadLanes];
constexpr Lanes kNone[kPadRows] = {};

// One block of A per kind of mover.
template <int freedoms>
using Blocks = Lanes[kPadRows][freedoms];

// sums[k] = sum over lanes [from, to) and rows of  x[row][k] y[row]
template <int freedoms>
inline void addProducts(const Blocks<freedoms>& x, const Lanes (&y)[kPadRows], int from, int to, double* sums) {
  DoublePair sum[freedoms];
  times<freedoms>([&](auto k) { sum[k] = DoublePair{0, 0}; });
  times<kPadRows>([&](auto l) {
    for (int i = from; i < to; i += 2) {
      const DoublePair y_i = pairAt(y[l] + i);
      times<freedoms>([&](auto k) { sum[k] += pairAt(x[l][k] + i) * y_i; });
    }
  });
  times<freedoms>([&](auto k) { sums[k] = sumOf(sum[k]); });
}

// out[row] = in[row] + sum over k of  x[row][k] y[k]
template <int freedoms>
inline void addImages(const Blocks<freedoms>& x, const double* y, int from, int to, const Lanes (&in)[kPadRows],
                      Lanes (&out)[kPadRows]) {
  DoublePair Y[freedoms];
  times<freedoms>([&](auto k) { Y[k] = DoublePair{y[k], y[k]}; });
  times<kPadRows>([&](auto l) {
    for (int i = from; i < to; i += 2) {
      DoublePair sum = pairAt(in[l] + i);
      times<freedoms>([&](auto k) { sum += pairAt(x[l][k] + i) * Y[k]; });
      pairAt(out[l] + i) = sum;
    }
  });
}

// out[k] = sum over lanes and rows of  x[row][k] y[row][column], k from `first` on
template <int freedoms, int first, int columns>
inline void addColumn(const Blocks<freedoms>& x, const Blocks<columns>& y, int column, int from, int to, double* out) {
  DoublePair sum[freedoms - first];
  times<freedoms - first>([&](auto k) { sum[k] = DoublePair{0, 0}; });
  times<kPadRows>([&](auto l) {
    for (int i = from; i < to; i += 2) {
      const DoublePair y_i = pairAt(y[l][column] + i);
      times<freedoms - first>([&](auto k) { sum[k] += pairAt(x[l][first + k] + i) * y_i; });
    }
  });
  times<freedoms - first>([&](auto k) { out[first + k] = sumOf(sum[k]); });
}

class PadProblem {
 public:
  // False if `problem` isn't of this kind.
  bool read(const ContactProblem& problem, const double* r) {
    if (!findMovers(problem)) return false;
    speed_ = referenceSpeed(problem);
    n_ = problem.contactCount();
    for (int i = 0; i < n_; ++i) readContact(problem, r, i);
    for (int g = 0; g < kGroups; ++g) {
      if (end_[g] % 2 == 1) clearLane(end_[g]++);
    }
    weigh();
    return true;
  }

  // u and the error of r.
  ContactError error() {
    respond(r_);
    setVelocities(q_, u_);
    WorstResidual worst;
    forEachContact([&](int i) {
      const double r[kPadRows] = {r_[0][i], r_[1][i], r_[2][i]}, u[kPadRows] = {u_[0][i], u_[1][i], u_[2][i]};
      worst.add(naturalMap2(r, u, kPadRows, mu_[i], w_[i]), u[kNormalRow], w_[i] * r[kNormalRow]);
    });
    return worst.relativeTo(speed_);
  }

  void holdWhatPushes() {
    forEachContact([&](int i) { holds_[i] = r_[kNormalRow][i] > 0; });
  }
  // As in stuck_contacts.cpp.
  bool allStayAsTheyAre() const {
    bool all = true;
    forEachContact([&](int i) {
      double y[kPadRows];
      for (int k = 0; k < kPadRows; ++k) y[k] = w_[i] * r_[k][i] - u_[k][i];
      all = all && contactMode(y, kPadRows, mu_[i]) == (holds_[i] ? ContactMode::kStick : ContactMode::kOpen);
    });
    return all;
  }
  bool holdsWith(double share) const {
    bool all = true;
    forEachContact([&](int i) {
      const double r[kPadRows] = {r_[0][i], r_[1][i], r_[2][i]};
      all = all && (!holds_[i] || (r[kNormalRow] > 0 && isInCone(r, kPadRows, share * mu_[i])));
    });
    return all;
  }
  bool maySqueeze() const {
    double largest = 0;
    forEachContact([&](int i) { largest = std::max(largest, kPadRows * w_[i] * r_[kNormalRow][i]); });
    return largest > kLargestSqueeze * speed_;
  }

  // A step from r and u. False if there is none.
  bool step() {
    Lanes change[kPadRows];
    for (int k = 0; k < kPadRows; ++k) std::fill(change[k], change[k] + lanes(), 0.0);
    forEachContact([&](int i) {
      for (int k = 0; k < kPadRows; ++k) change[k][i] = holds_[i] ? -u_[k][i] : 0;
    });
    respond(change);
    if (!factorise()) return false;
    solve();
    solve();
    setVelocities(kNone, change);
    forEachContact([&](int i) {
      for (int k = 0; k < kPadRows && holds_[i]; ++k) r_[k][i] += change[k][i];
    });
    return true;
  }

  void write(double* r, double* u) const {
    for (int n = 0; n < n_; ++n) {
      for (int k = 0; k < kPadRows; ++k) {
        r[kPadRows * n + k] = r_[k][lane_[n]];
        u[kPadRows * n + k] = u_[k][lane_[n]];
      }
    }
  }
  double speed() const { return speed_; }

 private:
  // Lanes of each group, from first_ on; end_ counts up to there. True if one of the points touches with a face.
  bool findMovers(const ContactProblem& problem) {
    const int n = problem.contactCount();
    if (n < kFewestContacts || n > kMostContacts || problem.movers > kGroups) return false;
    if (!problem.first_side.empty() || problem.rowCount() != kPadRows * n) return false;
    int body = -1, points = 0, group_of[kGroups], count[kGroups] = {};
    std::fill(group_of, group_of + kGroups, -1);
    for (int i = 0; i < n; ++i) {
      int group = kMostPoints, bodies = 0;
      for (const ContactSide& side : problem.sidesOf(i)) {
        if (side.mover < 0) continue;
        if (!side.is_point) {
          if (body >= 0 && side.mover != body) return false;
          body = side.mover;
          ++bodies;
          continue;
        }
        if (group_of[side.mover] < 0 && points == kMostPoints) return false;
        if (group_of[side.mover] < 0) group_of[side.mover] = points++;
        group = group_of[side.mover];
      }
      if (bodies == 0) return false;
      group_[i] = group;
      ++count[group];
    }
    for (int g = 0, lane = 0; g < kGroups; ++g) {
      first_[g] = end_[g] = lane;
      lane += count[g] + count[g] % 2;
    }
    points_ = points;
    return *std::max_element(count, count + kMostPoints) > 1;
  }

  void readContact(const ContactProblem& problem, const double* r, int n) {
    const int i = lane_[n] = end_[group_[n]]++;
    for (const ContactSide& side : problem.sidesOf(n)) {
      if (side.mover < 0) continue;
      times<kPadRows>([&](auto l) {
        if (side.is_point)
          times<kPointFreedoms>([&](auto k) { point_[l][k][i] = side.A[l][k]; });
        else
          times<kMoverFreedoms>([&](auto k) { body_[l][k][i] = side.A[l][k]; });
      });
    }
    for (int l = 0; l < kPadRows; ++l) {
      q_[l][i] = problem.q.data()[kPadRows * n + l];
      r_[l][i] = r[kPadRows * n + l];
    }
    mu_[i] = problem.friction(n);
  }

  void clearLane(int i) {
    for (int l = 0; l < kPadRows; ++l) {
      for (int k = 0; k < kMoverFreedoms; ++k) body_[l][k][i] = 0;
      for (int k = 0; k < kPointFreedoms; ++k) point_[l][k][i] = 0;
      q_[l][i] = r_[l][i] = 0;
    }
    mu_[i] = 0;
  }

  int lanes() const { return end_[kGroups - 1]; }
  template <class Act>
  [[gnu::always_inline]] void forEachContact(const Act& act) const {
    for (int n = 0; n < n_; ++n) act(lane_[n]);
  }

  // The mean of W_ii's diagonal.
  void weigh() {
    for (int i = 0; i < lanes(); i += 2) {
      DoublePair sum = {};
      for (int l = 0; l < kPadRows; ++l)
        times<kMoverFreedoms>([&](auto k) { sum += pairAt(body_[l][k] + i) * pairAt(body_[l][k] + i); });
      for (int l = 0; l < kPadRows && i < first_[kMostPoints]; ++l)
        times<kPointFreedoms>([&](auto k) { sum += pairAt(point_[l][k] + i) * pairAt(point_[l][k] + i); });
      pairAt(w_ + i) = sum / double{kPadRows};
    }
  }

  void respond(const Lanes (&r)[kPadRows]) {
    addProducts<kMoverFreedoms>(body_, r, 0, lanes(), y_body_);
    for (int p = 0; p < points_; ++p) addProducts<kPointFreedoms>(point_, r, first_[p], end_[p], y_point_[p]);
  }
  void setVelocities(const Lanes (&q)[kPadRows], Lanes (&u)[kPadRows]) const {
    addImages<kMoverFreedoms>(body_, y_body_, 0, lanes(), q, u);
    for (int p = 0; p < points_; ++p) addImages<kPointFreedoms>(point_, y_point_[p], first_[p], end_[p], u, u);
  }

  // N of the contacts that hold: those that don't count as 0 in one of the two factors.
  bool factorise() {
    bool all_hold = true;
    forEachContact([&](int i) { all_hold = all_hold && holds_[i]; });
    if (all_hold) return factorise(body_, point_);
    Blocks<kMoverFreedoms> body;
    Blocks<kPointFreedoms> point;
    std::copy(&body_[0][0][0], &body_[0][0][0] + sizeof(body_) / sizeof(double), &body[0][0][0]);
    std::copy(&point_[0][0][0], &point_[0][0][0] + sizeof(point_) / sizeof(double), &point[0][0][0]);
    forEachContact([&](int i) {
      for (int l = 0; l < kPadRows && !holds_[i]; ++l) {
        for (int k = 0; k < kMoverFreedoms; ++k) body[l][k][i] = 0;
        for (int k = 0; k < kPointFreedoms; ++k) point[l][k][i] = 0;
      }
    });
    return factorise(body, point);
  }

  bool factorise(const Blocks<kMoverFreedoms>& body, const Blocks<kPointFreedoms>& point) {
    times<kMoverFreedoms>(
        [&](auto j) { addColumn<kMoverFreedoms, j>(body, body_, j, 0, lanes(), normal_ + kMoverFreedoms * j); });
    double largest = 0;
    for (int j = 0; j < kMoverFreedoms; ++j) largest = std::max(largest, normal_[(kMoverFreedoms + 1) * j]);
    for (int p = 0; p < points_; ++p) {
      times<kPointFreedoms>([&](auto k) {
        addColumn<kPointFreedoms, k>(point, point_, k, first_[p], end_[p], normal_p_[p] + kPointFreedoms * k);
        addColumn<kMoverFreedoms, 0>(body, point_, k, first_[p], end_[p], coupling_[p][k]);
        largest = std::max(largest, normal_p_[p][(kPointFreedoms + 1) * k]);
      });
    }
    const double ridge = kStuckRidge * largest;
    for (int j = 0; j < kMoverFreedoms; ++j) normal_[(kMoverFreedoms + 1) * j] += ridge;
    for (int p = 0; p < points_; ++p) {
      if (!eliminate(p, ridge)) return false;
    }
    return factoriseLdlt(normal_, kMoverFreedoms);
  }

  // Point p's block becomes its inverse P^-1, its coupling C becomes P^-1 C, and the body's -= C^T P^-1 C.
  bool eliminate(int p, double ridge) {
    double* const P = normal_p_[p];
    for (int k = 0; k < kPointFreedoms; ++k) P[(kPointFreedoms + 1) * k] += ridge;
    if (!invertSymmetric3<kPointFreedoms>(P, P)) return false;
    auto& C = coupling_[p];
    double X[kPointFreedoms][kMoverFreedoms];
    times<kPointFreedoms>([&](auto k) {
      times<kMoverFreedoms>(
          [&](auto j) { X[k][j] = (P[3 * k] * C[0][j] + P[3 * k + 1] * C[1][j]) + P[3 * k + 2] * C[2][j]; });
    });
    times<kMoverFreedoms>([&](auto column) {
      for (int j = column; j < kMoverFreedoms; ++j)
        normal_[kMoverFreedoms * column + j] -=
            (C[0][j] * X[0][column] + C[1][j] * X[1][column]) + C[2][j] * X[2][column];
    });
    for (int k = 0; k < kPointFreedoms; ++k) std::copy(X[k], X[k] + kMoverFreedoms, C[k]);
    return true;
  }

  // y becomes N^-1 y.
  void solve() {
    for (int p = 0; p < points_; ++p) {
      const double* const y = y_point_[p];
      const auto& X = coupling_[p];
      for (int j = 0; j < kMoverFreedoms; ++j) y_body_[j] -= (X[0][j] * y[0] + X[1][j] * y[1]) + X[2][j] * y[2];
    }
    solveLdlt(normal_, kMoverFreedoms, y_body_);
    for (int p = 0; p < points_; ++p) {
      double* const y = y_point_[p];
      const double g[3] = {y[0], y[1], y[2]};
      for (int k = 0; k < kPointFreedoms; ++k) y[k] = dot3(normal_p_[p] + 3 * k, g) - dot6(coupling_[p][k], y_body_);
    }
  }

  int n_ = 0, points_ = 0;
  int group_[kMostContacts], lane_[kMostContacts], first_[kGroups], end_[kGroups];
  bool holds_[kPadLanes];
  double speed_ = 0;
  alignas(16) Blocks<kMoverFreedoms> body_;
  alignas(16) Blocks<kPointFreedoms> point_;
  alignas(16) Lanes q_[kPadRows], r_[kPadRows], u_[kPadRows], mu_, w_;
  alignas(16) double y_body_[kMoverFreedoms], y_point_[kMostPoints][kPointFreedoms];
  alignas(16) double normal_[kMoverFreedoms * kMoverFreedoms], normal_p_[kMostPoints][kPointFreedoms * kPointFreedoms];
  alignas(16) double coupling_[kMostPoints][kPointFreedoms][kMoverFreedoms];
};

}  // namespace

bool solvePadProblem(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r,
                     double* u, SolveResult& result) {
  PadProblem pads;
  if (!pads.read(problem, r)) return false;
  if (!holdNearest(problem, options, pads, scratch, result)) return false;
  pads.write(r, u);
  return true;
}

}  // namespace pincer::engine
