#include "engine/world/impact.h"

#include <algorithm>
#include <limits>

#include "contact/shape/pair_query.h"
#include "engine/solve/local_contact.h"
#include "engine/world/contact_rows.h"

namespace pincer::engine {
namespace {

constexpr double kShortestFlight = 1.0 / 16;  // of a tick
constexpr double kSlowWay = 0.5;              // of half the thickness, in a tick: the pair need not be swept
constexpr double kEnergyRoundOff = 1e-12;     // of the energy that goes to and fro in a hit
constexpr double kTouching = 1e-7;            // gap at which a contact takes part in an impact [m]: what other contacts leave of the root
constexpr double kGapRoundOff = 1e-14;        // at which the root is found [m]
constexpr int kRootSteps = 40;                // a sphere above a plane needs one, rotating boxes five or six

// Gap of one contact point, its rate and acceleration, as they are at one moment.
struct Approach {
  double phi, u, a;

  // Time to phi = 0 on the parabola; infinite if it opens before it closes. What overlaps has closed, if ever, in the past.
  double timeLeft() const {
    const double root = std::sqrt(std::max(u * u - 2 * a * phi, 0.0));
    if (u < 0) return phi > 0 && u * u < 2 * a * phi ? std::numeric_limits<double>::infinity() : 2 * phi / (root - u);
    return a < 0 ? (root + u) / -a : std::numeric_limits<double>::infinity();
  }
};

bool isDynamic(const WorldModel& model, const Side& side) { return side.kind == SideKind::kBody && model.bodies[side.index].dynamic; }

std::span<const ContactMemory> memories(const WorldState& state) {
  return {state.contacts.data(), static_cast<std::size_t>(state.contact_count)};
}

// Whether a contact of the pair pushed in the last tick.
bool isTouching(const WorldState& state, int a, int b) {
  const std::uint64_t first = contactId(0, a, b, 0);
  const auto all = memories(state);
  const auto less = [](const ContactMemory& m, std::uint64_t id) { return m.id < id; };
  for (auto m = std::lower_bound(all.begin(), all.end(), first, less); m != all.end() && m->id >> 32 == first >> 32; ++m) {
    if (m->active) return true;
  }
  return false;
}

bool isNoted(std::span<const ImpactPair> pairs, int a, int b) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const ImpactPair& p) { return p.a == a && p.b == b; });
}

bool isOfBodies(const Contact& c, int a, int b) {
  return c.a.kind == SideKind::kBody && c.b.kind == SideKind::kBody && c.a.index == a && c.b.index == b;
}

// Whether two bodies that go `way` past each other in a tick have to be swept.
bool isFarFor(const WorldModel& model, int a, int b, const Vec3& way) {
  const double slow = kSlowWay * std::min(model.bodies[a].inner_radius, model.bodies[b].inner_radius);
  return way.squaredNorm() > slow * slow;
}

// At the start of this part of the tick [m/s].
double normalVelocity(const WorldScratch& scratch, const Contact& c) {
  const BodyScratch &sa = scratch.bodies[c.a.index], &sb = scratch.bodies[c.b.index];
  const Vec3 v_a = sa.start.v_W + sa.start.w_W.cross(c.p_W - sa.X_WI_mid.p);
  const Vec3 v_b = sb.start.v_W + sb.start.w_W.cross(c.p_W - sb.X_WI_mid.p);
  return c.n_W().dot(v_a - v_b);
}

// Whether the pair touches without closing: it has hit in this tick, and now slides.
bool hasLanded(const WorldScratch& scratch, const ImpactPair& pair) {
  return std::any_of(scratch.contacts.begin(), scratch.contacts.end(), [&](const Contact& c) {
    if (!isOfBodies(c, pair.a, pair.b)) return false;
    const double u = normalVelocity(scratch, c);
    return std::abs(u) < kClosingSpeed && c.phi - 0.5 * scratch.h * u < kTouching;
  });
}

// A contact that closes in this tick, if nothing holds it up, and then bounces.
bool mayBounce(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, const Contact& c) {
  if (!(c.material.restitution > 0)) return false;
  const double u = normalVelocity(scratch, c), a = gapAcceleration(model, c);
  if (u >= 0 && a >= 0) return false;
  const double phi = std::max(c.phi - 0.5 * scratch.h * u, 0.0);
  const double u_hit = -std::sqrt(std::max(u * u - 2 * a * phi, 0.0));
  if (!(bounceRestitution(c.material.restitution, u_hit, a, model.options.h) > 0)) return false;
  return !isTouching(state, c.a.index, c.b.index);
}

