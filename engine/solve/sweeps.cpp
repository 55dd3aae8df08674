#include "pincer/engine/solve/sweeps.h"

#include <algorithm>
#include <limits>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/inverse3.h"
#include "pincer/engine/solve/linear.h"
#include "pincer/engine/solve/local_contact.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/round_contact.h"

namespace pincer::engine {
namespace {

constexpr int kVisits = 48000;  // of contacts in a tick: 160 sweeps of the heap of 100 balls, 16 of one of 1000
constexpr int kFewestSweeps = 4, kMostSweeps = 160;  // however many contacts kVisits is shared by
constexpr int kRestingSweeps = 2;                    // of what was near enough before them: so a heap comes to rest
constexpr int kBetweenLooks = 4;                     // a look at the residual costs half a sweep,
constexpr double kWorthALook = 4;  // and a sweep that changed more than so many times what is enough needs none

// inverse = W^-1, rows x rows. Not a number where there is none: such a stop is in no cone.
void invertOwn(int rows, const double* W, double* inverse) {
  const auto fail = [&] { std::fill(inverse, inverse + rows * rows, std::numeric_limits<double>::quiet_NaN()); };
  if (rows == kTorsionRow) {
    if (!invertSymmetric3<kTorsionRow>(W, inverse)) fail();
    return;
  }
  double factors[kMaxContactRows * kMaxContactRows];
  std::copy(W, W + rows * rows, factors);
  if (!factoriseLdlt(factors, rows)) return fail();
  for (int l = 0; l < rows; ++l) {
    double* const column = inverse + rows * l;
    std::fill(column, column + rows, 0.0);
    column[l] = 1;
    solveLdlt(factors, rows, column);
  }
}

int mostRows(const ContactProblem& problem) {
  int most = 0;
  for (int i = 0; i < problem.contactCount(); ++i) most = std::max(most, problem.rows(i));
  return most;
}

}  // namespace

Sweeps::Sweeps(const ContactProblem& problem, SolverScratch& scratch, double* r)
    : problem_(problem),
      scratch_(scratch),
      r_(r),
      y_(scratch.y.data()),
      terms_(scratch.local.data()),
      change_(scratch.change.data()),
      way_(scratch.work.data()),
      y_before_(scratch.direction.data()),
      y_way_(scratch.way.data()),
      weight_(scratch.weight.data()) {
  const int most = mostRows(problem);
  stride_ = kTermsBefore + 2 * most * most;
  for (int i = 0; i < problem.contactCount(); ++i) fillTerms(i);
  const int size = kMoverFreedoms * problem_.movers;
  std::copy(y_, y_ + size, y_before_);
  std::fill(way_, way_ + problem_.rowCount(), 0.0);
  std::fill(y_way_, y_way_ + size, 0.0);
}

void Sweeps::fillTerms(int i) {
  if (!problem_.round.empty() && problem_.round[static_cast<std::size_t>(i)].isRound()) return;
  const int rows = problem_.rows(i);
  double *const terms = termsOf(i), *const inverse = terms + kTermsBefore, *const W = inverse + rows * rows;
  std::fill(W, W + rows * rows, 0.0);
  for (const ContactSide& side : problem_.sidesOf(i)) {
    if (side.mover >= 0) addCoupling(side, rows, side, rows, W, rows);
  }
  const bool is_isotropic = rows == kTorsionRow && isIsotropic(W, rows);
  terms[0] = is_isotropic ? 1 / W[0] : 0;
  terms[1] = is_isotropic ? 1 / W[kNormalRow * (rows + 1)] : 0;
  if (!is_isotropic) invertOwn(rows, W, inverse);
}

// Solves contact i with all others held; the movers' y follows.
void Sweeps::relax(int i) {
  const int first = problem_.firstRow(i);
  double *const r_i = r_ + first, *const change_i = change_ + first;
  const double *const q_i = problem_.q.data() + first, *const way_i = way_ + first;
  withForm(problem_, i, [&](auto rows, const auto& form) {
    for (int k = 0; k < rows; ++k) work_of_way_ += q_i[k] * way_i[k];
    // Contacts that push on nothing and don't close: so are many of a heap's
    // contacts, and most rows needn't be looked at.
    if (r_i[kNormalRow] == 0 && normalVelocityOf(form, q_i[kNormalRow], y_) >= 0)
      return std::fill(change_i, change_i + rows, 0.0);
    double u[kMaxContactRows];
    velocityOf(form, rows, q_i, y_, u);
    const Own own = solveOwn(i, form, rows, u);
    double change2 = 0;
    for (int k = 0; k < rows; ++k) {
      change_i[k] = own.r[k] - r_i[k];
      r_i[k] = own.r[k];
      change2 += change_i[k] * change_i[k];
      work_of_change_ += q_i[k] * change_i[k];
    }
    work_of_change_ += own.shift * change_i[kNormalRow];
    work_of_way_ += own.shift * way_i[kNormalRow];
    largest_change2_ = std::max(largest_change2_, weight_[i] * weight_[i] * change2);
    addImpulse(form, rows, change_i, y_);
  });
}

// Of contact i, which has the velocity u with the present impulse.
[[gnu::always_inline]] inline Sweeps::Own Sweeps::solveOwn(int i, const RoundContact& round, int, double* u) {
  const double* const r_i = r_ + problem_.firstRow(i);
  const double mu = problem_.friction(i);
  Own own;
  for (int k = 0; k < kNormalRow; ++k) own.r[k] = r_i[k] - round.inverse_W_tt * u[k];
  own.r[kNormalRow] = r_i[kNormalRow] - round.inverse_W_nn * u[kNormalRow];
  own.shift = mu * limitFriction(own.r, std::integral_constant<int, kTorsionRow>(), mu) / round.inverse_W_tt;
  return own;
}
template <class Rows>
[[gnu::always_inline]] inline Sweeps::Own Sweeps::solveOwn(int i, std::span<const ContactSide>, Rows rows, double* u) {
  double* const terms = termsOf(i);
  const double *const inverse = terms + kTermsBefore, *const W = inverse + rows * rows;
  const double* const r_i = r_ + problem_.firstRow(i);
  const double mu = problem_.friction(i);
  Own own;
  if (terms[0] > 0) {
    for (int k = 0; k < kTorsionRow; ++k) own.r[k] = r_i[k] - terms[k == kNormalRow] * u[k];
    own.shift = mu * limitFriction(own.r, std::integral_constant<int, kTorsionRow>(), mu) / terms[0];
    return own;
  }
  for (int k = 0; k < rows; ++k) {
    own.r[k] = r_i[k];
    for (int l = 0; l < rows; ++l) own.r[k] -= inverse[rows * l + k] * u[l];
  }
  if (isInCone(own.r, rows, mu)) {  // it sticks
    own.shift = terms[1] = 0;
    return own;
  }
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l) u[k] -= W[rows * l + k] * r_i[l];
  }
  slide_steps_ += solveOneContact(W, rows, u, rows, mu, own.r, terms[1]);
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l) u[k] += W[rows * l + k] * own.r[l];
  }
  own.shift = mu * std::sqrt(tangentNorm2(u, rows));
  return own;
}

