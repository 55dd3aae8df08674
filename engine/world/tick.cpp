// One tick from its parts: whole, unless bodies hit each other in it, or a tolerance asks for more.
#include <algorithm>
#include <cmath>
#include <utility>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/world/budget.h"
#include "pincer/engine/world/drive_rows.h"
#include "pincer/engine/world/far_contacts.h"
#include "pincer/engine/world/impact.h"
#include "pincer/engine/world/island_sleep.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/part_inputs.h"
#include "pincer/engine/world/push_out.h"
#include "pincer/engine/world/rest.h"
#include "pincer/engine/world/stages.h"
#include "pincer/engine/world/state_checks.h"
#include "pincer/engine/world/tree_motion.h"
#include "pincer/engine/world/tried_impulses.h"
#include "pincer/engine/world/unchanged_pairs.h"

namespace pincer::engine {
namespace {

constexpr int kMostRevisions = 4;      // of which joint rows are needed, in an attempt
constexpr int kMostTurningParts = 64;  // that a tick is cut into for that
constexpr std::int64_t kPerBody = 300, kPerPair = 100, kPerContact = 1000;  // multiplications besides the solver's
constexpr double kShortestPart = 1e-9;  // of a tick: a hit sooner than that is a hit at once
constexpr int kMostHeapImpacts = 5;     // of a heap: what hits after the first few lands

class Tick {
 public:
  Tick(const WorldModel& model, WorldState& state, WorldScratch& scratch, const StepInputs& inputs,
       ContactSource* source)
      : model_(model), state_(state), scratch_(scratch), inputs_(inputs), source_(source), left_(model.options.h) {}

  StepReport run() {
    if (model_.options.sleep && repeatsItself(model_, state_, scratch_, inputs_) &&
        (!source_ || source_->repeatsItself()))
      return sleep();
    applyForces();
    scratch_.contacts_dropped = false;
    scratch_.solves = 0;
    scratch_.hit_operations = 0;
    const double budget = model_.options.solver.budget;
    scratch_.operations_left = budget > 0 ? static_cast<std::int64_t>(budget * kOperationsPerSecond) : kNoLimit;
    if (isSomethingAsleep(scratch_)) wakeChanged(model_, state_, inputs_, scratch_);
    for (std::size_t i = 0; i < state_.points.size(); ++i) scratch_.points[i].v_tick_W = state_.points[i].v_W;
    if (model_.options.position_tolerance > 0) {
      runToTolerance();
    } else {
      runInParts(1);
    }
    ++state_.tick;
    state_.time = static_cast<double>(state_.tick) * model_.options.h;
    report_.contacts = contactCount(scratch_);
    report_.solve = scratch_.solve;
    if (scratch_.contacts_dropped) report_.status |= kContactsDropped;
    if (isSpent()) report_.status |= kBudgetSpent;
    if (!isFinite(state_)) report_.status |= kStateNotFinite;
    if (model_.options.sleep) noteSleep();
    return report_;
  }

 private:
  void applyForces() {
    const AppliedForces& applied = inputs_.applied;
    const auto is_finite = [](const BodyForce& force) { return force.f_W.allFinite() && force.tau_W.allFinite(); };
    forces_ok_ = (!applied.gravity_W || applied.gravity_W->allFinite()) &&
                 std::all_of(applied.forces.begin(), applied.forces.end(), is_finite);
    scratch_.gravity_W = forces_ok_ ? applied.gravity_W.value_or(model_.options.gravity_W) : model_.options.gravity_W;
    scratch_.forces = forces_ok_ ? applied.forces : std::span<const BodyForce>{};
  }

  // All of the world, as soon as all of it rests; before that what does.
  void noteSleep() {
    noteRest(state_, inputs_, report_.status == kStepOk && impacts_ == 0, scratch_);
    const bool is_whole = report_.parts == 1 && impacts_ == 0 && model_.options.position_tolerance == 0;
    if (is_whole && !scratch_.sleep.rest.candidate) fallAsleep(model_, state_, scratch_);
  }

  // The contacts of the last tick are those of this one.
  StepReport sleep() {
    ++state_.tick;
    state_.time = static_cast<double>(state_.tick) * model_.options.h;
    report_.contacts = contactCount(scratch_);
    report_.solve = scratch_.solve;
    report_.parts = state_.parts;
    report_.asleep = true;
    return report_;
  }

  // Doubles the parts until what they change is within the tolerance: halving a second-order step leaves a third of the
  // change as error. The next tick begins with half of what this one needed.
  void runToTolerance() {
    scratch_.before = state_;
    int parts = std::max(1, state_.parts / 2);
    while (parts < model_.options.max_parts && turnsFar(parts)) parts *= 2;
    runInParts(parts);
    for (;;) {
      if (2 * parts > model_.options.max_parts || isSpent()) {
        report_.status |= kToleranceNotMet;
        break;
      }
      scratch_.coarse = state_;
      state_ = scratch_.before;
      parts *= 2;
      runInParts(parts);
      if (largestDistance(model_, scratch_.coarse, state_) <= 3 * model_.options.position_tolerance) break;
    }
    state_.parts = parts;
  }

