#include "pincer/engine/solve/search.h"

#include <algorithm>
#include <limits>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/contact_solver.h"
#include "pincer/engine/solve/few_contacts.h"
#include "pincer/engine/solve/proximal_round.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/search_parameters.h"
#include "pincer/engine/solve/squeeze.h"
#include "pincer/engine/solve/sweeps.h"

namespace pincer::engine {
namespace {

class Search {
 public:
  Search(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch)
      : problem_(problem), options_(options), scratch_(scratch) {}

  SolveResult run(double* r, double* u) {
    weighContacts(problem_, scratch_);
    std::copy(r, r + rows(), scratch_.centre.data());
    look();
    result_.start = error_.residual;
    const bool squeezed = squeezes(scratch_.centre);
    // A hit's impulses are no start for the tick after it: none at all leaves what asks for most.
    if (!squeezed && !(error_.residual <= 1)) {
      letGo();
      look();
    }
    const auto centre = scratch_.centre.begin();
    settles_ = error_.speed <= kNear * limitAt(finest()) ||
               std::all_of(centre, centre + rows(), [](double x) { return x == 0; });
    if (squeezed) {
      goSoft();
    } else if (isEnough() && (isExact() || !isQuiet())) {
      result_.method = SolveMethod::kWarmStart;
    } else {
      search();
    }
    write(r, u);
    return result_;
  }

 private:
  int rows() const { return problem_.rowCount(); }
  // Few contacts too, where the tolerance alone counts.
  bool isPatient() const { return scratch_.is_patient || (isFew() && options_.accuracy == 0); }
  bool isFew() const { return problem_.contactCount() <= kFewContacts; }
  int times() const { return isPatient() ? kPatient : 1; }
  // At most so many, as far as the operations go; one at least.
  int stepsOf(int most) const {
    return static_cast<int>(std::clamp<std::int64_t>(operationsLeft() / step_cost_, 1, most));
  }
  std::int64_t operationsLeft() const { return scratch_.operations_left - std::max<std::int64_t>(0, last_operation_); }
  bool isSpent() const { return operationsLeft() < 0; }
  bool isWithinTolerance() const { return error_.residual <= options_.tolerance; }
  // As good as what rests asks for; at a looser accuracy than the default by as little as it may move.
  bool isExact() const {
    if ((problem_.calm || isLoose()) && error_.speed <= restErrorOf(options_)) return true;
    const double exact = exactResidual(options_.tolerance, problem_.noise, referenceSpeed(problem_));
    return isWithinTolerance() && (!problem_.strict || error_.residual <= exact);
  }
  // A looser accuracy than the default doesn't keep what is slow from rest, nor what slides from sweeps [m/s].
  double finest() const { return std::min(options_.accuracy, SolverOptions{}.accuracy); }
  bool isLoose() const { return options_.accuracy > finest(); }
  // Error that is small enough [m/s].
  double limit() const { return limitAt(options_.accuracy); }
  double limitAt(double accuracy) const {
    if (isFew() || accuracy == 0) return restErrorOf(options_);
    return std::max(kShareOfSlip * slip_, std::clamp(kShareOfSlow * slip_, finest(), accuracy));
  }
  // Of a round's own, at most [m/s]. Few go on to the tolerance as long as they get nearer.
  double left() const { return kLeft * std::max(isFew() ? 0 : limit(), options_.tolerance * referenceSpeed(problem_)); }
  bool isEnough() const { return isWithinTolerance() || error_.speed <= limit(); }
  bool isAtGoal() const { return isFew() ? isWithinTolerance() : isEnough(); }
  bool squeezes(const std::vector<double>& r) const { return isSqueezed(problem_, scratch_.weight, r.data()); }
  bool isQuiet() const { return slip_ <= kQuiet * referenceSpeed(problem_); }

  // At scratch.centre: y, u, error; keeps it if it is the best.
  void look() {
    spend(kPerContactLooked * problem_.contactCount(), scratch_);
    error_ = errorOf(problem_, scratch_.centre.data(), scratch_, scratch_.u.data());
    if (!(error_.residual < best_.residual)) return;
    keep();
    slip_ = fastestSlip(problem_, scratch_.best_r.data(), scratch_.best_u.data());
  }
  void keep() {
    best_ = error_;
    std::copy(scratch_.centre.data(), scratch_.centre.data() + rows(), scratch_.best_r.data());
    std::copy(scratch_.u.data(), scratch_.u.data() + rows(), scratch_.best_u.data());
  }

