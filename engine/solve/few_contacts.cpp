#include "pincer/engine/solve/few_contacts.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/contact_equations.h"
#include "pincer/engine/solve/interior_point.h"
#include "pincer/engine/solve/newton.h"
#include "pincer/engine/solve/point_problem.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/search.h"
#include "pincer/engine/solve/squeeze.h"

namespace pincer::engine {
namespace {

constexpr std::int64_t kPerContactScaled = 300, kPerPairScaled = 40;  // multiplications
constexpr int kNewtonSteps = 12, kPatientSteps = 20;  // at most; where the tolerance alone counts, not the tick
constexpr int kInteriorPointSteps = 30;               // at most
constexpr double kNearSolution = 1e-12;  // of the problem's speeds: slip that friction follows may be 1e-5 of them
constexpr int kGivingRounds = 12;        // of Newton's method on contacts that give way
// [m/s], or as much as a residual: enough once Newton's method failed. Contacts that contradict each other by the
// round-off of their gaps (a mesh at rest in a dish) have no better answer, and 10 nm/s is far below anything felt
constexpr double kContentSpeed = 1e-8;

// Residual that will do.
double contentResidual(const SolverOptions& options, double reference_speed) {
  const double content = options.accuracy > 0 ? std::max(kContentSpeed, kContentSpeed / reference_speed) : 0;
  return std::max(options.tolerance, content);
}

// The iterates of Newton's method and of what goes by its equations, in scaled variables.
class ScaledSolve {
 public:
  // r, u, residual: the start, evaluated
  ScaledSolve(const ContactProblem& problem, EquationForm form, SolverScratch& scratch, const double* r,
              const double* u, double residual)
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

  void iterate(const SolverOptions& options) {
    keepBest();
    const int steps = options.accuracy > 0 ? kNewtonSteps : kPatientSteps;
    // half of the tolerance leaves room for the round-off of scaling back
    steps_ += iterateNewton(problem_, 0.5 * options.tolerance, steps, equations_, scratch_, current_, trial_);
    keepBest();
  }
  // An answer within the tolerance already, brought to round-off.
  void polish(const SolverOptions& options) {
    keepBest();
    steps_ +=
        iterateNewton(problem_, kStrictness * options.tolerance, kPolishSteps, equations_, scratch_, current_, trial_);
    keepBest();
  }
  // From where an interior point ends; few by equations contact by contact: what movers' equations lose to round-off
  // is as much as slow slip.
  void iterateFromInside(const SolverOptions& options) {
    if (problem_.contactCount() >= kManyContacts) return followPath(options, equations_);
    problem_ = scaleProblem(unscaled_, true, scratch_);
    ContactEquations equations(problem_, EquationForm::kContacts, scratch_);
    followPath(options, equations);
  }
  // By how much contacts gave way at most [m/s]; infinite if that was no answer.
  double giveWay(const SolverOptions& options) {
    double give = options.largest_give;
    steps_ +=
        iterateGiving(problem_, 0.5 * options.tolerance, kGivingRounds, equations_, scratch_, current_, trial_, give);
    keepBest();
    return give;
  }
  // As if contacts were soft; false if that fails as well.
  bool soften(const SolverOptions& options) {
    if (!iterateSoftly(problem_, options.tolerance, equations_, scratch_, current_, trial_, steps_)) return false;
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
  int steps() const { return steps_; }

 private:
  void followPath(const SolverOptions& options, ContactEquations& equations) {
    steps_ += followCentralPath(problem_, kNearSolution, kInteriorPointSteps, equations, scratch_, current_);
    keepBest();
    steps_ += iterateNewton(problem_, 0.5 * options.tolerance, kNewtonSteps, equations, scratch_, current_, trial_);
    keepBest();
  }
  void keepBest() {
    if (!(current_.residual < best_.residual)) return;
    std::copy(current_.r, current_.r + problem_.rowCount(), best_.r);
    std::copy(current_.u, current_.u + problem_.rowCount(), best_.u);
    best_.residual = current_.residual;
  }

  EquationForm form_;
  const ContactProblem& unscaled_;
  ScaledProblem problem_;
  ContactEquations equations_;
  SolverScratch& scratch_;
  Iterate current_{}, trial_{}, best_{};
  int steps_ = 0;
};

// One way after another; r, u and the result are those of the last one, or of a better one before it.
class FewContacts {
 public:
  FewContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r, double* u,
              SolveResult& result)
      : problem_(problem), options_(options), scratch_(scratch), r_(r), u_(u), result_(result) {}

  // From impulses of the residual `start`.
  void run(double start) {
    if (chooseForm(problem_, scratch_) == EquationForm::kTooLarge) return search(options_);
    iterate(start);
    const bool is_squeezed = isSqueezedNow();
    if (is_squeezed && !(options_.largest_give > 0)) return yield();
    if (is_squeezed) letGo();
    if (!result_.converged && !isSpent()) goOn();
  }

 private:
  void iterate(double start) {
    ScaledSolve newton = startHere(start);
    start <= options_.tolerance ? newton.polish(options_) : newton.iterate(options_);
    take(newton, SolveMethod::kNewton);
  }