  // A part in which a body turns by more than this is too coarse to judge by halving it.
  bool turnsFar(int parts) const {
    constexpr double kLargestTurn = 0.2;  // [rad]
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      if (!model_.bodies[i].may_touch || !model_.bodies[i].dynamic) continue;
      const double turn = bodyAngularVelocity(model_, state_, static_cast<int>(i)).norm() * model_.options.h;
      if (turn > kLargestTurn * parts) return true;
    }
    return false;
  }

  void runInParts(int parts) {
    const double h = model_.options.h;
    left_ = part_ = h;
    impacts_ = landings_ = 0;
    last_pair_ = last_hit_ = {-1, -1};
    scratch_.pushed_pairs.clear();
    scratch_.landed_pairs.clear();
    scratch_.tried.clear();
    is_tried_ = false;
    report_ = {};
    report_.parts = 0;
    if (!forces_ok_) report_.status |= kInputNotFinite;
    for (PointScratch& point : scratch_.points) point.tick_impulse_W.setZero();
    for (int k = parts - 1; k >= 0; --k) {
      stop_ = h * k / parts;
      while (left_ > stop_) passTime();
    }
  }

  // To the end of this part, or as far as what touches doesn't turn too far, or to the next impact and through it.
  void passTime() {
    const double rest = left_ - stop_;
    if (scratch_.flings) forgetFlung();
    double h = rest < 2.001 * part_ || isSpent() ? rest : 2 * part_;  // leaves no crumb of round-off
    attempt(h);
    turns_far_ = somethingTurnsFar(h);
    for (; turns_far_ && !isSpent() && h > model_.options.h / kMostTurningParts; turns_far_ = somethingTurnsFar(h))
      attempt(h *= 0.5);
    if (model_.has_corners && !isSpent() && flingsCorners(h)) attempt(h);
    part_ = h;
    if (mayHit()) notePushedPairs(model_, state_, scratch_);
    if (isSpent() && !scratch_.impact_pairs.empty()) attempt(h);  // which holds nothing back any more
    double t = h;
    if (!scratch_.impact_pairs.empty()) t = timeOfImpact(model_, state_, scratch_);
    if (!(t < h) && somethingLands()) {  // and misses, by a little: its contact counts in this part after all
      attempt(h, false);
      t = scratch_.impact_pairs.empty() ? h : timeOfImpact(model_, state_, scratch_);
    }
    if (!(t < h)) return finish(h);
    const bool lands = somethingLands();
    if (t > kShortestPart * model_.options.h) {
      t = cutAt(t);
      conclude();
      left_ -= t;
    }
    // A part that is cut so short that nothing is held back any more has landed it.
    landings_ += scratch_.impact_pairs.empty() ? lands : somethingLands();
    const double energy = isLimited(scratch_) ? energyOf(model_, state_, scratch_.gravity_W) : 0;
    wakeAll(scratch_);
    if (is_tried_) keepTried(scratch_);
    is_tried_ = false;
    if (applyImpacts(model_, state_, scratch_, source_)) report_.status |= kTurnsTooFar;
    chargeSurroundings();
    if (isSpent()) limitEnergy(model_, scratch_, energy, state_);
    note();
    const bool are_enough = ++impacts_ >= (isHeap(state_) ? kMostHeapImpacts : kMostImpacts);
    if (isRepeated(t) || are_enough) impacts_ = kMostImpacts;
  }

  // True if the hits before were of the same pair without any time between, or of the same bodies without a bounce
  // and with hardly any: what rattles between two others would hit them ever sooner, without end. It lands.
  bool isRepeated(double t) {
    constexpr int kMostRepeats = 3;  // hits in a row (decision 11)
    constexpr double kSoon = 1e-2;   // of a tick
    const ImpactPair pair = scratch_.impact_pairs.front(), last = std::exchange(last_pair_, pair);
    const ImpactPair hit = hardestHit(scratch_), last_hit = std::exchange(last_hit_, hit);
    const auto is_hit_again = [&](int body) {
      return body >= 0 && model_.bodies[body].dynamic && (body == last_hit.a || body == last_hit.b);
    };
    const bool at_once = !(t > kShortestPart * model_.options.h) && pair.a == last.a && pair.b == last.b;
    const bool rattles =
        !(t > kSoon * model_.options.h) && (is_hit_again(hit.a) || is_hit_again(hit.b)) && !somethingBounces(scratch_);
    repeats_ = at_once || rattles ? repeats_ + 1 : 0;
    return repeats_ >= kMostRepeats;
  }

