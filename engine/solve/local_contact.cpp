#include "pincer/engine/solve/local_contact.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "pincer/engine/solve/cone.h"

namespace pincer::engine {
namespace {

constexpr double kSingular = 1e-14;  // relative: what is added to A so that a direction without mobility has a solution
constexpr double kRootRoundOff = 1e-15;  // relative
constexpr int kAlphaSteps = 60;          // of Newton's method within a bracket, at most

// The tangential problem that is left when u_n = 0 has been solved for r_n. D tangential rows, known to the compiler.
template <int D>
class TangentProblem {
 public:
  TangentProblem(const double* W, int stride, const double* q, double mu) : mu_(mu) {
    inverse_W_nn_ = 1 / W[kNormalRow * (stride + 1)];
    q_n_ = q[kNormalRow];
    for (int k = 0; k < D; ++k) W_nT_[k] = W[kNormalRow + tangentRow(k) * stride];
    for (int k = 0; k < D; ++k) {
      b_[k] = q[tangentRow(k)] - W_nT_[k] * q_n_ * inverse_W_nn_;
      for (int l = 0; l < D; ++l)
        A_[k][l] = W[tangentRow(k) + tangentRow(l) * stride] - W_nT_[k] * W_nT_[l] * inverse_W_nn_;
      trace_ += A_[k][k];
    }
  }

  // Sets r_T = -(A + alpha I)^-1 b and r_n; remembers the factors for `excess`.
  void setAlpha(double alpha) {
    factorise(alpha + kSingular * trace_);
    for (int k = 0; k < D; ++k) x_[k] = -b_[k];
    substitute(x_);
    r_n_ = -(q_n_ + dot(W_nT_, x_)) * inverse_W_nn_;
    norm_ = std::sqrt(dot(x_, x_));
  }
  bool isInDisc() const { return norm_ <= mu_ * r_n_; }

  // f = mu r_n / |r_T| - 1 (negative outside the disc) and its derivative by alpha.
  double excess(double& derivative) const {
    double z[D];
    std::copy(x_, x_ + D, z);
    substitute(z);  // dr_T / dalpha = -z
    const double ratio = mu_ * r_n_ / norm_;
    derivative = mu_ * dot(W_nT_, z) * inverse_W_nn_ / norm_ + ratio * dot(x_, z) / (norm_ * norm_);
    return ratio - 1;
  }

  // A size of A by which alpha is measured, positive.
  double magnitude() const { return std::max(trace_ / D, kSingular / inverse_W_nn_); }

  // The root where A is a multiple of the identity, and friction doesn't lift or press the contact.
  double firstAlpha() const {
    const double alpha = std::sqrt(dot(b_, b_)) / (-q_n_ * inverse_W_nn_ * mu_) - trace_ / D;
    return alpha > 0 && std::isfinite(alpha) ? alpha : magnitude();
  }

  void write(double* r) const {
    for (int k = 0; k < D; ++k) r[tangentRow(k)] = x_[k];
    r[kNormalRow] = std::max(0.0, r_n_);
    projectOntoCone(r, D + 1, mu_, r);
  }

 private:
  static double dot(const double* a, const double* b) {
    double sum = 0;
    for (int k = 0; k < D; ++k) sum += a[k] * b[k];
    return sum;
  }

  // L D L^T of A + alpha I.
  void factorise(double alpha) {
    for (int k = 0; k < D; ++k)
      for (int l = 0; l <= k; ++l) {
        double sum = A_[k][l] + (k == l ? alpha : 0);
        for (int i = 0; i < l; ++i) sum -= L_[k][i] * L_[l][i] * pivot_[i];
        if (k == l) {
          pivot_[k] = std::max(sum, kSingular * magnitude());
          inverse_pivot_[k] = 1 / pivot_[k];
        } else {
          L_[k][l] = sum * inverse_pivot_[l];
        }
      }
  }

  void substitute(double* x) const {
    for (int k = 0; k < D; ++k)
      for (int i = 0; i < k; ++i) x[k] -= L_[k][i] * x[i];
    for (int k = D - 1; k >= 0; --k) {
      x[k] *= inverse_pivot_[k];
      for (int i = k + 1; i < D; ++i) x[k] -= L_[i][k] * x[i];
    }
  }

