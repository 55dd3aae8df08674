// sweeps: projected Gauss-Seidel with an exact solution per contact (local_contact.h).
//
// Slow where contacts are redundant or masses differ, but it hardly ever fails to improve: for what is entangled so
// that no factorisation is affordable, as heaps of hundreds of balls, warm-started from tick to tick.
//
// accelerate(): z is the way of the last sweep, p the whole way of the one before. On to the least of the energy
//   E(r) = |A^T r|^2 / 2 + r . (q + s),   s_i = mu_i |u_iT| e_n as the sweep left it
// over r + a z + b p, then back into the cones. Were all contacts to stick, and the sweep symmetric, this would be the
// method of conjugate gradients. For fixed s the least of E in the cones solves the contact problem: without s what
// slides would be carried on for ever. Sources: M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235-257
// (non-smooth contact dynamics); M. Silcowitz, S. Niebe, K. Erleben, The Visual Computer 26 (2010) 893-901 (conjugate
// gradients on its sweeps); E: V. Acary, F. Cadoux, C. Lemarechal, J. Malick, ZAMM 91 (2011) 155-175.
#pragma once
#include <cmath>

#include "pincer/engine/solve/residual.h"

namespace pincer::engine {

constexpr std::int64_t kPerContactSwept = 250;  // multiplications of a sweep, but for
constexpr std::int64_t kPerSlideStep = 60;      // those of a step of a search for a slide (local_contact.h)

struct SweptResult {
  int sweeps = 0;
  ContactError error;
};

// Sweeps over the impulses `r`, whose contacts are weighed, each at a cost linear in the contacts; scratch.y is A^T r,
// and follows. Uses scratch.local, change, work, direction and way.
class Sweeps {
 public:
  Sweeps(const ContactProblem& problem, SolverScratch& scratch, double* r);

  void sweep(bool backwards);

  // After each sweep but the last.
  void accelerate();

  // From the warm start, whose u `u` is, until the error is at most `enough` [m/s] or `start` shows that a few do.
  SweptResult until(double enough, const ContactError& start, double* u);

  // To and fro, from the warm start: `sweeps`, or a few where the budget is spent.
  void stop(int sweeps);

 private:
  // How far the last sweep changed a contact's own velocity, at most: w_i |change of r_i| [m/s].
  double largestChange() const { return std::sqrt(largest_change2_); }

  double* termsOf(int i) const { return terms_ + stride_ * i; }
  void fillTerms(int i);
  void relax(int i);
  // A contact's own impulse, and its mu |u_T| with that.
  struct Own {
    double r[kMaxContactRows], shift;
  };
  Own solveOwn(int i, const RoundContact& round, int rows, double* u);
  template <class Rows>
  Own solveOwn(int i, std::span<const ContactSide> sides, Rows rows, double* u);
  void goFurther(int i, double a, double b);

  const ContactProblem& problem_;
  SolverScratch& scratch_;
  double* const r_;
  double* const y_;
  static constexpr int kTermsBefore = 2;  // numbers before the matrices
  // per contact: of isotropic ones 1 / W_tt and 1 / W_nn; of others 0, the alpha of their last slide (local_contact.h),
  // the inverse of W_ii; W_ii
  double* const terms_;
  int stride_;
  double *const change_, *const way_;      // z and p
  double *const y_before_, *const y_way_;  // y before the last sweep; A^T p
  const double* const weight_;
  double work_of_change_ = 0, work_of_way_ = 0;  // (q + s) . z and p [J]
  double largest_change2_ = 0;                   // [(m/s)^2]
  int slide_steps_ = 0;                          // of the searches for slides in the last sweep
};

}  // namespace pincer::engine
