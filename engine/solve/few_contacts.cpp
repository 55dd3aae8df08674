#include "pincer/engine/solve/few_contacts.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/contact_equations.h"
#include "pincer/engine/solve/interior_point.h"
#include "pincer/engine/solve/newton.h"
#include "pincer/engine/solve/point_problem.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/squeeze.h"
#include "pincer/engine/solve/sweeps.h"

namespace pincer::engine {
namespace {

constexpr std::int64_t kPerContactScaled = 300, kPerPairScaled = 40;  // multiplications
constexpr int kProximalRounds = 12, kInteriorPointSteps = 30;         // each time

// How long each method is given: where the tolerance alone counts, not the tick, longer.
struct Patience {
  int newton_steps, sweeps;
};
constexpr Patience patienceOf(const SolverOptions& options) {
  return options.accuracy > 0 ? Patience{12, 60} : Patience{20, 300};
}
constexpr double kNearSolution = 1e-12;  // of the problem's speeds: slip that friction follows may be 1e-5 of them
constexpr int kSweepsPerRound = 15;      // enough to leave the basin in which Newton's method failed
constexpr int kGivingRounds = 12;        // of Newton's method on contacts that give way
constexpr int kAffordableContacts = 20;  // beyond, only one attempt from the interior
// [m/s], or as much as a residual: enough once Newton's method failed. Contacts that contradict each other by the
// round-off of their gaps (a mesh at rest in a dish) have no better answer, and 10 nm/s is far below anything felt
constexpr double kContentSpeed = 1e-8;

double contentResidual(const SolverOptions& options, double reference_speed) {
  return options.accuracy > 0 ? std::max(kContentSpeed, kContentSpeed / reference_speed) : options.tolerance;
}

// The iterates of one solve, in scaled variables.
class FewSearch {
 public:
  // r, u, residual: the warm start, evaluated
  FewSearch(const ContactProblem& problem, EquationForm form, SolverScratch& scratch, const double* r, const double* u,
            double residual)
      : form_(form),
        unscaled_(problem),
        problem_(scaleProblem(problem, form_ == EquationForm::kContacts, scratch)),
        equations_(problem_, form_, scratch),
        scratch_(scratch) {
    Iterate* const iterates[] = {&current_, &trial_, &best_};
    for (std::size_t k = 0; k < 3; ++k) *iterates[k] = {scratch.impulses[k].data(), scratch.velocities[k].data()};
    for (int i = 0; i < problem.contactCount(); ++i)
      for (int row = problem.firstRow(i); row < problem.firstRow(i + 1); ++row) {
        current_.r[row] = r[row] * problem_.scale[i];
        current_.u[row] = u[row] / problem_.scale[i];
      }
    current_.residual = residual;
    std::fill(best_.r, best_.r + problem_.rowCount(), 0.0);
    best_.residual = std::numeric_limits<double>::infinity();
    const std::int64_t n = problem.contactCount();
    spend(n * (kPerContactScaled + (problem_.W ? kPerPairScaled * n : 0)), scratch);
  }

  bool tryNewton(const SolverOptions& options) { return finish(options); }

  // Where Newton's method failed. That contacts may give way means that they were tried without it.
  SolveMethod goOn(const SolverOptions& options) {
    const double most = options.largest_give;
    if (isSpent() || (!(most > 0) && isSqueezedNow())) return SolveMethod::kNotConverged;
    const bool is_small = problem_.contactCount() < kManyContacts;
    if (!is_small || options.effort == SolverEffort::kRounds) {
      goOnProximally(options, equations_);
    } else if (goOnFromInside(options)) {
      return SolveMethod::kInteriorPoint;
    }
    if ((isEnough(options) && !isSqueezedNow()) || giveWay(options, most)) return SolveMethod::kNewton;
    if (options.effort != SolverEffort::kAll || isSqueezedNow() || isSpent()) return SolveMethod::kNotConverged;
    if (!is_small && (goOnFromInside(options) || giveWay(options, most))) return SolveMethod::kInteriorPoint;
    if (problem_.contactCount() > kAffordableContacts || isSpent()) return SolveMethod::kNotConverged;
    return sweepOn(options) ? SolveMethod::kSweeps : SolveMethod::kNotConverged;
  }

