#include "engine/solve/local_contact.h"

#include <algorithm>

#include "engine/solve/cone.h"

namespace pincer::engine {
namespace {

constexpr int kMaxTangents = kMaxContactRows - 1;
constexpr double kSingular = 1e-14;  // relative: what is added to A so that a direction without mobility has a solution

// The tangential problem that is left when u_n = 0 has been solved for r_n.
class TangentProblem {
 public:
  TangentProblem(const double* W, int stride, const double* q, int rows, double mu) : d_(rows - 1), mu_(mu) {
    inverse_W_nn_ = 1 / W[kNormalRow * (stride + 1)];
    q_n_ = q[kNormalRow];
    for (int k = 0; k < d_; ++k) W_nT_[k] = W[kNormalRow + tangentRow(k) * stride];
    for (int k = 0; k < d_; ++k) {
      b_[k] = q[tangentRow(k)] - W_nT_[k] * q_n_ * inverse_W_nn_;
      for (int l = 0; l < d_; ++l) A_[k][l] = W[tangentRow(k) + tangentRow(l) * stride] - W_nT_[k] * W_nT_[l] * inverse_W_nn_;
      trace_ += A_[k][k];
    }
  }

  // Sets r_T = -(A + alpha I)^-1 b and r_n; remembers the factors for `excess`.
  void setAlpha(double alpha) {
    factorise(alpha + kSingular * trace_);
    for (int k = 0; k < d_; ++k) x_[k] = -b_[k];
    substitute(x_);
    r_n_ = -(q_n_ + dot(W_nT_, x_)) * inverse_W_nn_;
    norm_ = std::sqrt(dot(x_, x_));
  }
  bool isInDisc() const { return norm_ <= mu_ * r_n_; }

  // f = mu r_n / |r_T| - 1 (negative outside the disc) and its derivative by alpha.
  double excess(double& derivative) const {
    double z[kMaxTangents];
    std::copy(x_, x_ + d_, z);
    substitute(z);  // dr_T / dalpha = -z
    const double ratio = mu_ * r_n_ / norm_;
    derivative = mu_ * dot(W_nT_, z) * inverse_W_nn_ / norm_ + ratio * dot(x_, z) / (norm_ * norm_);
    return ratio - 1;
  }

  // A size of A by which alpha is measured, positive.
  double magnitude() const { return std::max(trace_ / d_, kSingular / inverse_W_nn_); }

  void write(double* r) const {
    for (int k = 0; k < d_; ++k) r[tangentRow(k)] = x_[k];
    r[kNormalRow] = std::max(0.0, r_n_);
    projectOntoCone(r, d_ + 1, mu_, r);
  }

 private:
  double dot(const double* a, const double* b) const {
    double sum = 0;
    for (int k = 0; k < d_; ++k) sum += a[k] * b[k];
    return sum;
  }

  // L D L^T of A + alpha I.
  void factorise(double alpha) {
    for (int k = 0; k < d_; ++k)
      for (int l = 0; l <= k; ++l) {
        double sum = A_[k][l] + (k == l ? alpha : 0);
        for (int i = 0; i < l; ++i) sum -= L_[k][i] * L_[l][i] * pivot_[i];
        if (k == l)
          pivot_[k] = std::max(sum, kSingular * magnitude());
        else
          L_[k][l] = sum / pivot_[l];
      }
  }

  void substitute(double* x) const {
    for (int k = 0; k < d_; ++k)
      for (int i = 0; i < k; ++i) x[k] -= L_[k][i] * x[i];
    for (int k = d_ - 1; k >= 0; --k) {
      x[k] /= pivot_[k];
      for (int i = k + 1; i < d_; ++i) x[k] -= L_[i][k] * x[i];
    }
  }

  int d_;
  double mu_, inverse_W_nn_, q_n_;
  double trace_ = 0;
  double W_nT_[kMaxTangents], b_[kMaxTangents], A_[kMaxTangents][kMaxTangents];
  double L_[kMaxTangents][kMaxTangents], pivot_[kMaxTangents];
  double x_[kMaxTangents];  // r_T
  double r_n_ = 0, norm_ = 0;
};

// Leaves `problem` at the alpha > 0 for which the impulse is on the cone's surface.
void findSlide(TangentProblem& problem) {
  double low = 0;
  double high = problem.magnitude();
  for (int i = 0; i < 60; ++i, high *= 8) {
    problem.setAlpha(high);
    if (problem.isInDisc()) break;
    low = high;
  }
  double alpha = high;
  for (int i = 0; i < 60; ++i) {
    double slope;
    const double f = problem.excess(slope);
    (f < 0 ? low : high) = alpha;
    double next = alpha - f / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const bool settled = std::abs(next - alpha) <= 1e-15 * alpha;
    alpha = next;
    problem.setAlpha(alpha);
    if (settled) return;
  }
}

}  // namespace

void solveOneContact(const double* W, int stride, const double* q, int rows, double mu, double* r) {
  std::fill(r, r + rows, 0.0);
  if (!(q[kNormalRow] < 0)) return;
  if (mu == 0) {
    r[kNormalRow] = -q[kNormalRow] / W[kNormalRow * (stride + 1)];
    return;
  }
  TangentProblem problem(W, stride, q, rows, mu);
  problem.setAlpha(0);
  if (!problem.isInDisc()) findSlide(problem);
  problem.write(r);
}

}  // namespace pincer::engine
