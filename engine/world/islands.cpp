#include "pincer/engine/world/islands.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/few_contacts.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/grip.h"
#include "pincer/engine/world/island_sides.h"
#include "pincer/engine/world/island_threads.h"
#include "pincer/engine/world/rest.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/engine/world/solve_island.h"
#include "pincer/engine/world/tree_sides.h"

namespace pincer::engine {
namespace {

constexpr int kSettlingTicks = 24;  // stick offsets halve per tick: from the tolerance to round-off
// the same of bodies that ring on the springs of fingers, by 5 % less per tick, and of links whose drives relax
constexpr int kRingingTicks = 240;

// The number of what moves there in IslandScratch's arrays per mover; -1 for what doesn't.
int moverOf(const WorldModel& model, const WorldScratch& scratch, const Contact& c, bool is_a) {
  const Side& side = is_a ? c.a : c.b;
  if (side.kind == SideKind::kJoint) return moverOfRow(model, scratch, c, is_a);
  if (side.kind == SideKind::kBody) {
    const BodyModel& body = model.bodies[side.index];
    if (body.tree >= 0) return moverOfLink(model, body);
    // joined bodies are one mover
    if (body.joint_group >= 0) return model.joint_groups[body.joint_group].bodies.front();
    return body.dynamic ? side.index : -1;
  }
  const PointScratch& point = scratch.points[side.index];
  const Vec3& inverse_mass = point.inverse_mass;
  const bool moves = inverse_mass[0] != 0 || inverse_mass[1] != 0 || inverse_mass[2] != 0 || point.inverse_twist > 0 ||
                     point.inverse_turn > 0;
  return moves ? static_cast<int>(model.bodies.size()) + side.index : -1;
}

int rootOf(std::vector<int>& parent, int mover) {
  while (parent[mover] != mover) mover = parent[mover] = parent[parent[mover]];
  return mover;
}

void findEnds(const WorldModel& model, const WorldScratch& scratch, IslandScratch& s) {
  ContactEnds* ends = s.ends.data();
  int *const parent = s.parent.data(), *const number = s.number.data(), *const island_of = s.island_of.data();
  s.near.clear();
  const Contact* before = nullptr;
  for (const Contact& c : scratch.contacts) {
    if (c.far) {
      ++ends;
      continue;
    }
    s.near.push_back(static_cast<int>(&c - scratch.contacts.data()));
    if (before && before + 1 == &c && isOfSameTwo(*before, c) && c.a.kind != SideKind::kJoint) {
      *ends = ends[-1];  // as a face's contacts all have
      before = &c;
      ++ends;
      continue;
    }
    before = &c;
    *ends = {moverOf(model, scratch, c, true), moverOf(model, scratch, c, false)};
    for (const int end : {ends->a, ends->b}) {
      forEachOf(s, end, [&](int mover) {
        parent[mover] = mover;
        number[mover] = island_of[mover] = -1;
      });
    }
    ++ends;
  }
}

bool touches(const ContactEnds& ends, int mover) { return ends.a == mover || ends.b == mover; }

// All contacts touch one mover, as in a grasp: they are one island.
bool haveCommonMover(const IslandScratch& s) {
  const ContactEnds& first = s.ends[s.near[0]];
  for (const int mover : {first.a, first.b}) {
    if (mover >= 0 && std::all_of(s.near.begin(), s.near.end(), [&](int i) { return touches(s.ends[i], mover); }))
      return true;
  }
  return false;
}

void uniteMovers(IslandScratch& s) {
  const auto unite = [&](int x, int y) {
    const int a = rootOf(s.parent, x), b = rootOf(s.parent, y);
    s.parent[std::max(a, b)] = std::min(a, b);
  };
  for (const int i : s.near) {
    const ContactEnds& ends = s.ends[i];
    for (const int end : {ends.a, ends.b})
      forEachOf(s, end < 0 ? -1 : parentOf(s, end), [&](int mover) { unite(end, mover); });
    if (ends.a >= 0 && ends.b >= 0) unite(ends.a, ends.b);
  }
}

void makeOneIsland(IslandScratch& s) {
  s.islands.clear();
  s.islands.emplace_back().contacts = static_cast<int>(s.near.size());
  std::copy(s.near.begin(), s.near.end(), s.order.begin());
}

void sortContacts(IslandScratch& s) {
  s.islands.clear();
  for (const int i : s.near) {
    const ContactEnds& ends = s.ends[i];
    PINCER_ASSERT(ends.a >= 0 || ends.b >= 0);  // two that never move have no contact
    const int root = rootOf(s.parent, std::max(ends.a, ends.b));
    if (s.island_of[root] < 0) {
      s.island_of[root] = static_cast<int>(s.islands.size());
      s.islands.emplace_back();
    }
    s.contact_island[i] = s.island_of[root];
    ++s.islands[s.island_of[root]].contacts;
  }
  int place = 0;
  for (Island& island : s.islands) {
    island.place = place;
    place += island.contacts;
    island.contacts = 0;
  }
  for (const int i : s.near) {
    Island& island = s.islands[s.contact_island[i]];
    s.order[island.place + island.contacts++] = i;
  }
  PINCER_ASSERT(place == static_cast<int>(s.near.size()));
}

// Of the only island: as it lies.
void takeRows(WorldScratch& scratch, Island& island) {
  island.first_row = scratch.first_row.data();
  island.mu = scratch.mu.data();
  island.q = scratch.q.data();
  island.r = scratch.r.data();
  island.u = scratch.u.data();
  island.rows = island.first_row[island.contacts];
}

// Of an island among others.
void copyRows(const WorldScratch& scratch, Island& island, IslandScratch& s) {
  const int first = kMaxContactRows * island.work;
  island.first_row = s.first_row.data() + 2 * island.work;
  island.mu = s.mu.data() + island.work;
  island.q = s.q.data() + first;
  island.r = s.r.data() + first;
  island.u = s.u.data() + first;
  const int *const order = s.order.data() + island.place, *const from_row = scratch.first_row.data();
  const double *const all_mu = scratch.mu.data(), *const all_q = scratch.q.data(), *const all_r = scratch.r.data();
  int rows_before = 0;
  for (int n = 0; n < island.contacts; ++n) {
    const int i = order[n], from = from_row[i], rows = from_row[i + 1] - from;
    island.first_row[n] = rows_before;
    island.mu[n] = all_mu[i];
    withRows(rows, [&](auto count) {
      for (int l = 0; l < count; ++l) {
        island.q[rows_before + l] = all_q[from + l];
        island.r[rows_before + l] = all_r[from + l];
      }
    });
    rows_before += rows;
  }
  PINCER_ASSERT(first + rows_before <= static_cast<int>(s.q.size()));
  island.first_row[island.contacts] = island.rows = rows_before;
}

// Its rows and sides.
void gather(const WorldModel& model, Island& island, WorldScratch& scratch) {
  IslandScratch& s = scratch.islands;
  if (s.islands.size() == 1 && scratch.far_contacts == 0) {
    takeRows(scratch, island);
  } else {
    copyRows(scratch, island, s);
  }
  island.holds_trees = holdsTrees(s, island);
  island.has_many_sides = hasManySides(s, island);
  island.has_sides = island.has_many_sides || !mayBeGrip(s, island, scratch.contacts);
  if (island.has_many_sides) {
    fillManySides(model, scratch, island, s);
  } else if (island.has_sides) {
    fillSides(model, scratch, island, s);
  } else {
    numberMovers(model, scratch, island, s);
  }
}

int countRows(const WorldScratch& scratch) {
  if (scratch.far_contacts == 0) return scratch.first_row[static_cast<int>(scratch.contacts.size())];
  int rows = 0;
  for (const int i : scratch.islands.near) rows += scratch.first_row[i + 1] - scratch.first_row[i];
  return rows;
}

// For how long warm starts have to be exact to round-off: from an answer that took iterations on, until it is clear
// that none comes that is. One that fits isn't the end of it: the impulses of a body that still slows down by 1e-13 m/s
// in a tick, kept, would turn it round and move it off.
// Of links the number never grows while warm starts stay within the tolerance: drives push by the round-off of their
// coordinates, so that no exact one lasts, and at most so many ticks take iterations for that alone.
int nextSettling(const Island& island, bool by_fingers, double tolerance) {
  if (!(island.result.start <= tolerance)) return by_fingers || island.holds_trees ? kRingingTicks : kSettlingTicks;
  if (island.result.method != SolveMethod::kWarmStart) return island.settling - 1;
  if (island.holds_trees) return std::min(island.settling, kSettlingTicks);
  return island.settling > 0 ? kSettlingTicks : 0;
}

bool isHeldByFingers(const IslandScratch& s, const Island& island, const WorldScratch& scratch) {
  if (island.contacts > kFewContacts) return false;
  const int* const order = s.order.data() + island.place;
  return std::any_of(order, order + island.contacts,
                     [&](int i) { return scratch.contacts[i].a.kind == SideKind::kPoint; });
}

// Beyond kDenseContacts equations are by movers, which leave 1e-11 m/s to round-off: rows of 15 balls would shake by
// that for ever.
double restSpeed(const Island& island, const WorldOptions& options) {
  const double on_links = island.holds_trees ? linkNoise(options.h) : 0;
  const double of_many = island.contacts > kDenseContacts ? 2 * restErrorOf(options.solver) : 0;
  return std::max({kRestSpeed, on_links, of_many});
}

void scatter(const IslandScratch& s, const Island& island, const WorldModel& model, WorldScratch& scratch) {
  const int settling = nextSettling(island, isHeldByFingers(s, island, scratch), model.options.solver.tolerance);
  const double rest_speed = island.result.method == SolveMethod::kWarmStart ? restSpeed(island, model.options) : 0;
  const int *const order = s.order.data() + island.place, *const from_row = scratch.first_row.data();
  Contact* const contacts = scratch.contacts.data();
  const double *r_k = island.r, *u_k = island.u;
  double *const r = scratch.r.data(), *const u = scratch.u.data();
  for (int n = 0; n < island.contacts; ++n) {
    const int i = order[n];
    contacts[i].settling = settling;
    contacts[i].rest_speed = rest_speed;
    contacts[i].yields = island.result.yields;
    contacts[i].as_asked = contacts[i].as_asked && island.as_asked;
    const int first = from_row[i], rows = from_row[i + 1] - first;
    if (island.r != r) {  // copied
      withRows(rows, [&](auto count) {
        for (int l = 0; l < count; ++l) {
          r[first + l] = r_k[l];
          u[first + l] = u_k[l];
        }
      });
      r_k += rows;
      u_k += rows;
    }
    readSolution(model, scratch, i, island.result.error, contacts[i]);
  }
}

void addResult(const SolveResult& island, SolveResult& all) {
  all.method = std::max(all.method, island.method);
  all.iterations += island.iterations;
  all.residual = std::max(all.residual, island.residual);
  all.error = std::max(all.error, island.error);
  all.converged = all.converged && island.converged;
  all.give = std::max(all.give, island.give);
}

}  // namespace

void takeManySides(const Island& island, const IslandScratch& s, ContactProblem& problem) {
  const auto n = static_cast<std::size_t>(island.contacts), work = static_cast<std::size_t>(island.work);
  problem.first_side = {s.first_side.data() + 2 * work, n + 1};
  problem.sides = {s.many_sides.data() + static_cast<std::size_t>(s.sides_per_contact) * work,
                   static_cast<std::size_t>(problem.first_side.back())};
}

void solveIslands(const WorldModel& model, WorldScratch& scratch) {
  IslandScratch& s = scratch.islands;
  scratch.solve = {};
  if (scratch.contacts.empty()) return;
  findEnds(model, scratch, s);
  ++s.solves;
  s.islands.clear();
  if (s.near.empty()) return;
  if (haveCommonMover(s)) {
    makeOneIsland(s);
  } else {
    uniteMovers(s);
    sortContacts(s);
  }
  s.rows = countRows(scratch);
  const int count = static_cast<int>(s.islands.size());
  const bool is_shared = s.threads && count > 1;
  std::int64_t operations = 0;
  const auto conclude = [&](const Island& island) {
    addResult(island.result, scratch.solve);
    scatter(s, island, model, scratch);
    operations += island.operations;
    scratch.hit_operations += island.hit_operations;
  };
  if (is_shared) {
    for (Island& island : s.islands) {
      island.work = island.place;
      gather(model, island, scratch);
    }
    s.threads->run(count, [&](int k, int thread) { solveIsland(model, k, thread, scratch); });
    for (const Island& island : s.islands) conclude(island);
  }
  for (int k = 0; k < count && !is_shared; ++k) {  // each as a whole, while it is in the cache
    Island& island = s.islands[static_cast<std::size_t>(k)];
    gather(model, island, scratch);
    solveIsland(model, k, 0, scratch);
    conclude(island);
  }
  if (scratch.operations_left < kNoLimit) scratch.operations_left -= operations;  // below 0 if one of them ran out
}

}  // namespace pincer::engine