  // Less than a dozen may be a pinch, which must not creep: they give way only where the interior point fails as well.
  void goOn() {
    SolverOptions brief = options_;
    brief.largest_give = 0;
    brief.effort = std::min(options_.effort, SolverEffort::kInside);
    search(brief);
    if (isAnswered() || isSpent() || options_.effort == SolverEffort::kShort) return;
    if (problem_.contactCount() >= kManyContacts && giveWay()) return;
    if (findFromInside(brief) || giveWay() || options_.effort == SolverEffort::kInside) return;
    search(options_);
    if (!isAnswered()) giveWay();
  }

  void search(const SolverOptions& options) {
    const SolveResult before = result_;
    result_ = searchImpulses(problem_, options, scratch_, r_, u_);
    result_.iterations += before.iterations;
    result_.start = before.start;
  }

  // By an interior point, and a search from where it ends. True if that is an answer; else what was found before stays
  // if it is better.
  bool findFromInside(const SolverOptions& brief) {
    if (isSpent()) return false;
    const SolveResult before = result_;
    std::copy(r_, r_ + problem_.rowCount(), scratch_.few_r.begin());
    ScaledSolve inside = startHere(before.residual);
    inside.iterateFromInside(options_);
    take(inside, SolveMethod::kInteriorPoint);
    if (!result_.converged && isPointProblem(problem_)) solveAsPoint();
    const bool is_squeezed = isSqueezedNow();
    if (!is_squeezed && !result_.converged) search(brief);
    if (!is_squeezed && result_.converged) return true;
    if (is_squeezed || result_.yields || !(result_.residual < before.residual)) takeBack(before);
    return false;
  }
  void takeBack(const SolveResult& before) {
    const int iterations = result_.iterations;
    std::copy(scratch_.few_r.begin(), scratch_.few_r.begin() + problem_.rowCount(), r_);
    result_ = before;
    result_.iterations = iterations;
    report();
  }

  void solveAsPoint() {
    const double enough = contentResidual(options_, referenceSpeed(problem_));
    if (!solvePointProblem(problem_, enough, scratch_, r_, u_, result_.residual)) return;
    report();
    result_.method = SolveMethod::kSweeps;
    result_.converged = true;
  }

  // True if contacts that contradict each other have an answer if they give way by as much as they may.
  bool giveWay() {
    if (!(options_.largest_give > 0) || isSpent()) return false;
    if (isSqueezedNow()) letGo();
    ScaledSolve giving = startHere(result_.residual);
    const double give = giving.giveWay(options_);
    result_.iterations += giving.steps();
    if (!(give <= options_.largest_give)) return false;
    giving.write(r_, u_);
    result_.method = SolveMethod::kNewton;
    result_.residual = giving.residual();
    result_.error = giving.residual() * referenceSpeed(problem_);
    result_.give = give;
    result_.converged = true;
    return true;
  }

  // Contacts that squeeze without end: as if they were soft. Those impulses never stay: they are as large as round-off
  // lets them be. Where soft contacts aren't solved either, the search goes on.
  void yield() {
    ScaledSolve soft = startHere(result_.residual);
    result_.yields = true;
    result_.converged = false;
    result_.method = SolveMethod::kNotConverged;
    if (soft.soften(options_)) {
      soft.write(r_, u_);
      result_.iterations += soft.steps();
      report();
    }
    if (isSqueezedNow() && !isSpent()) search(options_);
  }

  // The search leaves the structure of its own matrix in the scratch.
  ScaledSolve startHere(double residual) {
    return {problem_, chooseForm(problem_, scratch_), scratch_, r_, u_, residual};
  }
  void take(const ScaledSolve& solve, SolveMethod method) {
    solve.write(r_, u_);
    projectOntoCones(problem_, r_);
    report();
    result_.iterations += solve.steps();
    result_.converged = result_.residual <= contentResidual(options_, referenceSpeed(problem_));
    result_.method = result_.converged ? method : SolveMethod::kNotConverged;
  }
  void report() {
    const ContactError error = errorOf(problem_, r_, scratch_, u_);
    result_.residual = error.residual;
    result_.error = error.speed;
  }
  // To no impulse, from which contacts that give way have an answer.
  void letGo() {
    std::fill(r_, r_ + problem_.rowCount(), 0.0);
    report();
    result_.converged = false;
  }
  bool isSqueezedNow() const { return isSqueezed(problem_, scratch_.weight, r_); }
  bool isAnswered() const { return result_.converged || result_.yields; }
  bool isSpent() const { return scratch_.operations_left < 0; }

  const ContactProblem& problem_;
  const SolverOptions& options_;
  SolverScratch& scratch_;
  double *const r_, *const u_;
  SolveResult& result_;
};

}  // namespace

void solveFewContacts(const ContactProblem& problem, const SolverOptions& options, double start, SolverScratch& scratch,
                      double* r, double* u, SolveResult& result) {
  PINCER_ASSERT(problem.contactCount() <= kFewContacts);
  result.method = SolveMethod::kNotConverged;
  result.converged = false;
  FewContacts(problem, options, scratch, r, u, result).run(start);
}

}  // namespace pincer::engine
