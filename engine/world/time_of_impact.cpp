// When bodies hit each other: the root of the gap along the path that the solved contacts give.
#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"
#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/world/budget.h"
#include "pincer/engine/world/colliders.h"
#include "pincer/engine/world/held_body.h"
#include "pincer/engine/world/impact.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/tree_motion.h"

namespace pincer::engine {
namespace {

constexpr double kGapRoundOff = 1e-14;  // at which the root is found [m]
constexpr int kRootSteps = 40;          // a sphere above a plane needs one, rotating boxes five or six
constexpr int kNewtonSteps = 8;         // more go to and fro between two points that close in turn

// Gap of one contact point, its rate and acceleration, as they are at one moment.
struct Approach {
  double phi, u, a;

  // Time to phi = 0 on the parabola; infinite if it opens before it closes. What
  // overlaps has closed, if ever, in the past.
  double timeLeft() const {
    const double root = std::sqrt(std::max(u * u - 2 * a * phi, 0.0));
    if (u < 0) return phi > 0 && u * u < 2 * a * phi ? std::numeric_limits<double>::infinity() : 2 * phi / (root - u);
    return a < 0 ? (root + u) / -a : std::numeric_limits<double>::infinity();
  }
};

// Where the body is, and how it moves, `t` after the start of this part of the tick, on the path that advance() takes.
struct Moment {
  Pose X_WI;
  Motion motion;
};

Moment momentOf(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int i, double t) {
  PINCER_ASSERT(scratch.h > 0 && t >= 0);
  const BodyModel& body = model.bodies[i];
  const BodyState& s = state.bodies[i];
  const BodyScratch& now = scratch.bodies[i];
  if (!body.dynamic) {
    if (!body.driven) return {s.X_WI, {}};
    const DrivenPlace place = drivenPlace({s.X_WI, {s.v_W, state.driven_w_W[body.motion]}}, {now.X_WB_end, now.free},
                                          scratch.h, t / scratch.h);
    return {place.X_WB, place.motion};
  }
  if (isHeldBody(model, body)) {
    const int n = body.joint_group;
    const BodyState at = heldBodyAt(model, model.joint_groups[n], scratch.joint_groups[n], now, s, scratch.h, t);
    return {at.X_WI, {at.v_W, angularVelocity(body.rotation, at.X_WI.q, at.L_W)}};
  }
  if (body.tree >= 0) {
    const LinkMoment link = linkAt(model, state, scratch, i, t);
    return {link.X_WI, link.motion};
  }
  const Vec3 dv_W = now.free.v_W + body.inverse_mass * now.impulse_W - s.v_W;
  const double share = now.closing ? 1 : t / scratch.h;     // of the change of velocity that has happened
  const double mean_share = now.closing ? 1 : 0.5 * share;  // in the mean until then
  Moment m;
  m.X_WI.p = s.X_WI.p + t * (s.v_W + mean_share * dv_W);
  m.X_WI.q = s.X_WI.q;
  rotateFreely(body.rotation, s.L_W + mean_share * now.angular_impulse_W, t, m.X_WI.q);
  m.motion.v_W = s.v_W + share * dv_W;
  m.motion.w_W = angularVelocity(body.rotation, m.X_WI.q, s.L_W + share * now.angular_impulse_W);
  return m;
}

// The search for when one pair closes.
class ClosingPair {
 public:
  ClosingPair(const WorldModel& model, const WorldState& state, WorldScratch& scratch, ImpactPair pair)
      : model_(model), state_(state), scratch_(scratch), pair_(pair) {
    const double before = (scratch.bodies[pair.a].start.v_W - scratch.bodies[pair.b].start.v_W).norm();
    const double after = (endVelocity(model, scratch, pair.a) - endVelocity(model, scratch, pair.b)).norm();
    margin_ = 2 * (contactMargin(model.bodies[pair.a], model.bodies[pair.b]) + scratch.h * std::max(before, after));
  }

  // Newton's method on the parabolas of the points. A gap between convex bodies that don't turn is a convex function of
  // time, so that each step falls short of the root: so does a search that the budget cuts short; how far the bodies
  // may turn in a step is limited by the gap.
  double time() {
    double t = 0;
    Bracket bracket;
    for (int n = 0; n < kRootSteps && !isSpent(scratch_); ++n) {
      const Next next = look(t);
      if (!(next.step <= scratch_.h - t)) return std::numeric_limits<double>::infinity();
      bracket.narrow(t, next.phi);
      t = std::max(t + next.step, 0.0);
      if (n >= kNewtonSteps) t = bracket.within(t);
      if (std::abs(next.phi) <= kGapRoundOff || t == 0 || next.is_exact) return t;
    }
    return t;
  }