  double mu_, inverse_W_nn_, q_n_;
  double trace_ = 0;
  double W_nT_[D], b_[D], A_[D][D];
  double L_[D][D], pivot_[D], inverse_pivot_[D];
  double x_[D];  // r_T
  double r_n_ = 0, norm_ = 0;
};

// Where Newton's method leaves the bracket: alpha spans many decades where a direction has hardly any mobility.
double between(double low, double high, double alpha, double magnitude) {
  constexpr double kFactor = 64;  // downwards, while the bracket begins at 0
  if (!std::isfinite(high)) return 8 * std::max(alpha, magnitude);
  return low > 0 ? std::sqrt(low) * std::sqrt(high) : high / kFactor;
}

// Leaves `problem` at the alpha > 0 for which the impulse is on the cone's surface. f is nearly a line: three or four
// steps from the first guess. Returns how many.
template <int D>
int findSlide(TangentProblem<D>& problem, double& alpha) {
  double low = 0, high = std::numeric_limits<double>::infinity();
  alpha = problem.firstAlpha();
  for (int i = 0; i < kAlphaSteps; ++i) {
    problem.setAlpha(alpha);
    double slope;
    const double f = problem.excess(slope);
    (f < 0 ? low : high) = alpha;
    double next = alpha - f / slope;
    if (!(next > low && next < high)) next = between(low, high, alpha, problem.magnitude());
    const bool is_last = std::abs(next - alpha) <= kRootRoundOff * alpha;
    alpha = next;
    if (is_last) {
      problem.setAlpha(alpha);
      return i + 1;
    }
  }
  if (high < std::numeric_limits<double>::infinity()) alpha = high;
  problem.setAlpha(alpha);
  return kAlphaSteps;
}

// One step of that from the alpha of a problem nearby. False if it leads far away.
template <int D>
bool followSlide(TangentProblem<D>& problem, double& alpha) {
  constexpr double kNearby = 4;  // times as much or as little, chosen
  problem.setAlpha(alpha);
  double slope;
  const double f = problem.excess(slope), next = alpha - f / slope;
  if (!(kNearby * next > alpha && next < kNearby * alpha)) return false;
  problem.setAlpha(alpha = next);
  return true;
}

template <int D>
int solvePressed(const double* W, int stride, const double* q, double mu, double* r, double& alpha) {
  TangentProblem<D> problem(W, stride, q, mu);
  int steps = alpha > 0 && followSlide(problem, alpha) ? 1 : 0;
  if (steps == 0) {
    problem.setAlpha(alpha = 0);
    if (!problem.isInDisc()) steps = findSlide(problem, alpha);
  }
  problem.write(r);
  return steps;
}

}  // namespace

bool isIsotropic(const double* W, int stride) {
  const double small = kBlockRoundOff * W[0];
  return W[0] > 0 && W[kNormalRow * (stride + 1)] > 0 && std::abs(W[1]) <= small && std::abs(W[kNormalRow]) <= small &&
         std::abs(W[stride + kNormalRow]) <= small && std::abs(W[0] - W[stride + 1]) <= small;
}

int solveOneContact(const double* W, int stride, const double* q, int rows, double mu, double* r, double& alpha) {
  std::fill(r, r + rows, 0.0);
  if (!(q[kNormalRow] < 0)) return 0;
  if (mu == 0) {
    r[kNormalRow] = -q[kNormalRow] / W[kNormalRow * (stride + 1)];
    return 0;
  }
  if (rows == kTorsionRow && isIsotropic(W, stride)) {
    for (int k = 0; k < kTorsionRow; ++k) r[k] = -q[k] / W[k * (stride + 1)];
    limitFriction(r, std::integral_constant<int, kTorsionRow>(), mu);
    return 0;
  }
  if (rows == kTorsionRow) return solvePressed<2>(W, stride, q, mu, r, alpha);
  if (rows == kRollingRow) return solvePressed<3>(W, stride, q, mu, r, alpha);
  return solvePressed<5>(W, stride, q, mu, r, alpha);
}

}  // namespace pincer::engine