  // Attempts the part up to the hit. What fingers push goes another way there than over the whole part: a hit
  // that comes sooner on that way cuts it again.
  double cutAt(double t) {
    constexpr int kMostCuts = 4;                          // of one part of a tick: each is a solve
    constexpr double kSooner = 0.999, kSameTime = 1e-14;  // of the time of the hit: a gain, and round-off
    attempt(t);
    for (int n = 0; n < kMostCuts && !isSpent() && hitsStop(); ++n) {
      const double again = timeOfImpact(model_, state_, scratch_);
      if (!(std::abs(again - t) > kSameTime * t && again < model_.options.h)) break;
      attempt(t = again);
    }
    for (int n = 0; n < kMostCuts && !isSpent() && somethingPushesImpacts(); ++n) {
      const double sooner = timeOfImpact(model_, state_, scratch_);
      if (!(sooner < kSooner * t && sooner > kShortestPart * model_.options.h)) break;
      attempt(t = sooner);
    }
    return t;
  }

  bool somethingLands() const {
    return std::any_of(scratch_.impact_pairs.begin(), scratch_.impact_pairs.end(),
                       [](const ImpactPair& p) { return p.lands; });
  }

  bool hitsStop() const { return !scratch_.impact_pairs.empty() && scratch_.impact_pairs.front().stop >= 0; }
  bool somethingPushesImpacts() const {
    return std::any_of(scratch_.impact_pairs.begin(), scratch_.impact_pairs.end(), [&](const ImpactPair& p) {
      return scratch_.bodies[p.a].touched || scratch_.bodies[p.b].touched;
    });
  }

  void finish(double h) {
    conclude();
    left_ = h < left_ - stop_ ? left_ - h : stop_;
  }
  // Bodies that something pushes on. Contacts wander round a body that turns so far, and those of the middle don't show
  // it: needles and sheets, which friction spins up, would gain energy.
  bool somethingTurnsFar(double h) const {
    if (treesTurnFar(model_, state_, scratch_)) return true;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const BodyScratch& body = scratch_.bodies[i];
      if (!body.touched || !model_.bodies[i].dynamic ||
          model_.bodies[i].rotation.kind == FreeRotation::Kind::kSpherical)
        continue;
      const Vec3 w_end_W = endAngularVelocity(model_, scratch_, static_cast<int>(i));
      if (h * h * std::max(body.start.w_W.squaredNorm(), w_end_W.squaredNorm()) > kFarTurn * kFarTurn) return true;
    }
    return false;
  }