  // Between balls sweeps are so cheap that factors pay in rows, rings and trees of them only, or where sweeps fail.
  void search() {
    if (scratch_.operations_left < 0) return sweep();
    const bool is_round = !problem_.round.empty();
    if (searchBy(is_round ? kProductsPerRoundContact * problem_.contactCount() : affordableProducts(problem_))) return;
    sweep();
    const bool has_failed = result_.method == SolveMethod::kNotConverged && scratch_.operations_left >= 0;
    if (is_round && has_failed && problem_.movers <= kMostRoundMovers) searchOn();
  }
  // From where sweeps got no further: heavy bodies weigh on light balls.
  void searchOn() {
    has_swept_ = true;
    result_.method = SolveMethod::kNoContact;  // yet
    restart();
    best_ = {};
    look();  // at how fast it slips, too
    if (!searchBy(affordableProducts(problem_))) conclude();
  }
  // False if its factors don't fit.
  bool searchBy(int products) {
    MoverMatrix matrix(problem_, scratch_, products);
    if (!matrix.fits()) return false;
    const std::int64_t before = scratch_.operations_left;
    last_operation_ = before - mostOperations(matrix);
    step_cost_ = matrix.costOfFactorisation();
    searchWith(matrix);
    if (isHit()) scratch_.hit_operations -= before - scratch_.operations_left;
    return true;
  }

  // Bodies as fast as in a hit aren't worth the same share of their speed: a tick's work follows from its contacts.
  bool isHit() const {
    return !isFew() && options_.accuracy > 0 && referenceSpeed(problem_) > kHitSpeed * options_.accuracy;
  }
  std::int64_t mostOperations(const MoverMatrix& matrix) const {
    if (isFew() && !isPatient())
      return kFewFactorisations[static_cast<int>(options_.effort)] * matrix.costOfFactorisation();
    const std::int64_t cost = matrix.costOfFactorisation();
    const std::int64_t once =
        has_swept_ ? kSweptFactorisations * cost : std::max(kFewestOperations, kMostFactorisations * cost);
    const std::int64_t most = times() * once;
    return (isHit() ? std::min(most, scratch_.hit_operations / kHitSolves) : most) / scratch_.haste;
  }

  void searchWith(MoverMatrix& matrix) {
    ProximalRound round(problem_, matrix, scratch_);
    if (isEnough()) return polish(round);
    approach(round);
    proceed(round);
    if (isEnough() && result_.give == 0 && (isFew() || (isQuiet() && settles_))) polish(round);
    conclude();
    // what is new has no impulse yet
    if (scratch_.operations_left < 0 && result_.method == SolveMethod::kNotConverged) return sweep();
    if (squeezes(scratch_.best_r)) soften(round);
  }

  // An answer that is good enough already, brought to round-off: one that isn't feeds the next tick's error. Descents
  // where a round fails: what is quiet hardly changes its shift.
  void polish(ProximalRound& round) {
    bool follows = true;
    for (int n = 0; n < kPolishRounds && !isPolished() && !isSpent(); ++n) {
      const double before = best_.residual, epsilon = follows ? kPolishEpsilon : kFirstDescent;
      const int steps = stepsOf(follows ? kMostRoundSteps : kMostDescentSteps);
      const Shift shift = follows ? Shift::kFollows : Shift::kFrozen;
      const bool is_done = round.solve(shift, {epsilon, left(), steps}, result_.iterations);
      if (is_done) recentre();
      if (is_done ? !(best_.residual < 0.5 * before) : !follows) break;
      follows = is_done && follows;
    }
    result_.method = SolveMethod::kNewton;
  }

  bool isPolished() const {
    if (isLoose() && best_.speed <= restErrorOf(options_)) return true;
    return best_.residual <= kStrictness * options_.tolerance;
  }

  void recentre() {  // at the round's answer
    scratch_.centre.swap(scratch_.r);
    look();
  }

  bool isFar() const { return best_.speed > kFar; }
  bool slides() const { return options_.accuracy > 0 && slip_ > kSliding * finest(); }
  bool isWithinReachOfSweeps() const { return limit() > kSwept * referenceSpeed(problem_); }

  // To where rounds succeed: what slides, or needn't be exact, by sweeps, as long as they get on; then descents.
  void approach(ProximalRound& round) {
    double before = std::numeric_limits<double>::infinity();
    const auto is_for_sweeps = [&] {
      return (isFar() && (slides() || isHit())) || (isWithinReachOfSweeps() && !isEnough());
    };
    while (is_for_sweeps() && best_.speed < kStillFading * before && !isSpent()) {
      before = best_.speed;
      smooth();
    }
    if (isFar()) descend(round, kFirstDescent);
  }

