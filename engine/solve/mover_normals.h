// mover_normals: N = A^T A of a few movers, and its inverse (stuck_contacts.h).
#pragma once
#include <algorithm>
#include <span>

#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solve/inverse3.h"
#include "pincer/engine/solve/linear.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/stuck_contacts.h"

namespace pincer::engine {

constexpr int kMostStuckBodies = 4, kMostStuckPoints = 12;  // beyond, the blocks of few_contacts.h are as good
constexpr int kMostStuckMovers = kMostStuckBodies + kMostStuckPoints;  // of both kinds

// Which of the movers are points, and the number of each among its kind.
class StuckMovers {
 public:
  // False if they are too many.
  bool count(const ContactProblem& problem) {
    if (problem.movers > kMostStuckMovers) return false;
    std::fill(is_body_, is_body_ + problem.movers, false);
    for (const ContactSide& side : problem.sides) {
      if (side.mover >= 0 && !side.is_point) is_body_[side.mover] = true;
    }
    int count[2] = {};
    for (int mover = 0; mover < problem.movers; ++mover) {
      const int kind = is_body_[mover] ? 0 : 1;
      const int limit = is_body_[mover] ? kMostStuckBodies : kMostStuckPoints;
      if (count[kind] == limit) return false;
      (is_body_[mover] ? bodies_ : points_)[count[kind]] = mover;
      number_[mover] = count[kind]++;
    }
    body_count_ = count[0];
    point_count_ = count[1];
    return true;
  }
  bool isBody(const ContactSide& side) const { return is_body_[side.mover]; }
  int numberOf(const ContactSide& side) const { return number_[side.mover]; }
  std::span<const int> bodies() const { return {bodies_, static_cast<std::size_t>(body_count_)}; }
  std::span<const int> points() const { return {points_, static_cast<std::size_t>(point_count_)}; }

 private:
  bool is_body_[kMostStuckMovers];
  int number_[kMostStuckMovers];
  int bodies_[kMostStuckBodies], points_[kMostStuckPoints];
  int body_count_, point_count_;
};

// N, and its inverse.
class MoverNormals {
 public:
  explicit MoverNormals(const StuckMovers& movers)
      : movers_(movers),
        bodies_(static_cast<int>(movers.bodies().size())),
        points_(static_cast<int>(movers.points().size())),
        size_(kMoverFreedoms * bodies_) {
    std::fill(body_, body_ + size_ * size_, 0.0);
    for (int p = 0; p < points_; ++p) {
      std::fill(point_[p], point_[p] + 9, 0.0);
      std::fill(touches_[p], touches_[p] + bodies_, false);
    }
  }

  // += A_i^T A_i
  void add(std::span<const ContactSide> sides, int rows) {
    withRows(rows, [&](auto count) {
      for (const ContactSide& x : sides) {
        if (x.mover < 0) continue;
        if (!movers_.isBody(x)) {
          addPoint(x, count);
          continue;
        }
        for (const ContactSide& y : sides) {
          if (y.mover < 0) continue;
          movers_.isBody(y) ? addBodies(x, y, count) : addCoupling(y, x, count);
        }
      }
    });
  }

  // False if it has no inverse.
  bool factorise() {
    const double ridge = kStuckRidge * largest();
    for (int j = 0; j < size_; ++j) body_[(size_ + 1) * j] += ridge;
    for (int p = 0; p < points_; ++p) {
      for (int k = 0; k < 3; ++k) point_[p][4 * k] += ridge;
      if (!eliminate(p)) return false;
    }
    return size_ == 0 || factoriseLdlt(body_, size_);
  }

  // y becomes N^-1 y; kMoverFreedoms numbers per mover, of points the last three aren't read.
  void solve(double* y) const {
    double b[kMoverFreedoms * kMostStuckBodies];
    for (int n = 0; n < bodies_; ++n) copyMover(y + kMoverFreedoms * movers_.bodies()[n], b + kMoverFreedoms * n);
    for (int p = 0; p < points_; ++p) {
      const double* const y_p = y + kMoverFreedoms * movers_.points()[p];
      forBodiesOf(p, [&](int first, const Coupling3& C) {
        for (int j = 0; j < kMoverFreedoms; ++j)
          b[first + j] -= (C[0][j] * y_p[0] + C[1][j] * y_p[1]) + C[2][j] * y_p[2];
      });
    }
    if (size_ > 0) solveLdlt(body_, size_, b);
    for (int n = 0; n < bodies_; ++n) copyMover(b + kMoverFreedoms * n, y + kMoverFreedoms * movers_.bodies()[n]);
    for (int p = 0; p < points_; ++p) {
      double* const y_p = y + kMoverFreedoms * movers_.points()[p];
      const double g[3] = {y_p[0], y_p[1], y_p[2]};
      for (int k = 0; k < 3; ++k) y_p[k] = dot3(point_[p] + 3 * k, g);
      forBodiesOf(p, [&](int first, const Coupling3& C) {
        for (int k = 0; k < 3; ++k) y_p[k] -= dot6(C[k], b + first);
      });
    }
  }

