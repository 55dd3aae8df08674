#include "pincer/engine/world/island_sides.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/few_contacts.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/contact_sides.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/engine/world/tree_sides.h"

namespace pincer::engine {
namespace {

int numberOf(const WorldModel& model, const WorldScratch& scratch, const Side& side, int mover, Island& island,
             IslandScratch& s) {
  if (mover < 0) return -1;
  PINCER_ASSERT(isIndex(mover, s.number.size()));
  if (s.number[mover] < 0) {
    s.number[mover] = island.movers++;
    if (side.kind == SideKind::kBody && model.bodies[side.index].tree < 0) {
      const BodyScratch& body = scratch.bodies[side.index];
      s.root_inertia[mover] =
          body.rocks ? body.rocking.root_W : rootOfInertia(model.bodies[side.index].rotation, body.X_WI_mid.q);
    }
  }
  return s.number[mover];
}

// True if neither side moves faster than what counts as rest of many contacts.
bool isCalm(const WorldModel& model, const Contact& c) {
  const double limit = 2 * restErrorOf(model.options.solver), limit2 = limit * limit;
  const auto is_slow = [&](const Motion& m, const Vec3& arm_W) {
    return m.v_W.squaredNorm() <= limit2 && m.w_W.squaredNorm() * arm_W.squaredNorm() <= limit2;
  };
  return is_slow(c.mover_a->start, c.arm_a_W) && is_slow(c.mover_b->start, c.arm_b_W);
}

// True if they are those of the last solve, and the contact is the one of the last attempt (unchanged_pairs.h). Notes
// that they are filled.
bool areFilled(const Contact& c, int number_a, int number_b, std::int64_t solve, FilledSides& filled) {
  const bool are_filled = c.same_as >= 0 && filled.id == c.id && filled.solve == solve - 1 &&
                          filled.number_a == number_a && filled.number_b == number_b;
  filled = {c.id, solve, number_a, number_b};
  return are_filled;
}

// Of a link that two blocks move, against what doesn't move: the inboard one takes the place of that.
void fillInboardSide(const WorldModel& model, WorldScratch& scratch, int i, Island& island, IslandScratch& s,
                     ContactSides& sides) {
  const Contact& c = scratch.contacts[i];
  const int rows = scratch.first_row[i + 1] - scratch.first_row[i];
  const ContactEnds ends = s.ends[i];
  for (const bool is_a : {true, false}) {
    const int mover = parentOf(s, is_a ? ends.a : ends.b);
    if (mover < 0) continue;
    PINCER_ASSERT((is_a ? ends.b : ends.a) < 0);
    const int number = numberOf(model, scratch, is_a ? c.a : c.b, mover, island, s);
    fillSide(model, scratch, c, rows, is_a, mover, number, s.root_inertia, sides[is_a ? 1 : 0]);
  }
}

}  // namespace

void fillManySides(const WorldModel& model, WorldScratch& scratch, Island& island, IslandScratch& s) {
  const int *const order = s.order.data() + island.place, *const from_row = scratch.first_row.data();
  ContactSide* const all = s.many_sides.data() + s.sides_per_contact * island.work;
  int* const first_side = s.first_side.data() + 2 * island.work;
  int sides = 0;
  for (int n = 0; n < island.contacts; ++n) {
    const int i = order[n], rows = from_row[i + 1] - from_row[i];
    const Contact& c = scratch.contacts[i];
    first_side[n] = sides;
    for (const bool is_a : {true, false}) {
      const Side& side = is_a ? c.a : c.b;
      forEachOf(s, is_a ? s.ends[i].a : s.ends[i].b, [&](int mover) {
        ContactSide& out = all[sides];
        fillSide(model, scratch, c, rows, is_a, mover, numberOf(model, scratch, side, mover, island, s), s.root_inertia,
                 out);
        for (int other = first_side[n]; other < sides; ++other) {
          if (all[other].mover == out.mover) return addSide(rows, out, all[other]);
        }
        ++sides;
      });
    }
    island.settling = std::max(island.settling, c.settling);
    island.calm = island.calm && island.contacts > kDenseContacts && isCalm(model, c);
  }
  first_side[island.contacts] = sides;
  for (int n = 0; n < island.contacts; ++n) {
    const int i = order[n];
    s.weight[static_cast<std::size_t>(island.work + n)] =
        weightOf({all + first_side[n], all + first_side[n + 1]}, from_row[i + 1] - from_row[i]);
  }
}

bool hasManySides(const IslandScratch& s, const Island& island) {
  if (s.sides_per_contact == 2) return false;
  const int* const order = s.order.data() + island.place;
  return std::any_of(order, order + island.contacts, [&](int i) {
    int count = 0;
    for (const int end : {s.ends[i].a, s.ends[i].b}) forEachOf(s, end, [&](int) { ++count; });
    return count > 2;
  });
}

void fillSides(const WorldModel& model, WorldScratch& scratch, Island& island, IslandScratch& s) {
  const int *const order = s.order.data() + island.place, *const from_row = scratch.first_row.data();
  const Contact* const contacts = scratch.contacts.data();
  const ContactEnds* const all_ends = s.ends.data();
  ContactSides* const all_sides = s.sides.data() + island.work;
  FilledSides* const all_filled = s.filled.data() + island.work;
  double* const all_weights = s.weight.data() + island.work;
  for (int n = 0; n < island.contacts; ++n) {
    const int i = order[n], rows = from_row[i + 1] - from_row[i];
    const Contact& c = contacts[i];
    const ContactEnds ends = all_ends[i];
    ContactSides& sides = all_sides[n];
    const int a = numberOf(model, scratch, c.a, ends.a, island, s),
              b = numberOf(model, scratch, c.b, ends.b, island, s);
    if (!areFilled(c, a, b, s.solves, all_filled[n])) {
      fillSide(model, scratch, c, rows, true, ends.a, a, s.root_inertia, sides[0]);
      fillSide(model, scratch, c, rows, false, ends.b, b, s.root_inertia, sides[1]);
      if (ends.a >= 0 && ends.a == ends.b) joinSides(rows, sides);
      if (s.sides_per_contact > 2) fillInboardSide(model, scratch, i, island, s, sides);
      all_weights[n] = weightOf(sides, rows);
    }
    island.settling = std::max(island.settling, c.settling);
    island.calm = island.calm && island.contacts > kDenseContacts && isCalm(model, c);
  }
}

// As fillSides names them.
void numberMovers(const WorldModel& model, WorldScratch& scratch, Island& island, IslandScratch& s) {
  PINCER_ASSERT(s.sides_per_contact == 2 && island.contacts <= kFewContacts);
  ContactEnds before{-1, -1};
  for (int n = 0; n < island.contacts; ++n) {
    const int i = s.order[static_cast<std::size_t>(island.place + n)];
    const Contact& c = scratch.contacts[static_cast<std::size_t>(i)];
    const ContactEnds ends = s.ends[static_cast<std::size_t>(i)];
    if (n == 0 || ends.a != before.a || ends.b != before.b) {
      numberOf(model, scratch, c.a, ends.a, island, s);
      numberOf(model, scratch, c.b, ends.b, island, s);
    }
    before = ends;
    island.settling = std::max(island.settling, c.settling);
  }
  island.calm = false;
}

}  // namespace pincer::engine