  // Rounds whose shift is that of their start, from the best iterate: they never fail, and come near from anywhere.
  void descend(ProximalRound& round, double epsilon) {
    result_.method = SolveMethod::kAlternation;
    for (int n = 0; n < kDescents && !isEnough() && !isSpent(); ++n) {
      restart();
      const double before = best_.speed, least = std::max(left(), kRough * best_.speed);
      const bool is_done =
          round.solve(Shift::kFrozen, {epsilon, least, stepsOf(kMostDescentSteps)}, result_.iterations);
      const double give = noteGive(epsilon);
      recentre();
      const bool is_soft = give > kMostlyGive * error_.speed;
      if ((slides() || !is_soft) && !(best_.speed < kStillFading * before)) return;
      if (is_soft && is_done) epsilon = std::max(kLeastEpsilon, kEasier * epsilon);
    }
  }

  void restart() {
    std::copy(scratch_.best_r.data(), scratch_.best_r.data() + rows(), scratch_.centre.data());
    error_ = errorOf(problem_, scratch_.centre.data(), scratch_, scratch_.u.data());
  }
  void smooth() {
    respond(problem_, scratch_.centre.data(), scratch_);
    Sweeps sweeps(problem_, scratch_, scratch_.centre.data());
    for (int n = 0; n < kSweepsAtATime && spend(kPerContactSwept * problem_.contactCount(), scratch_); ++n) {
      if (n > 0) sweeps.accelerate();
      sweeps.sweep(false);
    }
    result_.iterations += kSweepsAtATime;
    look();
  }

  void proceed(ProximalRound& round) {
    double epsilon = std::clamp(kEpsilonOfError * error_.speed, 10 * kLeastEpsilon, kFirstEpsilon);
    double give = std::numeric_limits<double>::infinity();
    const int longest = kRoundPatience * times();
    int patience = longest, failures = 0;
    while (!isAtGoal() && !isSpent()) {
      const int before = result_.iterations, most = kMostRoundSteps * (1 + failures);  // or the same would fail again
      const double least = std::max(left(), kLeft * error_.speed);
      if (!round.solve(Shift::kFollows, {epsilon, least, stepsOf(most)}, result_.iterations)) {
        if (isEnough()) return;
        epsilon = std::min(kMostEpsilon, kHarder * epsilon);
        if (++failures > kMostFailures * times()) return;
        goAround(round, std::min(epsilon, kFirstDescent), failures);
        continue;
      }
      const double last_give = give, last_error = error_.speed;
      give = noteGive(epsilon);
      recentre();
      if (give < kStillFading * last_give)
        patience = longest;
      else if (epsilon == kLeastEpsilon || !(isPatient() || error_.speed < kStillFading * last_error))
        --patience;
      if (!settles_ && patience < longest && giveWay(give)) return;  // it won't last, however small it gets
      if (patience == 0) {
        if (isEnough() || giveWay(give) || ++failures > kMostFailures * times()) return;
        goAround(round, std::min(epsilon, kFirstDescent), failures);
        patience = longest;
        give = std::numeric_limits<double>::infinity();
        continue;
      }
      if (result_.iterations - before <= kEasySteps || error_.speed > kStillFading * last_error)
        epsilon = std::max(kLeastEpsilon, kEasier * epsilon);
    }
  }

  // Sliding contacts by sweeps and by descents in turn, the rest by descents.
  void goAround(ProximalRound& round, double epsilon, int failures) {
    if (slides() && failures % 2 == 1) return smooth();
    descend(round, epsilon);
  }

  // scratch.give = e (r - r_c) of the round just solved; the largest [m/s].
  double noteGive(double epsilon) {
    double largest = 0;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const double e = epsilon * scratch_.weight[static_cast<std::size_t>(i)];
      for (int row = problem_.firstRow(i); row < problem_.firstRow(i + 1); ++row) {
        const auto k = static_cast<std::size_t>(row);
        scratch_.give[k] = e * (scratch_.r[k] - scratch_.centre[k]);
        largest = std::max(largest, std::abs(scratch_.give[k]));
      }
    }
    return largest;
  }