  // Contacts may fling a corner of a body further within this part than anything was looked for: those of a sheet
  // between the floor and something heavy. Then its contacts are looked for so far. Whether there is such a body; in a
  // heap, where that is one solve more of all that is hit, only if it is thin.
  bool flingsCorners(double h) {
    const bool is_heap = isHeap(state_);
    bool flings = false;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const BodyModel& body = model_.bodies[i];
      BodyScratch& s = scratch_.bodies[i];
      if (!s.touched || !body.dynamic || body.corner_reach == 0) continue;
      const double way =
          h * body.corner_reach * angularVelocity(body.rotation, s.X_WI_mid.q, s.angular_impulse_W).norm();
      if (!(way > std::max({body.contact_margin, s.flung, is_heap ? body.inner_radius : 0.0}))) continue;
      s.flung = way;
      flings = true;
    }
    return scratch_.flings = flings;
  }

  void forgetFlung() {
    for (BodyScratch& body : scratch_.bodies) body.flung = 0;
    scratch_.flings = false;
  }

  // Where contacts sweep under a body that turns so far, or hits are left out, its answer could bring in energy.
  void conclude() {
    note();
    const bool is_rough = isSpent() || turns_far_ || impacts_ == kMostImpacts || haveHitsSpent(scratch_);
    const double energy = is_rough ? energyOf(model_, state_, scratch_.gravity_W) : 0;
    if (turns_far_ && treesTurnFar(model_, state_, scratch_)) report_.status |= kTurnsTooFar;
    if (limitTurns(model_, scratch_)) report_.status |= kTurnsTooFar;
    advance(model_, state_, scratch_);
    is_tried_ = false;
    scratch_.tried.clear();
    pushOut(model_, state_, scratch_);
    if (is_rough) limitEnergy(model_, scratch_, energy, state_);
    ++report_.parts;
    mark(scratch_, Stage::kAdvance);
  }

  // `landings`: what lands is held back.
  void attempt(double h, bool landings = true) {
    PINCER_ASSERT(h > 0 && h <= model_.options.h);
    if (is_tried_) keepTried(scratch_);
    is_tried_ = true;
    scratch_.h = h;
    report_.status |= setPartInputs(model_, inputs_, h, left_, state_, scratch_);
    if (isSomethingAsleep(scratch_) && h != model_.options.h) wakeAll(scratch_);
    if (!model_.trees.empty()) startTrees(landings);
    bool again = false;
    do {
      predict(model_, state_, scratch_);
      beginContacts(state_, again, scratch_);
      mark(scratch_, Stage::kPredict);
      collideBodies(model_, state_, scratch_);
      mark(scratch_, Stage::kCollideBodies);
      if (!model_.trees.empty()) putJointRows(model_, state_, scratch_);
      if (source_ && !again) source_->addContacts(scratch_);
      again = true;
    } while (isSomethingAsleep(scratch_) && wakeTouched(scratch_));
    if (mayHit()) {
      holdBackImpacts(model_, state_, landings && !model_.has_broad_phase && landings_ < kMostLandings, scratch_);
    } else {
      scratch_.impact_pairs.clear();
      if (impactsWait(model_, state_, scratch_)) report_.status |= kImpactsCut;
    }
    solveAttempt();
    for (int n = 0; n < kMostRevisions && !model_.trees.empty() && reviseJointRows(model_, state_, scratch_); ++n) {
      predictTrees(model_, state_, scratch_);
      putJointRows(model_, state_, scratch_);
      solveAttempt();
    }
    mark(scratch_, Stage::kSolve);
    chargeSurroundings();
  }

  void startTrees(bool landings) {
    using Hit = JointRowScratch::Hit;
    scratch_.stops_hit = !mayHit() ? Hit::kNone : landings && landings_ < kMostLandings ? Hit::kLands : Hit::kBounces;
    startJointRows(model_, state_, scratch_);
  }

  void solveAttempt() {
    prepareContacts(model_, state_, scratch_);
    startFromTried(scratch_);
    do {
      solveContacts(model_, scratch_);
      gatherImpulses(model_, scratch_);
    } while (haveFarClosed(model_, scratch_));
    noteSolved(state_, scratch_);
  }

  // Cost of a part of a tick besides its solve.
  void chargeSurroundings() {
    charge(kPerBody * std::ssize(scratch_.bodies) + kPerPair * std::ssize(model_.pairs) +
               kPerContact * std::ssize(scratch_.contacts),
           scratch_);
  }

  bool isSpent() const { return engine::isSpent(scratch_); }
  bool mayHit() const { return impacts_ < kMostImpacts && !isSpent() && !haveHitsSpent(scratch_); }
  void note() {
    if (!scratch_.solve.converged) report_.status |= kSolverNotConverged;
  }

  const WorldModel& model_;
  WorldState& state_;
  WorldScratch& scratch_;
  const StepInputs& inputs_;
  ContactSource* source_;
  double left_;             // of the tick [s]
  double part_ = 0;         // length of the last part, before a hit cut it [s]
  double stop_ = 0;         // what is left of the tick at the end of this part [s]
  bool is_tried_ = false;   // the contacts are those of an attempt that isn't concluded
  bool forces_ok_ = true;   // those applied are finite
  bool turns_far_ = false;  // something does in this part, and it can't be cut any more
  int impacts_ = 0;         // in this tick
  int landings_ = 0;        // of them that don't bounce
  ImpactPair last_pair_{-1, -1}, last_hit_{-1, -1};
  int repeats_ = 0;  // of them, hardly any time apart
  StepReport report_;
};

}  // namespace

StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch, const StepInputs& inputs) {
  return step(model, state, scratch, inputs, nullptr);
}

StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch, const StepInputs& inputs,
                ContactSource* source) {
  PINCER_DEMAND(inputs.points.size() == model.points.size(), "step: one input per driven point");
  PINCER_DEMAND(inputs.applied.forces.empty() || inputs.applied.forces.size() == model.bodies.size(),
                "step: one force per body, or none");
  PINCER_DEMAND(inputs.motions.size() <= static_cast<std::size_t>(model.driven_count),
                "step: no more motions than driven bodies");
  PINCER_DEMAND(state.bodies.size() == model.bodies.size() && state.points.size() == model.points.size() &&
                    state.contacts.size() == static_cast<std::size_t>(model.options.max_contacts) &&
                    state.driven_w_W.size() == static_cast<std::size_t>(model.driven_count),
                "step: the state is one of this model (makeState)");
  PINCER_DEMAND(scratch.bodies.size() == model.bodies.size() && scratch.points.size() == model.points.size() &&
                    scratch.mu.size() == static_cast<std::size_t>(model.options.max_contacts),
                "step: the scratch is one of this model");
  if (scratch.clock) scratch.clock->start();
  return Tick(model, state, scratch, inputs, source).run();
}

}  // namespace pincer::engine
