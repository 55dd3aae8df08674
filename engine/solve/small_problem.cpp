#include "pincer/engine/solve/small_problem.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/inverse3.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/newton.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/squeeze.h"

namespace pincer::engine {
namespace {

constexpr int kSmallSteps = 4;     // more are a sign that full steps don't do
constexpr int kSmallContacts = 3;  // so many only of as many movers: a body on three feet is held more than six-fold

// b becomes the solution of A x = b, by elimination with row pivots. False if a pivot is 0 or not finite.
template <int m>
bool eliminateRows(double (&A)[m][m], double (&b)[m]) {
  double inverse[m];
  for (int k = 0; k < m; ++k) {
    int pivot = k;
    for (int i = k + 1; i < m; ++i) {
      if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
    }
    if (pivot != k) {
      std::swap(A[pivot], A[k]);
      std::swap(b[pivot], b[k]);
    }
    if (!(std::abs(A[k][k]) > 0) || !std::isfinite(A[k][k])) return false;
    inverse[k] = 1 / A[k][k];
    for (int i = k + 1; i < m; ++i) {
      const double factor = A[i][k] * inverse[k];
      if (factor == 0) continue;
      for (int j = k + 1; j < m; ++j) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = m - 1; k >= 0; --k) {
    for (int j = k + 1; j < m; ++j) b[k] -= A[k][j] * b[j];
    b[k] *= inverse[k];
  }
  return true;
}

// Row l of a product with the vector x, or with column n of the matrix B, of three rows each.
[[gnu::always_inline]] inline double rowTimes(const double* row, const double* x) {
  return (row[0] * x[0] + row[1] * x[1]) + row[2] * x[2];
}
[[gnu::always_inline]] inline double rowTimes(const double* row, const double (&B)[3][3], int n) {
  return (row[0] * B[0][n] + row[1] * B[1][n]) + row[2] * B[2][n];
}

// b becomes the solution of A x = b by 3 x 3 blocks and their inverses, a quarter of the work of elimination by rows.
// Blocks aren't exchanged: where that loses digits, the residual shows it. False if one is singular or not finite.
template <int m>
[[gnu::always_inline]] inline bool eliminateBlocks(double (&A)[m][m], double (&b)[m]) {
  for (int k = 0; k < m; k += 3) {
    double inverse[3][3];
    if (!invert3<m, 3>(&A[k][k], inverse[0])) return false;
    const double b_k[3] = {b[k], b[k + 1], b[k + 2]};
    for (int l = 0; l < 3; ++l) b[k + l] = rowTimes(inverse[l], b_k);
    for (int i = k + 3; i < m; ++i) b[i] -= rowTimes(&A[i][k], b + k);
    for (int j = k + 3; j < m; j += 3) {
      double A_kj[3][3];
      for (int l = 0; l < 3; ++l) std::copy(&A[k + l][j], &A[k + l][j] + 3, A_kj[l]);
      double across[3][3];  // A_kk^-1 A_kj, which takes A_kj's place
      for (int l = 0; l < 3; ++l) {
        for (int n = 0; n < 3; ++n) A[k + l][j + n] = across[l][n] = rowTimes(inverse[l], A_kj, n);
      }
      for (int i = k + 3; i < m; ++i) {
        for (int n = 0; n < 3; ++n) A[i][j + n] -= rowTimes(&A[i][k], across, n);
      }
    }
  }
  for (int k = m - 6; k >= 0; k -= 3) {
    for (int j = k + 3; j < m; j += 3) {
      for (int l = 0; l < 3; ++l) b[k + l] -= rowTimes(&A[k + l][j], b + j);
    }
  }
  return true;
}

// The same for a symmetric A; nothing below its diagonal is read.
template <int m>
[[gnu::always_inline]] inline bool eliminateSymmetric(double (&A)[m][m], double (&b)[m]) {
  double across[m][m];  // A_kk^-1 A_kj, j > k
  for (int k = 0; k < m; k += 3) {
    double inverse[3][3];
    if (!invertSymmetric3<m, 3>(&A[k][k], inverse[0])) return false;
    const double b_k[3] = {b[k], b[k + 1], b[k + 2]};
    for (int l = 0; l < 3; ++l) b[k + l] = rowTimes(inverse[l], b_k);
    for (int i = k + 3; i < m; ++i) {
      for (int l = 0; l < 3; ++l)
        across[k + l][i] = (inverse[l][0] * A[k][i] + inverse[l][1] * A[k + 1][i]) + inverse[l][2] * A[k + 2][i];
      b[i] -= (A[k][i] * b[k] + A[k + 1][i] * b[k + 1]) + A[k + 2][i] * b[k + 2];
    }
    for (int i = k + 3; i < m; ++i) {
      for (int j = i; j < m; ++j)
        A[i][j] -= (A[k][i] * across[k][j] + A[k + 1][i] * across[k + 1][j]) + A[k + 2][i] * across[k + 2][j];
    }
  }
  for (int k = m - 6; k >= 0; k -= 3) {
    for (int j = k + 3; j < m; j += 3) {
      for (int l = 0; l < 3; ++l) b[k + l] -= rowTimes(&across[k + l][j], b + j);
    }
  }
  return true;
}

// In line: std::copy calls memmove, which reads in one piece what was just written number by number, and waits for it.
template <int n>
[[gnu::always_inline]] inline void copy(const double* from, double* to) {
  for (int k = 0; k < n; ++k) to[k] = from[k];
}

// `count` contacts of `rows` rows each.
template <int count, int rows>
class SmallProblem {
 public:
  static constexpr int m = count * rows;

  explicit SmallProblem(const ContactProblem& problem)
      : mu_(problem.mu.data()), speed_(referenceSpeed(problem)), noise_(problem.noise), strict_(problem.strict) {
    copy<m>(problem.q.data(), q_);
    for (int i = 0; i < count; ++i) {
      fillOwn(problem.sidesOf(i), rows * i);
      double trace = 0;
      for (int k = rows * i; k < rows * (i + 1); ++k) trace += W_[k][k];
      w_[i] = trace * (1.0 / rows);
    }
    for (int i = 0; i < count; ++i) {
      for (int j = i + 1; j < count; ++j) fillCoupling(problem.sidesOf(i), problem.sidesOf(j), rows * i, rows * j);
    }
  }

  // Where blocks lose too many digits, as where little moves and much is held, again by rows.
  bool solve(const SolverOptions& options, double* r_out, double* u_out, SolveResult& result) {
    return solveBy(rows == 3, options, r_out, u_out, result) ||
           (rows == 3 && solveBy(false, options, r_out, u_out, result));
  }

 private:
  bool solveBy(bool blocks, const SolverOptions& options, double* r_out, double* u_out, SolveResult& result) {
    copy<m>(r_out, r_);
    const ContactError at_start = evaluate();
    const double start = at_start.residual;
    const bool is_close = start <= options.tolerance;
    result = {SolveMethod::kWarmStart, 0, start, at_start.speed, start, true};
    if (squeezes(r_out)) return false;
    if (is_close && !(strict_ && start > exactResidual(options.tolerance, noise_, speed_))) {
      copy<m>(u_, u_out);
      return true;
    }
    const double enough = is_close ? kStrictness * options.tolerance : options.tolerance;
    double best = is_close ? start : options.tolerance;  // a residual above is no answer
    bool found = false;
    if (is_close) keep(r_out, u_out);
    const int steps = is_close ? kPolishSteps : kSmallSteps;
    for (int n = 0; n < steps; ++n) {
      if (!step(blocks)) break;
      ++result.iterations;
      const auto [residual, error] = evaluate();
      if (!std::isfinite(residual) || squeezes(r_)) break;
      if (residual > best) continue;
      found = true;
      best = result.residual = residual;
      result.error = error;
      keep(r_out, u_out);
      if (residual <= enough) break;
    }
    result.method = SolveMethod::kNewton;
    return found || is_close;
  }

  void keep(double* r_out, double* u_out) const {
    copy<m>(r_, r_out);
    copy<m>(u_, u_out);
  }

  // Perhaps without end: squeeze.h looks more closely.
  bool squeezes(const double* r) const {
    bool is_large = false;
    for (int i = 0; i < count; ++i) is_large |= w_[i] * r[rows * i + kNormalRow] > kLargestSqueeze * speed_;
    return is_large;
  }

  using Block = double[rows][rows];

  // On and below the diagonal.
  template <class Dot>
  [[gnu::always_inline]] static void addOwn(const ContactSide& side, const Dot& dot, Block& own) {
    for (int k = 0; k < rows; ++k) {
      for (int l = 0; l <= k; ++l) own[k][l] += dot(side.A[k], side.A[l]);
    }
  }

  void fillOwn(std::span<const ContactSide> sides, int first) {
    Block own = {};
    for (const ContactSide& side : sides) {
      if (side.mover < 0) continue;
      if (side.is_point)
        addOwn(side, dot3, own);
      else
        addOwn(side, dot6, own);
    }
    for (int k = 0; k < rows; ++k) {
      for (int l = 0; l <= k; ++l) W_[first + k][first + l] = W_[first + l][first + k] = own[k][l];
    }
  }

  void fillCoupling(std::span<const ContactSide> a, std::span<const ContactSide> b, int first_a, int first_b) {
    Block across = {};
    for (const ContactSide& x : a) {
      for (const ContactSide& y : b) {
        if (x.mover < 0 || x.mover != y.mover) continue;
        for (int k = 0; k < rows; ++k) {
          for (int l = 0; l < rows; ++l) across[k][l] += dot6(x.A[k], y.A[l]);
        }
      }
    }
    for (int k = 0; k < rows; ++k) {
      for (int l = 0; l < rows; ++l) W_[first_a + k][first_b + l] = W_[first_b + l][first_a + k] = across[k][l];
    }
  }

  // u, and the residual.
  ContactError evaluate() {
    for (int k = 0; k < m; ++k) u_[k] = q_[k];
    for (int l = 0; l < m; ++l) {
      for (int k = 0; k < m; ++k) u_[k] += W_[l][k] * r_[l];
    }
    WorstResidual worst;
    for (int i = 0; i < count; ++i) {
      const int first = rows * i;
      worst.add(naturalMap2(r_ + first, u_ + first, rows, mu_[i], w_[i]), u_[first + kNormalRow],
                w_[i] * r_[first + kNormalRow]);
    }
    return worst.relativeTo(speed_);
  }

  // A full step of Newton's method.
  bool step(bool blocks) {
    bool all_stick = true;
    for (int i = 0; i < count; ++i) all_stick &= linearise(i) == ContactMode::kStick;
    if (!eliminate(blocks, all_stick)) return false;
    for (int i = 0; i < count; ++i) {
      double* const r_i = r_ + rows * i;
      for (int k = 0; k < rows; ++k) r_i[k] += b_[rows * i + k];
      projectOntoCone(r_i, rows, mu_[i], r_i);
    }
    return true;
  }

  // Sticking contacts are linear, with the symmetric W.
  bool eliminate([[maybe_unused]] bool blocks, [[maybe_unused]] bool all_stick) {
    if constexpr (rows == 3) {
      if (blocks) return all_stick ? eliminateSymmetric(J_, b_) : eliminateBlocks(J_, b_);
    }
    return eliminateRows(J_, b_);
  }

  ContactMode linearise(int i) {
    const int first = rows * i;
    const double w = w_[i];
    double y[rows];
    for (int k = 0; k < rows; ++k) y[k] = w * r_[first + k] - u_[first + k];
    const ContactMode mode = contactMode(y, rows, mu_[i]);
    if (mode == ContactMode::kOpen) {
      for (int k = first; k < first + rows; ++k) {
        std::fill(J_[k], J_[k] + m, 0.0);
        J_[k][k] = w;
        b_[k] = -w * r_[k];
      }
      return mode;
    }
    for (int k = first; k < first + rows; ++k) {
      copy<m>(W_[k], J_[k]);
      b_[k] = -u_[k];
    }
    if (mode == ContactMode::kSlide) slide(i, y);
    for (int k = first; k < first + rows; ++k) J_[k][k] += kContactsEpsilon * w;
    return mode;
  }

  // The tangential rows: D W + w (I - D), row k: s W_k + (mu W_n - s t.W_T) t_k,
  // and w ((1 - s) e_k + s t_k t - mu t_k e_n).
  void slide(int i, const double* y) {
    const int first = rows * i;
    const double w = w_[i];
    const SlideDerivative d = slideDerivative(y, rows, mu_[i]);
    double along[m];
    for (int j = 0; j < m; ++j) along[j] = d.mu * W_[first + kNormalRow][j];
    for (int k = 0; k < rows; ++k) {
      if (k == kNormalRow) continue;
      for (int j = 0; j < m; ++j) along[j] -= d.s * d.t[k] * W_[first + k][j];
    }
    for (int k = 0; k < rows; ++k) {
      if (k == kNormalRow) continue;
      double* const row = J_[first + k];
      for (int j = 0; j < m; ++j) row[j] = d.s * row[j] + d.t[k] * along[j];
      for (int l = 0; l < rows; ++l) row[first + l] += w * d.t[k] * (l == kNormalRow ? -d.mu : d.s * d.t[l]);
      row[first + k] += w * (1 - d.s);
      b_[first + k] = d.s * y[k] - w * r_[first + k];
    }
  }

  const double* mu_;
  const double speed_, noise_;
  const bool strict_;
  double w_[count];
  alignas(16) double W_[m][m];  // [1/kg]
  alignas(16) double J_[m][m];
  alignas(16) double q_[m], r_[m], u_[m], b_[m];
};

template <int count, int rows>
bool solveAs(const ContactProblem& problem, const SolverOptions& options, double* r, double* u, SolveResult& result) {
  return SmallProblem<count, rows>(problem).solve(options, r, u, result);
}

}  // namespace

bool solveSmallProblem(const ContactProblem& problem, const SolverOptions& options, double* r, double* u,
                       SolveResult& result) {
  const int n = problem.contactCount();
  if (n > kSmallContacts || (n == kSmallContacts && problem.movers < n)) return false;
  const int rows = problem.rows(0);
  if (rows > 4 || problem.rowCount() != n * rows) return false;
  if (n == 1)
    return rows == 3 ? solveAs<1, 3>(problem, options, r, u, result) : solveAs<1, 4>(problem, options, r, u, result);
  if (n == 2)
    return rows == 3 ? solveAs<2, 3>(problem, options, r, u, result) : solveAs<2, 4>(problem, options, r, u, result);
  return rows == 3 ? solveAs<3, 3>(problem, options, r, u, result) : solveAs<3, 4>(problem, options, r, u, result);
}

}  // namespace pincer::engine