// Where the body is, and how it moves, `t` after the start of this part of the tick, on the path that advance() takes.
struct Moment {
  Pose X_WI;
  Motion motion;
};

Moment momentOf(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, int i, double t) {
  const BodyModel& body = model.bodies[i];
  const BodyState& s = state.bodies[i];
  const BodyScratch& now = scratch.bodies[i];
  if (!body.dynamic) {
    if (!body.driven) return {s.X_WI, {}};
    const DrivenPlace place = drivenPlace({s.X_WI, {s.v_W, s.L_W}}, {now.X_WB_end, now.free}, scratch.h, t / scratch.h);
    return {place.X_WB, place.motion};
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

Vec3 endVelocity(const WorldModel& model, const WorldScratch& scratch, int i) {
  const BodyScratch& now = scratch.bodies[i];
  return model.bodies[i].dynamic ? Vec3(now.free.v_W + model.bodies[i].inverse_mass * now.impulse_W) : now.free.v_W;
}

// Whether contacts push some body so hard that it goes far for what it is, which its velocity at the start didn't show.
bool somethingIsPushed(const WorldModel& model, const WorldScratch& scratch) {
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyScratch& body = scratch.bodies[i];
    if (!body.touched || !model.bodies[i].dynamic) continue;
    if (scratch.h * model.bodies[i].inverse_mass * body.impulse_W.norm() > kSlowWay * kSlowWay * model.bodies[i].inner_radius) return true;
  }
  return false;
}

// The search for when one pair closes.
class ClosingPair {
 public:
  ClosingPair(const WorldModel& model, const WorldState& state, WorldScratch& scratch, ImpactPair pair)
      : model_(model), state_(state), scratch_(scratch), pair_(pair) {
    const double before = (scratch.bodies[pair.a].start.v_W - scratch.bodies[pair.b].start.v_W).norm();
    const double after = (endVelocity(model, scratch, pair.a) - endVelocity(model, scratch, pair.b)).norm();
    margin_ = 2 * (model.options.contact_margin + scratch.h * std::max(before, after));
  }

  // Newton's method on the parabolas of the points. A gap between convex bodies that don't turn is a convex function of time, so that each
  // step falls short of the root; how far the bodies may turn in a step is limited by the gap.
  double time() const {
    double t = 0;
    for (int n = 0; n < kRootSteps; ++n) {
      const Next next = look(t);
      if (!(next.step <= scratch_.h - t)) return std::numeric_limits<double>::infinity();
      t = std::max(t + next.step, 0.0);
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

  Next look(double t) const {
    const BodyModel &A = model_.bodies[pair_.a], &B = model_.bodies[pair_.b];
    const Moment a = momentOf(model_, state_, scratch_, pair_.a, t), b = momentOf(model_, state_, scratch_, pair_.b, t);
    contact::PairPoints found;
    contact::collideShapes(A.shape, a.X_WI * A.X_IB, B.shape, b.X_WI * B.X_IB, margin_, scratch_.patches, found);
    const Vec3 acceleration_W = acceleration(pair_.a) - acceleration(pair_.b);
    Next next;
    double nearest = margin_;
    for (int i = 0; i < found.count; ++i) {
      const contact::PairPoint& point = found.points[i];
      const Vec3 v_a = a.motion.v_W + a.motion.w_W.cross(point.p_W - a.X_WI.p),
                 v_b = b.motion.v_W + b.motion.w_W.cross(point.p_W - b.X_WI.p);
      const Approach approach{point.phi, point.n_W.dot(v_a - v_b), point.n_W.dot(acceleration_W)};
      nearest = std::min(nearest, point.phi);
      const double step = approach.timeLeft();
      if (step < next.step) next = {step, point.phi, false};
    }
    return limitTurn(a, b, nearest, next);
  }

  Next limitTurn(const Moment& a, const Moment& b, double nearest, Next next) const {
    const BodyModel &A = model_.bodies[pair_.a], &B = model_.bodies[pair_.b];
    const double turning = a.motion.w_W.norm() * A.corner_reach + b.motion.w_W.norm() * B.corner_reach;  // speed of what turns [m/s]
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
};

// A massless fingertip behind its spring gives way: in no time it takes no impulse.
bool givesWay(const WorldModel& model, const Side& side) {
  if (side.kind == SideKind::kBody) return false;
  const DrivenPointModel& point = model.points[side.index];
  return point.mass <= 0 && !point.locked.all();
}

// Keeps the contacts that touch and hang together with a hit.
void keepStruck(const WorldModel& model, WorldScratch& scratch) {
  std::fill(scratch.struck.begin(), scratch.struck.end(), false);
  const auto strike = [&](int body) {
    scratch.struck[body] = true;
    if (model.bodies[body].joint_group < 0) return;
    for (const int other : model.joint_groups[model.bodies[body].joint_group].bodies) scratch.struck[other] = true;
  };
  for (const ImpactPair& pair : scratch.impact_pairs) {
    strike(pair.a);
    strike(pair.b);
  }
  std::erase_if(scratch.contacts, [&](const Contact& c) { return c.phi > kTouching || givesWay(model, c.a) || givesWay(model, c.b); });
  const auto isStruck = [&](const Side& side) { return isDynamic(model, side) && scratch.struck[side.index]; };
  for (bool spreads = true; spreads;) {
    spreads = false;
    for (const Contact& c : scratch.contacts) {
      if (isStruck(c.a) == isStruck(c.b)) continue;
      for (const Side& side : {c.a, c.b}) {
        if (!isDynamic(model, side) || scratch.struck[side.index]) continue;
        strike(side.index);
        spreads = true;
      }
    }
  }
  std::erase_if(scratch.contacts, [&](const Contact& c) { return !isStruck(c.a) && !isStruck(c.b); });
}

// A hit that nothing else hangs together with, nearly always the case, is solved to round-off.
void sharpenSingleImpact(WorldScratch& scratch) {
  if (scratch.contacts.size() != 1) return;
  const int rows = scratch.first_row[1];
  double W[kMaxContactRows * kMaxContactRows] = {};
  for (const ContactSide& side : scratch.islands.sides[0]) {
    if (side.mover < 0) continue;
    for (int k = 0; k < rows; ++k) {
      for (int l = 0; l < rows; ++l) {
        for (int j = 0; j < kMoverFreedoms; ++j) W[k + l * rows] += side.A[k][j] * side.A[l][j];
      }
    }
  }
  Contact& c = scratch.contacts.front();
  c.r.setZero();
  solveOneContact(W, rows, scratch.q.data(), rows, c.mu, c.r.data());
  c.impulse_W = c.R_WC * c.r.head<3>();
}

// Whether the gathered impulses bring in more kinetic energy than the round-off of what they move.
bool addsEnergy(const WorldModel& model, const WorldScratch& scratch) {
  double energy = 0, moved = 0;
  const auto add = [&](const Vec3& impulse, const Vec3& before, const Vec3& change) {
    energy += impulse.dot(before + 0.5 * change);
    moved += std::abs(impulse.dot(before));
  };
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyScratch& s = scratch.bodies[i];
    if (!s.touched || !model.bodies[i].dynamic) continue;
    add(s.impulse_W, s.start.v_W, model.bodies[i].inverse_mass * s.impulse_W);
    add(s.angular_impulse_W, s.start.w_W, s.inverse_inertia_W * s.angular_impulse_W);
  }
  for (const PointScratch& s : scratch.points) {
    if (s.touched) add(s.impulse_W, s.start.v_W, s.response(s.impulse_W));
  }
  return energy > kEnergyRoundOff * moved;
}

}  // namespace

double gapAcceleration(const WorldModel& model, const Contact& c) {
  const int falling = static_cast<int>(isDynamic(model, c.a)) - static_cast<int>(isDynamic(model, c.b));
  return falling * c.n_W().dot(model.options.gravity_W);
}

double bounceRestitution(double restitution, double u, double acceleration, double h) {
  if (!(u < -kClosingSpeed)) return 0;
  const double flight = -2 * restitution * u;  // times the acceleration that closes the gap
  const double shortest = std::max(kShortestFlight, 1 - restitution) * h;
  return flight >= shortest * -acceleration ? restitution : 0;
}

void noteFastPair(const WorldModel& model, int a, int b, WorldScratch& scratch) {
  const Vec3 way = model.options.h * (scratch.bodies[a].start.v_W - scratch.bodies[b].start.v_W);
  if (!isFarFor(model, a, b, way)) return;
  if (scratch.fast_pairs.size() < scratch.fast_pairs.capacity()) scratch.fast_pairs.push_back({a, b});
}

void notePushedPairs(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  if (!somethingIsPushed(model, scratch)) return;
  for (const PairModel& pair : model.pairs) {
    if (!scratch.bodies[pair.a].touched && !scratch.bodies[pair.b].touched) continue;
    const Vec3 way = scratch.h * (endVelocity(model, scratch, pair.a) - endVelocity(model, scratch, pair.b));
    if (!isFarFor(model, pair.a, pair.b, way) || isTouching(state, pair.a, pair.b)) continue;
    const auto is_seen = [&](const Contact& c) { return isOfBodies(c, pair.a, pair.b); };
    if (std::any_of(scratch.contacts.begin(), scratch.contacts.end(), is_seen)) continue;
    if (isNoted(scratch.impact_pairs, pair.a, pair.b) || scratch.pushed_pairs.size() == scratch.pushed_pairs.capacity()) continue;
    scratch.pushed_pairs.push_back({pair.a, pair.b});
    scratch.impact_pairs.push_back({pair.a, pair.b});
  }
}

void holdBackImpacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  scratch.impact_pairs.clear();
  if (scratch.fast_pairs.empty() && scratch.pushed_pairs.empty() && !model.bounces) return;
  for (const auto* pairs : {&scratch.fast_pairs, &scratch.pushed_pairs}) {
    for (const ImpactPair& pair : *pairs) {
      if (isNoted(scratch.impact_pairs, pair.a, pair.b) || isTouching(state, pair.a, pair.b) || hasLanded(scratch, pair)) continue;
      scratch.impact_pairs.push_back(pair);
    }
  }
  std::erase_if(scratch.contacts, [&](const Contact& c) {
    if (c.a.kind != SideKind::kBody || c.b.kind != SideKind::kBody) return false;
    if (isNoted(scratch.impact_pairs, c.a.index, c.b.index)) return true;
    if (!mayBounce(model, state, scratch, c)) return false;
    scratch.impact_pairs.push_back({c.a.index, c.b.index});
    return true;
  });
}

bool impactsWait(const WorldModel& model, const WorldState& state, const WorldScratch& scratch) {
  for (const auto* pairs : {&scratch.fast_pairs, &scratch.pushed_pairs}) {
    for (const ImpactPair& pair : *pairs) {
      if (!isTouching(state, pair.a, pair.b) && !hasLanded(scratch, pair)) return true;
    }
  }
  return model.bounces && std::any_of(scratch.contacts.begin(), scratch.contacts.end(), [&](const Contact& c) {
           return c.a.kind == SideKind::kBody && c.b.kind == SideKind::kBody && mayBounce(model, state, scratch, c);
         });
}

double timeOfImpact(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  double first = std::numeric_limits<double>::infinity();
  for (const ImpactPair& pair : scratch.impact_pairs) first = std::min(first, ClosingPair(model, state, scratch, pair).time());
  return first;
}

void applyImpacts(const WorldModel& model, WorldState& state, WorldScratch& scratch, ContactSource* source) {
  predictImpact(model, state, scratch);
  collideBodies(model, state, scratch);
  if (source) source->addContacts(scratch);
  keepStruck(model, scratch);
  for (int quarters = 4; quarters >= 0; --quarters) {
    scratch.bounce = 0.25 * quarters;
    solveContacts(model, state, scratch);
    sharpenSingleImpact(scratch);
    gatherImpulses(model, scratch);
    if (!addsEnergy(model, scratch)) break;
  }
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (!model.bodies[i].dynamic) continue;
    state.bodies[i].v_W += model.bodies[i].inverse_mass * scratch.bodies[i].impulse_W;
    state.bodies[i].L_W += scratch.bodies[i].angular_impulse_W;
  }
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    state.points[i].v_W += scratch.points[i].response(scratch.points[i].impulse_W);
    scratch.points[i].tick_impulse_W += scratch.points[i].impulse_W;
  }
}

}  // namespace pincer::engine