 private:
  using Coupling3 = double[3][kMoverFreedoms];

  static void copyMover(const double* from, double* to) {
    for (int j = 0; j < kMoverFreedoms; ++j) to[j] = from[j];
  }

  template <class Rows>
  void addPoint(const ContactSide& x, Rows rows) {
    double* const P = point_[movers_.numberOf(x)];
    double sum[9];
    for (int k = 0; k < 9; ++k) sum[k] = P[k];
    for (int l = 0; l < rows; ++l) {
      for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < 3; ++j) sum[3 * k + j] += x.A[l][k] * x.A[l][j];
      }
    }
    for (int k = 0; k < 9; ++k) P[k] = sum[k];
  }

  template <class Rows>
  void addCoupling(const ContactSide& point, const ContactSide& body, Rows rows) {
    const int p = movers_.numberOf(point), b = movers_.numberOf(body);
    for (int k = 0; k < 3 && !touches_[p][b]; ++k)
      std::fill(coupling_[p][b][k], coupling_[p][b][k] + kMoverFreedoms, 0.0);
    touches_[p][b] = true;
    for (int k = 0; k < 3; ++k) addRows(point, k, body, 0, rows, coupling_[p][b][k]);
  }

  // The lower half is all that is read.
  template <class Rows>
  void addBodies(const ContactSide& row, const ContactSide& column, Rows rows) {
    const int first_row = kMoverFreedoms * movers_.numberOf(row),
              first_column = kMoverFreedoms * movers_.numberOf(column);
    if (first_row < first_column) return;
    for (int k = 0; k < kMoverFreedoms; ++k) {
      const int from = first_row == first_column ? k / 2 : 0;
      addRows(column, k, row, from, rows, body_ + size_ * (first_column + k) + first_row);
    }
  }

  // out_j += sum over the rows of x's column k times y's column j, pairs of j from `from` on
  template <class Rows>
  [[gnu::always_inline]] static void addRows(const ContactSide& x, int k, const ContactSide& y, int from, Rows rows,
                                             double* out) {
    DoublePair* const sums = reinterpret_cast<DoublePair*>(out);
    for (int pair = from; pair < kMoverFreedoms / 2; ++pair) {
      DoublePair sum = sums[pair];
      for (int l = 0; l < rows; ++l) sum += x.A[l][k] * reinterpret_cast<const DoublePair*>(y.A[l])[pair];
      sums[pair] = sum;
    }
  }

  // Of the diagonal.
  double largest() const {
    double most = 0;
    for (int j = 0; j < size_; ++j) most = std::max(most, body_[(size_ + 1) * j]);
    for (int p = 0; p < points_; ++p) {
      for (int k = 0; k < 3; ++k) most = std::max(most, point_[p][4 * k]);
    }
    return most;
  }

  // Point p's block becomes its inverse P^-1, its couplings C become P^-1 C, and the bodies' -= C^T P^-1 C.
  bool eliminate(int p) {
    double* const P = point_[p];
    if (!invertSymmetric3<3>(P, P)) return false;
    Coupling3 across[kMostStuckBodies];
    forBodiesOf(p, [&](int first, const Coupling3& C) {
      for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < kMoverFreedoms; ++j)
          across[first / kMoverFreedoms][k][j] = (P[3 * k] * C[0][j] + P[3 * k + 1] * C[1][j]) + P[3 * k + 2] * C[2][j];
      }
    });
    forBodiesOf(p, [&](int row, const Coupling3& C) {
      forBodiesOf(p, [&](int column, const Coupling3&) {
        if (row < column) return;
        const Coupling3& X = across[column / kMoverFreedoms];
        for (int k = 0; k < kMoverFreedoms; ++k) {
          double* const H = body_ + size_ * (column + k) + row;
          for (int j = 0; j < kMoverFreedoms; ++j) H[j] -= (C[0][j] * X[0][k] + C[1][j] * X[1][k]) + C[2][j] * X[2][k];
        }
      });
    });
    for (int b = 0; b < bodies_; ++b) {
      for (int k = 0; k < 3 && touches_[p][b]; ++k) copyMover(across[b][k], coupling_[p][b][k]);
    }
    return true;
  }

  // act(first of the body's freedoms, the coupling) for each body that point p touches.
  template <class Act>
  void forBodiesOf(int p, const Act& act) const {
    for (int b = 0; b < bodies_; ++b) {
      if (touches_[p][b]) act(kMoverFreedoms * b, coupling_[p][b]);
    }
  }

  const StuckMovers& movers_;
  const int bodies_, points_, size_;
  double point_[kMostStuckPoints][9];
  bool touches_[kMostStuckPoints][kMostStuckBodies];
  alignas(16) Coupling3 coupling_[kMostStuckPoints][kMostStuckBodies];
  // as linear.h has it
  alignas(16) double body_[kMoverFreedoms * kMostStuckBodies * kMoverFreedoms * kMostStuckBodies];
};

}  // namespace pincer::engine