  // Takes the centre for the answer for q + give. False if it isn't.
  bool giveWay(double give) {
    if (!(give <= options_.largest_give)) return false;
    const ContactError before = error_;
    WorstResidual worst;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      double *const u = scratch_.u.data() + first, *const r = scratch_.centre.data() + first;
      for (int k = 0; k < problem_.rows(i); ++k) u[k] += scratch_.give[static_cast<std::size_t>(first + k)];
      const double w = scratch_.weight[static_cast<std::size_t>(i)];
      worst.add(naturalMap2(r, u, problem_.rows(i), problem_.friction(i), w), u[kNormalRow], w * r[kNormalRow]);
    }
    error_ = worst.relativeTo(referenceSpeed(problem_));
    if (!isEnough()) {
      error_ = before;
      return false;
    }
    result_.give = give;
    keep();
    return true;
  }

  void conclude() {
    const bool gives = result_.give > 0;
    if (!gives) error_ = best_;
    if (!gives && !isEnough())
      result_.method = SolveMethod::kNotConverged;
    else if (gives || result_.method == SolveMethod::kNoContact)
      result_.method = SolveMethod::kNewton;
  }

  // The last resort where walls close on what friction jams, without looking for another answer first.
  void goSoft() {
    MoverMatrix matrix(problem_, scratch_);
    ProximalRound round(problem_, matrix, scratch_);
    result_.method = SolveMethod::kNotConverged;
    result_.yields = matrix.fits();
    matrix.fits() ? softenShifted(round) : holdNothing();
  }

  void soften(ProximalRound& round) {
    result_.method = SolveMethod::kNotConverged;
    result_.yields = true;
    for (const double epsilon : kSoftEpsilons) {
      if (softens(round, Shift::kFollows, {epsilon, left(), kSoftSteps})) return;
    }
    softenShifted(round);
  }
  // Where friction jams what walls close on, soft contacts have no answer by Coulomb's law either. With the shift of no
  // impulse there is one, the least of a convex energy: it brings no energy in, and |r_i| <= |q| / e_i.
  void softenShifted(ProximalRound& round) {
    const double least = std::max(left(), kRough * referenceSpeed(problem_));
    if (softens(round, Shift::kFrozen, {kSoftestEpsilon, least, kMostDescentSteps})) return;
    result_.yields = false;
    holdNothing();
  }
  bool softens(ProximalRound& round, Shift shift, const ProximalRound::Limits& limits) {
    letGo();
    if (!round.solve(shift, limits, result_.iterations)) return false;
    scratch_.centre.swap(scratch_.r);
    error_ = errorOf(problem_, scratch_.centre.data(), scratch_, scratch_.u.data());
    keep();
    return true;
  }
  void holdNothing() {
    letGo();
    keep();
  }
  void letGo() {
    std::fill(scratch_.centre.begin(), scratch_.centre.begin() + rows(), 0.0);
    error_ = errorOf(problem_, scratch_.centre.data(), scratch_, scratch_.u.data());
  }

  void sweep() {
    const double many = std::max(kMostAccuracies * finest(), std::min(limit(), options_.accuracy));
    const double enough = std::max(isFew() ? limit() : many, options_.tolerance * referenceSpeed(problem_));
    respond(problem_, scratch_.best_r.data(), scratch_);
    error_ = respondedError(problem_, scratch_.best_r.data(), scratch_, scratch_.best_u.data());
    const SweptResult sweeps =
        Sweeps(problem_, scratch_, scratch_.best_r.data()).until(enough, error_, scratch_.best_u.data());
    result_.iterations += sweeps.sweeps;
    error_ = best_ = sweeps.error;
    result_.method = error_.speed <= enough ? SolveMethod::kSweeps : SolveMethod::kNotConverged;
  }

  void write(double* r, double* u) {
    const bool found = std::isfinite(best_.residual);
    for (int row = 0; row < rows(); ++row) {
      r[row] = found ? scratch_.best_r[static_cast<std::size_t>(row)] : 0;
      u[row] = scratch_.best_u[static_cast<std::size_t>(row)];
    }
    result_.residual = best_.residual;
    result_.error = best_.speed;
    result_.converged = result_.method != SolveMethod::kNotConverged;
  }

  const ContactProblem& problem_;
  const SolverOptions& options_;
  SolverScratch& scratch_;
  std::int64_t last_operation_ = 0, step_cost_ = 1;
  ContactError error_, best_;
  double slip_ = 0;
  bool has_swept_ = false;  // all that it may before factors
  bool settles_ = false;    // the start is near, or none: else the next one will be as far off, whatever is done
  SolveResult result_;
};

}  // namespace

SolveResult searchImpulses(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch,
                           double* r, double* u) {
  return Search(problem, options, scratch).run(r, u);
}

}  // namespace pincer::engine