 private:
  struct Next {
    double step = std::numeric_limits<double>::infinity();  // [s]
    double phi = std::numeric_limits<double>::infinity();   // gap of the point that closes first [m]
    bool is_exact = false;                                  // the step is below the round-off of the time
  };

  // Of moments looked at, the last one before anything overlaps and the first one at which something does [s].
  struct Bracket {
    double open = 0, closed = std::numeric_limits<double>::infinity();

    void narrow(double t, double phi) {
      if (phi < 0)
        closed = std::min(closed, t);
      else if (t < closed)
        open = std::max(open, t);
    }
    // `t`, or the middle where that is no nearer to the root than an end.
    double within(double t) const {
      constexpr double kEnd = 1e-3;  // of the bracket
      const double end = kEnd * (closed - open);
      return t > open + end && t < closed - end ? t : std::isfinite(closed) ? 0.5 * (open + closed) : t;
    }
  };

  Next look(double t) {
    const BodyModel &A = model_.bodies[pair_.a], &B = model_.bodies[pair_.b];
    const Moment a = momentOf(model_, state_, scratch_, pair_.a, t), b = momentOf(model_, state_, scratch_, pair_.b, t);
    const bool are_lone = A.collider_count == 1 && B.collider_count == 1;
    const Vec3 acceleration_W = acceleration(pair_.a) - acceleration(pair_.b);
    Next next;
    double nearest = margin_;
    const auto look_at = [&](const ColliderModel& ca, const Pose& X_WA, const ColliderModel& cb, const Pose& X_WB) {
      contact::PairPoints found;
      chargeQuery(ca, cb, scratch_);
      contact::collideShapes(ca.shape, X_WA, cb.shape, X_WB, margin_, scratch_.patches, found, {last_n_W_});
      if (are_lone && found.count > 0) last_n_W_ = found.points[0].n_W;
      for (int i = 0; i < found.count; ++i) {
        const contact::PairPoint& point = found.points[i];
        nearest = std::min(nearest, point.phi);
        const Approach approach{point.phi, rateOf(a, b, point), point.n_W.dot(acceleration_W)};
        const double step = approach.timeLeft();
        if (pair_.lands && isBystander(ca, cb, point, approach)) continue;
        if (step < next.step) next = {step, point.phi, false};
      }
    };
    forEachNearShapes(model_, A, a.X_WI * A.X_IB, B, b.X_WI * B.X_IB, margin_, look_at);
    return limitTurn(a, b, nearest, next);
  }

  // Of the gap at this point [m/s].
  static double rateOf(const Moment& a, const Moment& b, const contact::PairPoint& point) {
    const Vec3 v_a = a.motion.v_W + a.motion.w_W.cross(point.p_W - a.X_WI.p),
               v_b = b.motion.v_W + b.motion.w_W.cross(point.p_W - b.X_WI.p);
    return point.n_W.dot(v_a - v_b);
  }

  // Of a pair that touches already: what touches, and what closes slowly.
  bool isBystander(const ColliderModel& a, const ColliderModel& b, const contact::PairPoint& point,
                   const Approach& approach) const {
    return approach.u > -kAlongWith * hardLanding(model_, scratch_) ||
           pushedBefore(state_, contactId(model_.shape_bits, sideOf(model_, a), sideOf(model_, b), point.feature));
  }

  Next limitTurn(const Moment& a, const Moment& b, double nearest, Next next) const {
    const BodyModel &A = model_.bodies[pair_.a], &B = model_.bodies[pair_.b];
    // speed of what turns [m/s]
    const double turning = a.motion.w_W.norm() * A.corner_reach + b.motion.w_W.norm() * B.corner_reach;
    const double longest = (std::max(nearest, 0.0) + 0.25 * std::min(A.inner_radius, B.inner_radius)) / turning;
    if (turning > 0 && next.step > longest) return {longest, next.phi, false};
    next.is_exact = std::abs(next.step) <= 1e-15 * scratch_.h;
    return next;
  }

  Vec3 acceleration(int i) const {
    const BodyScratch& now = scratch_.bodies[i];
    if (now.closing) return Vec3::Zero();
    return (endVelocity(model_, scratch_, i) - now.start.v_W) / scratch_.h;
  }

  const WorldModel& model_;
  const WorldState& state_;
  WorldScratch& scratch_;
  ImpactPair pair_;
  double margin_;
  Vec3 last_n_W_ = Vec3::Zero();  // of the last look: the next one begins there; of two bodies with one shape each
};

}  // namespace

double timeOfImpact(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  double first = std::numeric_limits<double>::infinity();
  for (const ImpactPair& pair : scratch.impact_pairs) {
    const double t = pair.stop >= 0
                         ? timeOfStop(model, state, scratch, scratch.joint_rows[static_cast<std::size_t>(pair.stop)])
                         : ClosingPair(model, state, scratch, pair).time();
    first = std::min(first, t);
  }
  return first;
}

}  // namespace pincer::engine
