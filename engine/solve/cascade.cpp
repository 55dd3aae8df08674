#include "pincer/engine/solve/cascade.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/contact_equations.h"
#include "pincer/engine/solve/gauss_seidel.h"
#include "pincer/engine/solve/interior_point.h"
#include "pincer/engine/solve/large_problem.h"
#include "pincer/engine/solve/newton.h"
#include "pincer/engine/solve/point_problem.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/small_problem.h"
#include "pincer/engine/solve/squeeze.h"

namespace pincer::engine {
namespace {

constexpr double kConeRoundOff =
    1e-14;  // relative: an impulse on the cone isn't projected again, so a warm start that fits stays, to the bit
constexpr int kPolishSteps = 2;
constexpr std::int64_t kPerContactScaled = 300, kPerPairScaled = 40;  // multiplications
constexpr std::int64_t kPerSmallStep = 1000;                          // of three contacts at most
constexpr double kNearSolution = 1e-8;                                // residual from which Newton's method needs a step or two
constexpr double kShiftedGap = 1e-6;                                  // of a problem with frozen shift, itself an approximation
constexpr int kSweepsPerRound = 15;                                   // enough to leave the basin in which Newton's method failed
constexpr int kGivingRounds = 12;
constexpr int kFewestStops = 4;          // sweeps, whatever is left of the budget
constexpr int kSweepsPerLook = 5;        // a look at the residual costs as much as a sweep
constexpr int kAffordableContacts = 20;  // beyond, only one attempt from the interior
constexpr int kCostlyContacts = 80;      // beyond, an interior point costs milliseconds; the next tick begins where this one gives up
constexpr int kHeapContacts = 60;        // beyond, where a factorisation takes more than
constexpr int kHeapProducts = 100;       // of blocks, sweeps are tried before all that needs many factorisations
constexpr int kDenseContacts = 40;       // beyond, a dense matrix costs more than any graph of movers that fits
constexpr int kBlocksPerMover = 40;      // of the sparse matrix: enough for dense graphs of 40 movers, and for long stacks

// The residual that is enough when the tolerance is out of reach, for a problem of speeds of order `reference_speed` [m/s].
double contentResidual(const SolverOptions& options, double reference_speed) {
  return std::max(options.contentment, options.content_speed / reference_speed);
}

// Puts `r` into the cones; a contact whose impulse isn't finite gets none. True if it was there already.
bool project(const ContactProblem& problem, double* r) {
  bool inside = true;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int rows = problem.rows(i);
    double* const r_i = r + problem.firstRow(i);
    if (isInCone(r_i, rows, problem.friction(i), kConeRoundOff)) continue;
    inside = false;
    projectOntoCone(r_i, rows, problem.friction(i), r_i);
    double check = 0;
    for (int k = 0; k < rows; ++k) check += r_i[k];
    if (!std::isfinite(check)) std::fill(r_i, r_i + rows, 0.0);
  }
  return inside;
}

// The iterates of one solve, in scaled variables.
class Search {
 public:
  // r, u, residual: the warm start, evaluated
  Search(const ContactProblem& problem, EquationForm form, SolverScratch& scratch, const double* r, const double* u, double residual)
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

  // Where Newton's method failed.
  SolveMethod goOn(const SolverOptions& options) {
    if (isSpent()) return sweep(options);
    if (!(options.largest_give > 0) && isSqueezedNow()) return SolveMethod::kNotConverged;
    restartFromBest();
    evaluate(problem_, current_);
    iterations_ += iterateProximally(problem_, 0.5 * options.tolerance, options.proximal_rounds, equations_, scratch_, current_, trial_);
    keepBest();
    if (isEnough(options) || giveWay(options)) return SolveMethod::kProximalNewton;
    if (isSqueezedNow()) return SolveMethod::kNotConverged;
    if (problem_.contactCount() > kCostlyContacts || isSpent()) return sweep(options);
    if (options.interior_point_iterations > 0) {
      iterations_ += followCentralPath(problem_, nullptr, kNearSolution, options.interior_point_iterations, equations_, scratch_, current_);
      if (finish(options)) return SolveMethod::kInteriorPoint;
    }
    if (problem_.contactCount() > kAffordableContacts || isSpent()) return sweep(options);
    if (options.shift_updates > 0 && iterateOnShift(options)) return SolveMethod::kInteriorPoint;
    scaleSides(unscaled_, scratch_);
    for (int sweeps = 0; sweeps < options.gauss_seidel_sweeps && !isSpent(); sweeps += kSweepsPerRound) {
      restartFromBest();
      sweepGaussSeidel(problem_, kSweepsPerRound, scratch_, current_);
      iterations_ += kSweepsPerRound;
      if (finish(options)) return SolveMethod::kGaussSeidel;
    }
    return SolveMethod::kNotConverged;
  }