void Sweeps::sweep(bool backwards) {
  const int n = problem_.contactCount();
  work_of_change_ = work_of_way_ = largest_change2_ = 0;
  slide_steps_ = 0;
  for (int k = 0; k < n; ++k) relax(backwards ? n - 1 - k : k);
}

namespace {

// Where  a g_z + b g_p + (a^2 zz + 2 a b zp + b^2 pp) / 2  is least, within bounds. Where contacts are redundant
// z and p may be any part of r that moves nothing, and what is left of zz and pp is round-off. Nowhere if the sweep's
// own way would be taken back.
struct LeastEnergy {
  double a = 0, b = 0;

  LeastEnergy(double g_z, double g_p, double zz, double zp, double pp) {
    constexpr double kLongest = 3;       // hardly ever are more than 2 asked for, and less than -1/2
    constexpr double kParallel = 1e-12;  // of z and p: the squared sine of their angle
    const double determinant = zz * pp - zp * zp;
    const double again =
        determinant > kParallel * zz * pp ? std::clamp((zp * g_z - zz * g_p) / determinant, 0.0, 1.0) : 0;
    const double further = std::min(-(g_z + again * zp) / zz, kLongest);
    if (!(further > -1)) return;
    a = further;
    b = again;
  }
};

}  // namespace

