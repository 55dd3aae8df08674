#include "pincer/engine/solve/stuck_contacts.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/few_contacts.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/mover_normals.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/squeeze.h"
#include "pincer/engine/solve/stuck_steps.h"

namespace pincer::engine {
namespace {

// of corners of pads that contradict each other, as turning by 5 rad/s lets them [m/s]
constexpr double kPadGive = 1e-5;

// Steps with a set of contacts that hold.
class StuckSolve {
 public:
  StuckSolve(const ContactProblem& problem, const StuckMovers& movers, SolverScratch& scratch, double* r, double* u)
      : problem_(problem), movers_(movers), scratch_(scratch), r_(r), u_(u) {}

  // u and the error of r.
  ContactError error() { return errorOf(problem_, r_, scratch_, u_); }
  bool maySqueeze() const { return isSqueezed(problem_, scratch_.weight, r_); }

  bool holds(int i) const { return holds_[i]; }
  // Contacts that push.
  void holdWhatPushes() {
    for (int i = 0; i < problem_.contactCount(); ++i) holds_[i] = pushes(i);
  }
  void holdAll() { std::fill(holds_, holds_ + problem_.contactCount(), true); }
  // False if none had to be let go.
  bool letGoWhatPulls() {
    bool any = false;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      if (!holds_[i] || pushes(i)) continue;
      holds_[i] = false;
      any = true;
    }
    return any;
  }

  // False if a contact slides or opens, or has to push that doesn't yet: of answers in which fewer
  // contacts hold, a step can't tell the right one.
  bool allStayAsTheyAre() const {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i), rows = problem_.rows(i);
      double y[kMaxContactRows] = {};
      for (int k = 0; k < rows; ++k)
        y[k] = scratch_.weight[static_cast<std::size_t>(i)] * r_[first + k] - u_[first + k];
      const ContactMode mode = contactMode(y, rows, problem_.friction(i));
      if (mode != (holds_[i] ? ContactMode::kStick : ContactMode::kOpen)) return false;
    }
    return true;
  }

  // True if all that hold push, and need no more than `share` of their friction.
  bool holdsWith(double share) const {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const double* const r_i = r_ + problem_.firstRow(i);
      if (holds_[i] && !(pushes(i) && isInCone(r_i, problem_.rows(i), share * problem_.friction(i)))) return false;
    }
    return true;
  }

  // A step from r and u. False if there is none.
  bool step() {
    MoverNormals normals(movers_);
    double y[kMoverFreedoms * kMostStuckMovers];
    std::fill(y, y + kMoverFreedoms * problem_.movers, 0.0);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      if (!holds_[i]) continue;
      normals.add(problem_.sidesOf(i), problem_.rows(i));
      double b[kMaxContactRows];
      for (int k = 0; k < problem_.rows(i); ++k) b[k] = -u_[problem_.firstRow(i) + k];
      addImpulse(problem_.sidesOf(i), problem_.rows(i), b, y);
    }
    if (!normals.factorise()) return false;
    normals.solve(y);
    normals.solve(y);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      if (holds_[i]) addVelocity(problem_.sidesOf(i), problem_.rows(i), y, r_ + problem_.firstRow(i));
    }
    return true;
  }

 private:
  bool pushes(int i) const { return r_[problem_.firstRow(i) + kNormalRow] > 0; }

  const ContactProblem& problem_;
  const StuckMovers& movers_;
  SolverScratch& scratch_;
  double *r_, *u_;
  bool holds_[kFewContacts];
};

// The two ways to an answer, each from its own start.
class StuckAnswer {
 public:
  StuckAnswer(const ContactProblem& problem, const StuckMovers& movers, const SolverOptions& options,
              SolverScratch& scratch, double* r, double* u)
      : problem_(problem), options_(options), scratch_(scratch), r_(r), u_(u), solve_(problem, movers, scratch, r, u) {}

  // From the warm start.
  bool nearest(SolveResult& result) { return holdNearest(problem_, options_, solve_, scratch_, result); }

  // From none: of all impulses with which everything sticks, the least.
  bool least(SolveResult& result) {
    solve_.holdAll();
    startFromNone();
    while (result.iterations < kMostStuckSteps && mayStep() && solve_.step()) {
      if (solve_.letGoWhatPulls()) {
        startFromNone();
        ++result.iterations;
        continue;
      }
      if (!solve_.holdsWith(1)) return false;
      ++result.iterations;
      if (isEnough(solve_.error(), result)) return true;
    }
    return result.iterations == kMostStuckSteps && giveWay(result);
  }

 private:
  bool mayStep() { return spend(stuckOperations(problem_), scratch_); }
  void startFromNone() {
    std::fill(r_, r_ + problem_.rowCount(), 0.0);
    solve_.error();
  }
  bool isEnough(const ContactError& error, SolveResult& result) const {
    result.residual = error.residual;
    result.error = error.speed;
    return error.residual <= 0.5 * options_.tolerance && !solve_.maySqueeze();
  }

  // No impulses take away what is left of the velocities of contacts that hold: they
  // contradict each other by that, and give way.
  bool giveWay(SolveResult& result) {
    WorstResidual worst;
    double most = 0;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i), rows = problem_.rows(i);
      for (int k = first; k < first + rows; ++k) {
        const double give = scratch_.give[static_cast<std::size_t>(k)] = solve_.holds(i) ? -u_[k] : 0;
        most = std::max(most, std::abs(give));
        u_[k] += give;
      }
      const double w = scratch_.weight[static_cast<std::size_t>(i)];
      worst.add(naturalMap2(r_ + first, u_ + first, rows, problem_.friction(i), w), u_[first + kNormalRow],
                w * r_[first + kNormalRow]);
    }
    result.give = most;
    return most <= kPadGive && isEnough(worst.relativeTo(referenceSpeed(problem_)), result);
  }

  const ContactProblem& problem_;
  const SolverOptions& options_;
  SolverScratch& scratch_;
  double *r_, *u_;
  StuckSolve solve_;
};

// True if a point touches a body with more than one contact, as the face of a fingertip does.
bool hasFace(const ContactProblem& problem) {
  for (int i = 1; i < problem.contactCount(); ++i) {
    const std::span<const ContactSide> before = problem.sidesOf(i - 1), sides = problem.sidesOf(i);
    bool is_same = sides.size() == before.size(), is_point = false;
    for (std::size_t k = 0; k < sides.size() && is_same; ++k) {
      is_same = is_same && sides[k].mover == before[k].mover;
      is_point = is_point || (sides[k].mover >= 0 && sides[k].is_point);
    }
    if (is_same && is_point) return true;
  }
  return false;
}

}  // namespace

bool solveStuckContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r,
                        double* u, SolveResult& result) {
  PINCER_ASSERT(problem.contactCount() <= kFewContacts);
  StuckMovers movers;
  if (!movers.count(problem)) return false;
  double* const r_start = scratch.impulses[0].data();
  std::copy(r, r + problem.rowCount(), r_start);
  StuckAnswer answer(problem, movers, options, scratch, r, u);
  SolveResult found = result;
  found.method = SolveMethod::kNewton;
  bool is_solved = answer.nearest(found);
  if (!is_solved && hasFace(problem)) {
    found.iterations = result.iterations;
    is_solved = answer.least(found);
  }
  if (is_solved) {
    result = found;
  } else if (!std::equal(r, r + problem.rowCount(), r_start)) {
    std::copy(r_start, r_start + problem.rowCount(), r);
    errorOf(problem, r, scratch, u);
  }
  return is_solved;
}

}  // namespace pincer::engine