  // What is within the tolerance already, brought to round-off.
  SolveMethod polish(const SolverOptions& options) {
    keepBest();
    iterations_ += iterateNewton(problem_, kStrictness * options.tolerance, kPolishSteps, equations_, scratch_, current_, trial_);
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

  // Too large for the costlier methods: Gauss-Seidel, warm-started from tick to tick.
  SolveMethod sweep(const SolverOptions& options) {
    if (problem_.W) scaleSides(unscaled_, scratch_);
    keepBest();
    restartFromBest();
    const double enough = contentResidual(options, problem_.speed);
    const bool is_spent = isSpent();
    const std::int64_t left = scratch_.operations_left;
    if (is_spent) scratch_.operations_left = kNoLimit;  // the few sweeps that every tick gets: contacts that are new have no impulse yet
    const int most = is_spent ? kSweepsPerLook : options.large_sweeps;
    for (int sweeps = 0; sweeps < most && !(best_.residual <= enough); sweeps += kSweepsPerLook) {
      sweepGaussSeidel(problem_, kSweepsPerLook, scratch_, current_);
      iterations_ += kSweepsPerLook;
      keepBest();
    }
    if (is_spent) scratch_.operations_left = left - (kNoLimit - scratch_.operations_left);
    return best_.residual <= enough ? SolveMethod::kGaussSeidel : SolveMethod::kNotConverged;
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
  bool isSpent() const { return scratch_.operations_left < 0; }

  // Newton's method from `current`; true if what it finds will do.
  bool finish(const SolverOptions& options) {
    const double tolerance = 0.5 * options.tolerance;  // leaves room for the round-off of scaling back
    keepBest();
    iterations_ += iterateNewton(problem_, tolerance, options.newton_iterations, equations_, scratch_, current_, trial_);
    keepBest();
    return isEnough(options);
  }
  bool isEnough(const SolverOptions& options) const {
    return best_.residual <= std::max(0.5 * options.tolerance, contentResidual(options, problem_.speed));
  }

  // Whether contacts that contradict each other have an answer if they give way a little.
  bool giveWay(const SolverOptions& options) {
    if (!(options.largest_give > 0)) return false;
    restartFromBest();
    if (isSqueezedNow()) std::fill(current_.r, current_.r + problem_.rowCount(), 0.0);
    evaluate(problem_, current_);
    double give = options.largest_give;
    iterations_ += iterateGiving(problem_, 0.5 * options.tolerance, kGivingRounds, equations_, scratch_, current_, trial_, give);
    if (!(give <= options.largest_give)) return false;
    give_ = give;
    best_.residual = std::numeric_limits<double>::infinity();
    keepBest();
    return true;
  }

  // Whether Newton's last iterate shows walls that close on a body.
  bool isSqueezedNow() {
    double* const r = scratch_.step.data();
    for (int i = 0; i < problem_.contactCount(); ++i)
      for (int row = problem_.firstRow(i); row < problem_.firstRow(i + 1); ++row) r[row] = current_.r[row] / problem_.scale[i];
    return isSqueezed(unscaled_, scratch_.weight, r);
  }

  bool iterateOnShift(const SolverOptions& options) {
    restartFromBest();
    evaluate(problem_, current_);
    takeShift();
    for (int n = 0; n < options.shift_updates; ++n) {
      iterations_ += followCentralPath(problem_, scratch_.shift.data(), kShiftedGap, options.interior_point_iterations, equations_,
                                       scratch_, current_);
      takeShift();
      if (finish(options)) return true;
    }
    return false;
  }
  void takeShift() {
    for (int i = 0; i < problem_.contactCount(); ++i)
      scratch_.shift.data()[i] = std::sqrt(tangentNorm2(current_.u + problem_.firstRow(i), problem_.rows(i)));
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

// Scales r so that  E(r) = r . (q + W r / 2),  the energy that it brings in, isn't positive: to the minimum of E on its ray.
// The biases within q count as velocities, and compliance within W as inertia: the best that can be said without knowing the bodies, and on
// the safe side but for work that a bias does on purpose (a penetration pushed out, a restitution).
// False if there was nothing to do.
bool removeAddedEnergy(const ContactProblem& problem, VectorMap r, VectorMap u) {
  double work = 0;      // r . q
  double response = 0;  // r . W r
  for (int row = 0; row < problem.rowCount(); ++row) {
    work += r.data()[row] * problem.q.data()[row];
    response += r.data()[row] * (u.data()[row] - problem.q.data()[row]);
  }
  if (work + 0.5 * response <= 0) return false;
  const double scale = work < 0 ? -work / response : 0;
  for (int row = 0; row < problem.rowCount(); ++row) r.data()[row] *= scale;
  return true;
}

// What didn't converge; its residual is known.
SolveResult withoutAddedEnergy(const ContactProblem& problem, SolveResult result, SolverScratch& scratch, VectorMap r, VectorMap u) {
  result.method = SolveMethod::kNotConverged;
  result.converged = false;
  if (removeAddedEnergy(problem, r, u)) result.residual = weighedResidual(problem, r.data(), scratch, u.data());
  return result;
}

}  // namespace

SolverScratch::SolverScratch(int contacts, int movers)
    : max_contacts(contacts),
      dense_contacts(std::min(contacts, kDenseContacts)),
      movers_lu(std::min(movers, contacts), kBlocksPerMover * std::min({movers, contacts, BlockLu::kMaxNodes})) {
  const auto n = static_cast<std::size_t>(contacts), dense = static_cast<std::size_t>(dense_contacts);
  const std::size_t m = kMaxContactRows * n, rows = kMaxContactRows * dense;
  for (std::vector<double>* matrix : {&W, &jacobian}) matrix->resize(rows * rows);
  for (std::vector<double>* vector : {&q, &step, &response, &shift_centre, &give}) vector->resize(m);
  for (std::vector<double>& vector : impulses) vector.resize(m);
  for (std::vector<double>& vector : velocities) vector.resize(m);
  y.resize(kMoverFreedoms * static_cast<std::size_t>(movers));
  weight.resize(n);
  rhs.resize(std::max(m, y.size()));
  workspace.resize(kInteriorPointVectors * m);
  pivots.resize(rows);
  node.resize(static_cast<std::size_t>(movers));
  sides.resize(n);
  terms.resize(n);
  local.resize(2 * (kMaxContactRows * m + n));
  round.resize(n);
  scale.resize(n);
  shift.resize(n);
  active.resize(n);
}

namespace {

double enoughOfLarge(const ContactProblem& problem, const SolverOptions& options) {
  const double speed = referenceSpeed(problem);
  return std::max(contentResidual(options, speed), kLargeSpeed / speed);
}

bool isHeap(const ContactProblem& problem, EquationForm form, const SolverScratch& scratch) {
  return form == EquationForm::kMovers && problem.contactCount() > kHeapContacts && scratch.movers_lu.products() > kHeapProducts;
}

// What solveSmallProblem leaves; r in the cones.
SolveResult solveByForm(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, VectorMap r, VectorMap u) {
  weighContacts(problem, scratch);
  const double start = weighedResidual(problem, r.data(), scratch, u.data());
  const bool is_close = start <= options.tolerance;
  if (is_close && !(problem.strict && start > exactResidual(options.tolerance, referenceSpeed(problem))))
    return {SolveMethod::kWarmStart, 0, start, start, true};
  const EquationForm form = chooseForm(problem, scratch);
  if (form == EquationForm::kTooLarge) {
    const SolveResult large = solveLargeProblem(problem, enoughOfLarge(problem, options), start, scratch, r.data(), u.data());
    return large.converged ? large : withoutAddedEnergy(problem, large, scratch, r, u);
  }
  Search search(problem, form, scratch, r.data(), u.data(), start);
  SolveMethod method = SolveMethod::kNewton;
  if (is_close) {
    method = search.polish(options);
  } else if (!search.tryNewton(options)) {
    if (isHeap(problem, form, scratch)) {
      weighedResidual(problem, r.data(), scratch, u.data());  // the search had its memory
      SolveResult large = solveLargeProblem(problem, enoughOfLarge(problem, options), start, scratch, r.data(), u.data());
      large.iterations += search.iterations();
      if (large.converged) return large;
    }
    method = search.goOn(options);
  }
  SolveResult result{method, search.iterations(), search.residual(), start, true, search.give()};
  search.write(r.data(), u.data());
  if (result.give > 0) return result;
  if (!project(problem, r.data()) || result.method == SolveMethod::kNotConverged)
    result.residual = weighedResidual(problem, r.data(), scratch, u.data());
  if (result.residual <= std::max(options.tolerance, contentResidual(options, referenceSpeed(problem)))) {
    result.converged = result.method != SolveMethod::kNotConverged;
    return result;
  }
  return withoutAddedEnergy(problem, result, scratch, r, u);
}

// What squeezes without end: `r` and `result` are as they were if nothing is found.
void yieldToWalls(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, VectorMap r, VectorMap u,
                  SolveResult& result) {
  weighContacts(problem, scratch);
  const EquationForm form = chooseForm(problem, scratch);
  if (form == EquationForm::kTooLarge) return;
  const double start = weighedResidual(problem, r.data(), scratch, u.data());
  Search search(problem, form, scratch, r.data(), u.data(), start);
  if (!search.soften(options)) return;
  search.write(r.data(), u.data());
  project(problem, r.data());
  result.residual = weighedResidual(problem, r.data(), scratch, u.data());
  result.iterations += search.iterations();
  result.method = SolveMethod::kNotConverged;
  result.converged = false;
  result.yields = true;
}

// A point between walls that nothing else solved: `r`, `u` and `result` are as they were unless this does.
void tryPointProblem(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r, double* u,
                     SolveResult& result) {
  const double enough = std::max(options.tolerance, contentResidual(options, referenceSpeed(problem)));
  if (!solvePointProblem(problem, enough, scratch, r, u, result.residual)) return;
  result.method = SolveMethod::kGaussSeidel;
  result.converged = true;
}

}  // namespace

void solveContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r, double* u,
                   SolveResult& result) {
  result = {};
  if (problem.contactCount() == 0) return;
  PINCER_ASSERT(problem.first_row.size() == problem.mu.size() + 1 && problem.sides.size() == problem.mu.size());
  PINCER_ASSERT(problem.firstRow(problem.contactCount()) == problem.rowCount());
  project(problem, r);
  const bool is_solved = solveSmallProblem(problem, options, r, u, result);
  spend(kPerSmallStep * (1 + result.iterations), scratch);
  if (is_solved) return;
  const VectorMap r_all(r, problem.rowCount()), u_all(u, problem.rowCount());
  result = solveByForm(problem, options, scratch, r_all, u_all);
  if (!result.converged && isPointProblem(problem)) tryPointProblem(problem, options, scratch, r, u, result);
  if (isSqueezed(problem, scratch.weight, r)) yieldToWalls(problem, options, scratch, r_all, u_all, result);
}

void stopBySweeps(const ContactProblem& problem, int sweeps, SolverScratch& scratch, VectorMap r, VectorMap u) {
  weighContacts(problem, scratch);
  r.setZero();
  std::fill(scratch.y.begin(), scratch.y.begin() + kMoverFreedoms * problem.movers, 0.0);
  GaussSeidel method({problem.first_row, problem.mu, problem.sides, problem.q.data(), scratch.y.data(), problem.movers}, scratch, r.data());
  for (int n = 0; n < sweeps && (n < kFewestStops || scratch.operations_left >= 0); ++n) {
    method.sweep(n % 2 == 1);
    spend(kPerContactSwept * problem.contactCount() + kPerSlideStep * method.slideSteps(), scratch);
  }
  weighedResidual(problem, r.data(), scratch, u.data());
  if (removeAddedEnergy(problem, r, u)) weighedResidual(problem, r.data(), scratch, u.data());
}

}  // namespace pincer::engine