// y follows r by linearity: only what the cones take back goes through A.
void Sweeps::accelerate() {
  const int size = kMoverFreedoms * problem_.movers;
  double *const y = y_, zz = 0, zp = 0, pp = 0;
  double g_z = work_of_change_, g_p = work_of_way_;
  for (int j = 0; j < size; ++j) {
    const double z = y[j] - y_before_[j], p = y_way_[j];
    zz += z * z;
    zp += z * p;
    pp += p * p;
    g_z += y[j] * z;
    g_p += y[j] * p;
  }
  const LeastEnergy least(g_z, g_p, zz, zp, pp);
  for (int j = 0; j < size; ++j) y[j] += least.a * (y[j] - y_before_[j]) + least.b * y_way_[j];
  for (int i = 0; i < problem_.contactCount(); ++i) goFurther(i, least.a, least.b);
  for (int j = 0; j < size; ++j) {
    y_way_[j] = y[j] - y_before_[j];
    y_before_[j] = y[j];
  }
}

void Sweeps::goFurther(int i, double a, double b) {
  const int first = problem_.firstRow(i);
  double *const r_i = r_ + first, *const way_i = way_ + first;
  withForm(problem_, i, [&](auto rows, const auto& form) {
    for (int k = 0; k < rows; ++k) {
      const double change = change_[first + k], further = a * change + b * way_i[k];
      r_i[k] += further;
      way_i[k] = change + further;
    }
    if (isInCone(r_i, rows, problem_.friction(i))) return;
    double back[kMaxContactRows];
    projectOntoCone(r_i, rows, problem_.friction(i), back);
    for (int k = 0; k < rows; ++k) {
      const double inside = back[k];
      back[k] -= r_i[k];
      r_i[k] = inside;
      way_i[k] += back[k];
    }
    addImpulse(form, rows, back, y_);
  });
}

SweptResult Sweeps::until(double enough, const ContactError& start, double* u) {
  const int n = problem_.contactCount();
  const bool rests = start.speed <= enough;
  const int most = std::clamp(kVisits / n, kFewestSweeps, kMostSweeps);
  SweptResult result{0, start};
  int measured = 0;
  const auto isEnough = [&] {
    if (measured != result.sweeps) result.error = respondedError(problem_, r_, scratch_, u);
    measured = result.sweeps;
    return result.error.speed <= enough;
  };
  for (;;) {
    const bool is_spent = !spend(kPerContactSwept * n, scratch_);
    // to and fro would be half as fast: what was visited last learns nothing from being visited first
    sweep(false);
    ++result.sweeps;
    if (result.sweeps == most || (is_spent && result.sweeps >= kFewestSweeps))
      break;  // contacts that are new have no impulse yet: every tick gets a few
    const bool is_due = result.sweeps % kBetweenLooks == 0 ? largestChange() <= kWorthALook * enough
                                                           : rests && result.sweeps == kRestingSweeps;
    if (is_due && isEnough()) break;
    accelerate();
  }
  isEnough();
  return result;
}

void Sweeps::stop(int sweeps) {
  const int n = problem_.contactCount();
  respond(problem_, r_, scratch_);
  for (int k = 0; k < sweeps && (k < kFewestSweeps || scratch_.operations_left >= 0); ++k) {
    sweep(k % 2 == 1);
    spend(kPerContactSwept * n + kPerSlideStep * slide_steps_, scratch_);
  }
}

}  // namespace pincer::engine