  // An answer within the tolerance already, brought to round-off.
  SolveMethod polish(const SolverOptions& options) {
    keepBest();
    iterations_ +=
        iterateNewton(problem_, kStrictness * options.tolerance, kPolishSteps, equations_, scratch_, current_, trial_);
    keepBest();
    return SolveMethod::kNewton;
  }

  // As if contacts were soft; false if that fails as well.
  bool soften(const SolverOptions& options) {
    if (!iterateSoftly(problem_, options.tolerance, equations_, scratch_, current_, trial_, iterations_)) return false;
    best_.residual = std::numeric_limits<double>::infinity();
    keepBest();
    return true;
  }

  // The best impulses and their velocities, in the caller's variables; none if nothing finite was found.
  void write(double* r, double* u) const {
    const bool found = std::isfinite(best_.residual);
    for (int i = 0; i < problem_.contactCount(); ++i)
      for (int row = problem_.firstRow(i); row < problem_.firstRow(i + 1); ++row) {
        r[row] = found ? best_.r[row] / problem_.scale[i] : 0;
        u[row] = best_.u[row] * problem_.scale[i];
      }
  }
  double residual() const { return best_.residual; }
  double give() const { return give_; }
  int iterations() const { return iterations_; }

 private:
  // Passes over all contacts, of the scaled problem.
  void smooth() {
    const ContactProblem scaled{.first_row = problem_.first_row,
                                .mu = problem_.mu,
                                .sides = problem_.sides,
                                .q = VectorMap(scratch_.q.data(), problem_.rowCount()),
                                .movers = problem_.movers,
                                .first_side = problem_.first_side};
    respond(scaled, current_.r, scratch_);
    Sweeps sweeps(scaled, scratch_, current_.r);
    for (int k = 0; k < kSweepsPerRound; ++k) sweeps.sweep(false);
    spend(kSweepsPerRound * kPerContactSwept * problem_.contactCount(), scratch_);
    evaluate(problem_, current_);
    iterations_ += kSweepsPerRound;
  }

  bool isSpent() const { return scratch_.operations_left < 0; }

  // By Newton's method from what some sweeps leave.
  bool sweepOn(const SolverOptions& options) {
    scaleSides(unscaled_, scratch_);
    for (int sweeps = 0; sweeps < patienceOf(options).sweeps && !isSpent(); sweeps += kSweepsPerRound) {
      restartFromBest();
      smooth();
      if (finish(options)) return true;
    }
    return false;
  }

  void goOnProximally(const SolverOptions& options, ContactEquations& equations) {
    restartFromBest();
    evaluate(problem_, current_);
    iterations_ +=
        iterateProximally(problem_, 0.5 * options.tolerance, kProximalRounds, equations, scratch_, current_, trial_);
    keepBest();
  }

  // Few contacts by contact: what movers' equations lose to round-off is as much as slow slip.
  bool goOnFromInside(const SolverOptions& options) {
    if (problem_.contactCount() >= kManyContacts) return goOnFromInside(options, equations_);
    problem_ = scaleProblem(unscaled_, true, scratch_);
    ContactEquations equations(problem_, EquationForm::kContacts, scratch_);
    return goOnFromInside(options, equations);
  }
  bool goOnFromInside(const SolverOptions& options, ContactEquations& equations) {
    iterations_ += followCentralPath(problem_, kNearSolution, kInteriorPointSteps, equations, scratch_, current_);
    keepBest();
    goOnProximally(options, equations);
    return isEnough(options) && !(options.largest_give > 0 && isSqueezedNow());
  }

  // Newton's method from `current`; true if what it finds will do.
  bool finish(const SolverOptions& options) {
    const double tolerance = 0.5 * options.tolerance;  // leaves room for the round-off of scaling back
    keepBest();
    iterations_ +=
        iterateNewton(problem_, tolerance, patienceOf(options).newton_steps, equations_, scratch_, current_, trial_);
    keepBest();
    // residuals are relative to impulses that grow without end
    return isEnough(options) && !(options.largest_give > 0 && isSqueezedNow());
  }
  bool isEnough(const SolverOptions& options) const {
    return best_.residual <= std::max(0.5 * options.tolerance, contentResidual(options, problem_.speed));
  }

