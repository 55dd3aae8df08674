#include "pincer/engine/world/impact.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/solve/local_contact.h"
#include "pincer/engine/world/budget.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/tree_motion.h"

namespace pincer::engine {
namespace {

constexpr double kShortestFlight = 1.0 / 16;  // of a tick
// Of half the thinner one's thickness, in a tick: the pair need not be swept. In a heap it will do that neither has
// passed the other's middle in the middle of the tick.
constexpr double kSlowWay = 0.5, kSlowWayInHeap = 2;
constexpr double kEnergyRoundOff = 1e-12;  // of the energy that goes to and fro in a hit
constexpr double kHardLanding = 1;         // of what gravity adds to a velocity in a tick
// gap at which a contact takes part in an impact [m]: what other contacts leave of the root
constexpr double kTouching = 1e-7;

bool isDynamic(const WorldModel& model, const Side& side) {
  return side.kind == SideKind::kBody && model.bodies[side.index].dynamic;
}

std::span<const ContactMemory> memories(const WorldState& state) {
  return {state.contacts.data(), static_cast<std::size_t>(state.contact_count)};
}

// True if a contact of the pair pushed in the last tick.
bool isTouching(const WorldModel& model, const WorldState& state, int a, int b) {
  const std::uint64_t first = contactId(model.shape_bits, {SideKind::kBody, 0, a}, {SideKind::kBody, 0, b}, 0);
  const auto all = memories(state);
  const auto less = [](const ContactMemory& m, std::uint64_t id) { return m.id < id; };
  auto m = std::lower_bound(all.begin(), all.end(), first, less);
  for (; m != all.end() && isOfSameTwo(model.shape_bits, m->id, first); ++m) {
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

// True if two bodies that go `way` past each other in a tick have to be swept.
bool isFarFor(const WorldModel& model, const WorldState& state, int a, int b, const Vec3& way) {
  const double thinner = std::min(model.bodies[a].inner_radius, model.bodies[b].inner_radius);
  const double slow = (isHeap(state) ? kSlowWayInHeap : kSlowWay) * thinner;
  return way.squaredNorm() > slow * slow;
}

// At the start of this part of the tick [m/s].
double normalVelocity(const WorldScratch& scratch, const Contact& c) {
  const BodyScratch &sa = scratch.bodies[c.a.index], &sb = scratch.bodies[c.b.index];
  const Vec3 v_a = sa.start.v_W + sa.start.w_W.cross(c.p_W - sa.X_WI_mid.p);
  const Vec3 v_b = sb.start.v_W + sb.start.w_W.cross(c.p_W - sb.X_WI_mid.p);
  return c.n_W().dot(v_a - v_b);
}

// A pair that hit without a bounce is one that touches from then on.
void noteLanded(WorldScratch& scratch) {
  std::vector<ImpactPair>& landed = scratch.landed_pairs;
  for (const Contact& c : scratch.contacts) {
    if (c.a.kind != SideKind::kBody || c.b.kind != SideKind::kBody) continue;
    if (!c.active() || c.bias_C[kNormalRow] != 0 || isNoted(landed, c.a.index, c.b.index)) continue;
    if (landed.size() < landed.capacity()) landed.push_back({c.a.index, c.b.index});
  }
}

// A contact that closes in this tick, if nothing holds it up, and then bounces.
bool mayBounce(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, const Contact& c) {
  if (!(c.material.restitution > 0)) return false;
  const double u = normalVelocity(scratch, c), a = gapAcceleration(model, scratch, c);
  if (u >= 0 && a >= 0) return false;
  const double phi = std::max(c.phi - 0.5 * scratch.h * u, 0.0);
  const double u_hit = -std::sqrt(std::max(u * u - 2 * a * phi, 0.0));
  if (!(bounceRestitution(c.material.restitution, u_hit, a, model.options.h) > 0)) return false;
  return !isTouching(model, state, c.a.index, c.b.index);
}

// Contacts that bounce, or are too fast.
void holdBackHits(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  for (const auto* pairs : {&scratch.fast_pairs, &scratch.pushed_pairs}) {
    for (const ImpactPair& pair : *pairs) {
      if (isNoted(scratch.impact_pairs, pair.a, pair.b) || isTouching(model, state, pair.a, pair.b) ||
          isNoted(scratch.landed_pairs, pair.a, pair.b))
        continue;
      PINCER_ASSERT(scratch.impact_pairs.size() < scratch.impact_pairs.capacity());  // the tick allocates nothing
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

// Further than a gap can be told in advance from where it is in the middle of the part.
bool turnsFar(const WorldScratch& scratch, int body) {
  constexpr double kFar = 0.02;  // [rad]: it errs by 2 um where the body reaches 10 mm
  return scratch.h * scratch.h * scratch.bodies[body].start.w_W.squaredNorm() > kFar * kFar;
}

// A contact that closes in this part of the tick, and how fast: a new one, whose gap isn't round-off.
bool closesFaster(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, const Contact& c,
                  double speed) {
  if (c.a.kind != SideKind::kBody || c.b.kind != SideKind::kBody) return false;
  if (c.material.restitution > 0 || pushedBefore(state, c.id)) return false;
  if (turnsFar(scratch, c.a.index) || turnsFar(scratch, c.b.index)) return false;
  const double u = normalVelocity(scratch, c), a = std::min(gapAcceleration(model, scratch, c), 0.0);
  const double phi = c.phi - 0.5 * scratch.h * u, u_end = u + a * scratch.h;
  return phi > kTouching && u_end < -speed && phi + kLate * scratch.h * u_end < 0;
}

// Notes the pairs that land hard, and takes the contacts that close out of scratch.contacts.
void holdBackLandings(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  const auto is_of_bodies = [](const Contact& c) { return c.a.kind == SideKind::kBody; };
  if (std::none_of(scratch.contacts.begin(), scratch.contacts.end(), is_of_bodies)) return;
  const double hard = hardLanding(model, scratch);
  const std::size_t before = scratch.impact_pairs.size();
  for (const Contact& c : scratch.contacts) {
    if (!closesFaster(model, state, scratch, c, hard) || isNoted(scratch.impact_pairs, c.a.index, c.b.index)) continue;
    scratch.impact_pairs.push_back({c.a.index, c.b.index, true});
  }
  if (scratch.impact_pairs.size() == before) return;
  std::erase_if(scratch.contacts, [&](const Contact& c) {
    return closesFaster(model, state, scratch, c, kAlongWith * hard) &&
           isNoted(scratch.impact_pairs, c.a.index, c.b.index);
  });
}

// True if contacts push some body so hard that it goes far for what it is, which its velocity at the start didn't show.
bool somethingIsPushed(const WorldModel& model, const WorldScratch& scratch) {
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyScratch& body = scratch.bodies[i];
    if (!body.touched || !model.bodies[i].dynamic) continue;
    const double least = kSlowWay * kSlowWay * model.bodies[i].inner_radius;  // [m]
    const Vec3 way = scratch.h * model.bodies[i].inverse_mass * body.impulse_W;
    if (way.squaredNorm() > least * least) return true;
  }
  return false;
}

// A massless fingertip behind its spring gives way: in no time it takes no impulse.
bool givesWay(const WorldModel& model, const Side& side) {
  if (side.kind != SideKind::kPoint) return false;
  const DrivenPointModel& point = model.points[side.index];
  return point.mass <= 0 && !point.locked.all();
}

// Keeps the contacts that touch and hang together with a hit.
void keepStruck(const WorldModel& model, WorldScratch& scratch) {
  std::fill(scratch.struck.begin(), scratch.struck.end(), false);
  const auto strike = [&](int body) {
    scratch.struck[body] = true;
    if (model.bodies[body].tree >= 0) {
      for (const TreeLink& link : model.trees[model.bodies[body].tree].links) scratch.struck[link.body] = true;
    }
    if (model.bodies[body].joint_group < 0) return;
    for (const int other : model.joint_groups[model.bodies[body].joint_group].bodies) scratch.struck[other] = true;
  };
  for (const ImpactPair& pair : scratch.impact_pairs) {
    strike(pair.a);
    strike(pair.b);
  }
  std::erase_if(scratch.contacts,
                [&](const Contact& c) { return c.phi > kTouching || givesWay(model, c.a) || givesWay(model, c.b); });
  const auto isStruck = [&](const Side& side) {
    if (side.kind == SideKind::kJoint) {
      const int tree = scratch.joint_rows[side.index].tree;
      return tree >= 0 && scratch.struck[model.trees[tree].links.front().body];
    }
    return isDynamic(model, side) && scratch.struck[side.index];
  };
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

// Of the first island's first contact.
std::span<const ContactSide> sidesOfFirst(const IslandScratch& s) {
  if (!s.islands.front().has_many_sides) return s.sides[0];
  return {s.many_sides.data(), static_cast<std::size_t>(s.first_side[1])};
}

// A hit that nothing else hangs together with, nearly always the case, is solved to round-off. One that friction jams
// has no answer: its bounded impulse stays (squeeze.h), round-off would make it 1e12 times as large.
void sharpenSingleImpact(WorldScratch& scratch) {
  if (!scratch.solve.converged || scratch.contacts.size() != 1 || scratch.islands.islands.empty()) return;
  const int rows = scratch.first_row[1];
  double W[kMaxContactRows * kMaxContactRows] = {};
  for (const ContactSide& side : sidesOfFirst(scratch.islands)) {
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
  for (int k = 0; k < rows; ++k) {
    scratch.u[k] = scratch.q[k];
    for (int l = 0; l < rows; ++l) scratch.u[k] += W[k + l * rows] * c.r[l];
  }
  c.impulse_W = c.R_WC * c.r.head<3>();
}

// Kinetic energy that the hits' impulses r bring in, E(s r) = s along + s^2 response / 2 [J]. By the velocities of the
// two sides relative to each other, so that what a driven body gives by pushing on isn't counted: a racket may.
struct BroughtIn {
  double along = 0;     // r . u-
  double response = 0;  // r . W r, by what the solve has for u+ = u- + W r + biases
  double moved = 0;     // sum of |r . u-|

  explicit BroughtIn(const WorldScratch& scratch) {
    for (std::size_t i = 0; i < scratch.contacts.size(); ++i) {
      const Contact& c = scratch.contacts[i];
      if (!c.active()) continue;
      const double* const u = scratch.u.data() + scratch.first_row[i];
      double work = 0;
      for (int k = 0; k < rowsOf(c.material); ++k) {
        const double radius = k >= kTorsionRow ? radiusOf(c, k) : 1, before = radius * c.v_start_C[k];
        work += c.r[k] * before;
        response += c.r[k] * (u[k] - before - radius * c.bias_C[k]);
      }
      along += work;
      moved += std::abs(work);
    }
  }
  bool isMore() const { return along + 0.5 * response > kEnergyRoundOff * moved; }
};

// Scales impulses that bring in energy without any restitution too to the least energy on their ray.
void takeOutEnergy(const WorldModel& model, WorldScratch& scratch) {
  const BroughtIn energy(scratch);
  if (!energy.isMore()) return;
  const double share = energy.along < 0 ? -energy.along / energy.response : 0;
  for (Contact& c : scratch.contacts) {
    c.r *= share;
    c.impulse_W *= share;
  }
  scratch.solve.converged = false;
  gatherImpulses(model, scratch);
}

}  // namespace

bool pushedBefore(const WorldState& state, std::uint64_t id) {
  const auto all = memories(state);
  const auto m =
      std::lower_bound(all.begin(), all.end(), id, [](const ContactMemory& x, std::uint64_t y) { return x.id < y; });
  return m != all.end() && m->id == id && m->active;
}

double hardLanding(const WorldModel& model, const WorldScratch& scratch) {
  return kHardLanding * model.options.h * scratch.gravity_W.norm();
}

Vec3 endVelocity(const WorldModel& model, const WorldScratch& scratch, int i) {
  const BodyScratch& now = scratch.bodies[i];
  return model.bodies[i].dynamic ? Vec3(now.free.v_W + model.bodies[i].inverse_mass * now.impulse_W) : now.free.v_W;
}

Vec3 endAngularVelocity(const WorldModel& model, const WorldScratch& scratch, int i) {
  const BodyScratch& now = scratch.bodies[i];
  return now.free.w_W +
         angularVelocity(model.bodies[i].rotation, now.X_WI_mid.q, now.angular_impulse_W - now.free_angular_impulse_W);
}

double gapAcceleration(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  if (c.a.kind == SideKind::kJoint) return scratch.joint_rows[c.a.index].acceleration;
  const auto acceleration = [&](const Side& side) {
    if (!isDynamic(model, side)) return Vec3(Vec3::Zero());
    const BodyForce* const force = forceOn(scratch, static_cast<std::size_t>(side.index));
    return force ? Vec3(scratch.gravity_W + model.bodies[side.index].inverse_mass * force->f_W) : scratch.gravity_W;
  };
  return c.n_W().dot(acceleration(c.a) - acceleration(c.b));
}

double bounceRestitution(double restitution, double u, double acceleration, double h) {
  PINCER_ASSERT(0 <= restitution && restitution <= 1);
  if (!(u < -kClosingSpeed)) return 0;
  const double flight = -2 * restitution * u;  // times the acceleration that closes the gap
  const double shortest = std::max(kShortestFlight, 1 - restitution) * h;
  return flight >= shortest * -acceleration ? restitution : 0;
}

void noteFastPair(const WorldModel& model, const WorldState& state, int a, int b, WorldScratch& scratch) {
  PINCER_ASSERT(a < b);
  const Vec3 way = model.options.h * (scratch.bodies[a].start.v_W - scratch.bodies[b].start.v_W);
  if (!isFarFor(model, state, a, b, way)) return;
  if (scratch.fast_pairs.size() < scratch.fast_pairs.capacity()) scratch.fast_pairs.push_back({a, b});
}

void notePushedPairs(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  if (!somethingIsPushed(model, scratch)) return;
  for (const PairModel& pair : model.pairs) {
    if (!scratch.bodies[pair.a].touched && !scratch.bodies[pair.b].touched) continue;
    const Vec3 way = scratch.h * (endVelocity(model, scratch, pair.a) - endVelocity(model, scratch, pair.b));
    if (!isFarFor(model, state, pair.a, pair.b, way) || isTouching(model, state, pair.a, pair.b)) continue;
    const auto is_seen = [&](const Contact& c) { return isOfBodies(c, pair.a, pair.b); };
    if (std::any_of(scratch.contacts.begin(), scratch.contacts.end(), is_seen)) continue;
    if (isNoted(scratch.impact_pairs, pair.a, pair.b) || scratch.pushed_pairs.size() == scratch.pushed_pairs.capacity())
      continue;
    scratch.pushed_pairs.push_back({pair.a, pair.b});
    scratch.impact_pairs.push_back({pair.a, pair.b});
  }
}

void holdBackImpacts(const WorldModel& model, const WorldState& state, bool landings, WorldScratch& scratch) {
  scratch.impact_pairs.clear();
  if (!scratch.fast_pairs.empty() || !scratch.pushed_pairs.empty() || model.bounces)
    holdBackHits(model, state, scratch);
  if (landings) holdBackLandings(model, state, scratch);
  if (!model.trees.empty()) noteStopHits(model, scratch);
}

bool impactsWait(const WorldModel& model, const WorldState& state, const WorldScratch& scratch) {
  for (const auto* pairs : {&scratch.fast_pairs, &scratch.pushed_pairs}) {
    for (const ImpactPair& pair : *pairs) {
      if (!isTouching(model, state, pair.a, pair.b) && !isNoted(scratch.landed_pairs, pair.a, pair.b)) return true;
    }
  }
  return model.bounces && std::any_of(scratch.contacts.begin(), scratch.contacts.end(), [&](const Contact& c) {
           return c.a.kind == SideKind::kBody && c.b.kind == SideKind::kBody && mayBounce(model, state, scratch, c);
         });
}

bool somethingBounces(const WorldScratch& scratch) {
  return std::any_of(scratch.contacts.begin(), scratch.contacts.end(),
                     [](const Contact& c) { return c.bias_C[kNormalRow] != 0; });
}

ImpactPair hardestHit(const WorldScratch& scratch) {
  ImpactPair pair{-1, -1};
  double largest = 0;
  for (const Contact& c : scratch.contacts) {
    if (c.a.kind != SideKind::kBody || c.b.kind != SideKind::kBody || !(c.r[kNormalRow] > largest)) continue;
    largest = c.r[kNormalRow];
    pair = {c.a.index, c.b.index};
  }
  return pair;
}

bool applyImpacts(const WorldModel& model, WorldState& state, WorldScratch& scratch, ContactSource* source) {
  predictImpact(model, state, scratch);
  collideBodies(model, state, scratch);
  if (source) source->addContacts(scratch);
  if (!model.trees.empty()) {
    startJointRows(model, state, scratch);
    putJointRows(model, state, scratch);
  }
  keepStruck(model, scratch);
  for (int quarters = 4; quarters >= 0; --quarters) {
    scratch.bounce = 0.25 * quarters;
    prepareContacts(model, state, scratch);
    solveContacts(model, scratch);
    sharpenSingleImpact(scratch);
    gatherImpulses(model, scratch);
    if (!BroughtIn(scratch).isMore() || !somethingBounces(scratch)) break;
  }
  takeOutEnergy(model, scratch);
  noteLanded(scratch);
  const bool turns_too_far = limitTurns(model, scratch);
  if (!model.trees.empty()) strikeTrees(model, state, scratch);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (!model.bodies[i].dynamic || model.bodies[i].tree >= 0) continue;
    state.bodies[i].v_W += model.bodies[i].inverse_mass * scratch.bodies[i].impulse_W;
    state.bodies[i].L_W += scratch.bodies[i].angular_impulse_W;
  }
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    state.points[i].v_W += scratch.points[i].response(scratch.points[i].impulse_W);
    scratch.points[i].tick_impulse_W += scratch.points[i].impulse_W;
  }
  return turns_too_far;
}

}  // namespace pincer::engine