  // True if contacts that contradict each other have an answer if they give way by `most` at most [m/s].
  bool giveWay(const SolverOptions& options, double most) {
    if (!(most > 0)) return false;
    restartFromBest();
    if (isSqueezedNow()) std::fill(current_.r, current_.r + problem_.rowCount(), 0.0);
    evaluate(problem_, current_);
    double give = most;
    iterations_ +=
        iterateGiving(problem_, 0.5 * options.tolerance, kGivingRounds, equations_, scratch_, current_, trial_, give);
    if (!(give <= most)) return false;
    give_ = give;
    best_.residual = std::numeric_limits<double>::infinity();
    keepBest();
    return true;
  }

  // True if Newton's last iterate shows walls that close on a body.
  bool isSqueezedNow() {
    double* const r = scratch_.step.data();
    for (int i = 0; i < problem_.contactCount(); ++i)
      for (int row = problem_.firstRow(i); row < problem_.firstRow(i + 1); ++row)
        r[row] = current_.r[row] / problem_.scale[i];
    return isSqueezed(unscaled_, scratch_.weight, r);
  }

  void keepBest() {
    if (!(current_.residual < best_.residual)) return;
    std::copy(current_.r, current_.r + problem_.rowCount(), best_.r);
    std::copy(current_.u, current_.u + problem_.rowCount(), best_.u);
    best_.residual = current_.residual;
  }
  void restartFromBest() { std::copy(best_.r, best_.r + problem_.rowCount(), current_.r); }

  EquationForm form_;
  const ContactProblem& unscaled_;
  ScaledProblem problem_;
  ContactEquations equations_;
  SolverScratch& scratch_;
  Iterate current_{}, trial_{}, best_{};
  int iterations_ = 0;
  double give_ = 0;
};

// Contacts that squeeze without end: as if contacts were soft. Those impulses never stay:
// they are as large as round-off lets them be. Where soft contacts aren't solved either, the search goes on.
void yieldToWalls(const ContactProblem& problem, const SolverOptions& options, EquationForm form,
                  SolverScratch& scratch, double* r, double* u, SolveResult& result) {
  const double start = errorOf(problem, r, scratch, u).residual;
  FewSearch search(problem, form, scratch, r, u, start);
  result.yields = true;
  result.converged = false;
  if (!search.soften(options)) return;
  search.write(r, u);
  const ContactError error = errorOf(problem, r, scratch, u);
  result = {SolveMethod::kNotConverged,
            result.iterations + search.iterations(),
            error.residual,
            error.speed,
            result.start,
            false,
            result.give,
            true};
}

// A point between walls that nothing else solved: `r`, `u` and `result` are as they were unless this does.
void tryPointProblem(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r,
                     double* u, SolveResult& result) {
  const double enough = std::max(options.tolerance, contentResidual(options, referenceSpeed(problem)));
  if (!solvePointProblem(problem, enough, scratch, r, u, result.residual)) return;
  result.method = SolveMethod::kSweeps;
  result.converged = true;
}

}  // namespace

void solveFewContacts(const ContactProblem& problem, const SolverOptions& options, double start, SolverScratch& scratch,
                      double* r, double* u, SolveResult& result) {
  PINCER_ASSERT(problem.contactCount() <= kFewContacts);
  const EquationForm form = chooseForm(problem, scratch);
  if (form == EquationForm::kTooLarge) {
    result.method = SolveMethod::kNotConverged;
    result.converged = false;
    return;
  }
  FewSearch search(problem, form, scratch, r, u, start);
  SolveMethod method = SolveMethod::kNewton;
  if (start <= options.tolerance)
    method = search.polish(options);
  else if (!search.tryNewton(options))
    method = search.goOn(options);
  search.write(r, u);
  result.method = method;
  result.iterations += search.iterations();
  result.residual = search.residual();
  result.error = search.residual() * referenceSpeed(problem);
  result.give = search.give();
  result.converged = method != SolveMethod::kNotConverged;
  if (result.give > 0) return;
  projectOntoCones(problem, r);
  const ContactError error = errorOf(problem, r, scratch, u);
  result.residual = error.residual;
  result.error = error.speed;
  result.converged = result.converged &&
                     error.residual <= std::max(options.tolerance, contentResidual(options, referenceSpeed(problem)));
  if (!result.converged) result.method = SolveMethod::kNotConverged;
  if (!result.converged && isPointProblem(problem)) tryPointProblem(problem, options, scratch, r, u, result);
  if (isSqueezed(problem, scratch.weight, r)) yieldToWalls(problem, options, form, scratch, r, u, result);
}

}  // namespace pincer::engine
