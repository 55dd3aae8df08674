#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/contact_rows.h"

namespace pincer::engine {
namespace {

Vec3 centre(const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kJoint) return Vec3::Zero();
  return side.kind == SideKind::kBody ? scratch.bodies[side.index].X_WI_mid.p : scratch.points[side.index].p_mid_W;
}

// 1 / sqrt(x); by its series where x is nearly 1, to round-off and in half the time.
double inverseRoot(double x) {
  const double e = 1 - x;
  if (std::abs(e) > 1e-4) return 1 / std::sqrt(x);
  return (1 + 0.5 * e) + e * e * (0.375 + e * 0.3125);
}

// Keeps the first tangent as close as possible to the one remembered, so that the warm start keeps
// its meaning. R holds the normal already.
void carryFrame(const ContactMemory& memory, Mat3& R) {
  const Vec3 n_W = R.col(2);
  Vec3 t1_W = memory.t1_W;
  if (n_W != memory.n_W) {
    t1_W -= n_W * n_W.dot(t1_W);
    const double length2 = t1_W.squaredNorm();
    if (length2 < 0.01) {
      R = frameFromNormal(n_W);
      return;
    }
    t1_W *= inverseRoot(length2);
  }
  R.col(0) = t1_W;
  R.col(1) = n_W.cross(t1_W);
}

void place(const WorldScratch& scratch, Contact& c) {
  c.arm_a_W = c.p_W - centre(scratch, c.a);
  c.arm_b_W = c.p_W - centre(scratch, c.b);
  c.mover_a = &mover(scratch, c.a);
  c.mover_b = &mover(scratch, c.b);
}

void recall(Contact& c) {
  const ContactMemory* const memory = c.memory;
  PINCER_ASSERT(isUnitIfFinite(c.n_W()));
  if (c.a.kind == SideKind::kJoint)
    c.R_WC.setIdentity();  // its rows are what they are
  else if (memory)
    carryFrame(*memory, c.R_WC);
  else
    c.R_WC = frameFromNormal(c.n_W());
  PINCER_ASSERT(isRotationIfFinite(c.R_WC));
  c.stuck = memory && memory->anchored;
  withRows(rowsOf(c.material), [&](auto rows) {
    relativeVelocity(c, c.mover_a->start, c.mover_b->start, rows, c.v_start_C.data());
    for (int k = 0; k < rows; ++k) c.offset_C[k] = c.stuck ? memory->offset_C[k] : 0;
    const double overlap = memory ? memory->offset_C[kNormalRow] : 0;
    c.offset_C[kNormalRow] = overlap < 0 ? std::clamp(c.phi, overlap, 0.0) : 0;
  });
  if (memory)
    c.r = memory->r;
  else
    c.r.setZero();
  c.mu = memory && memory->sliding ? slidingFriction(c.material, c.v_start_C.head<2>().norm()) : c.material.mu_s;
  c.open_ticks = memory ? memory->open_ticks : 0;
  c.settling = memory ? memory->settling : 0;
}

}  // namespace

void sortContacts(WorldScratch& scratch) {
  const auto by_id = [](const Contact& x, const Contact& y) { return x.id < y.id; };
  if (!std::is_sorted(scratch.contacts.begin(), scratch.contacts.end(), by_id)) {  // nearly always they come sorted
    std::sort(scratch.contacts.begin(), scratch.contacts.end(), by_id);
  }
}

namespace {

constexpr double kSameNormal = 0.99;       // the cosine
constexpr std::size_t kMostMemories = 64;  // of a pair, bits of those taken; the rest isn't found by place

std::uint64_t pairOf(std::uint64_t id) { return id >> 32; }

// Contacts and memories come sorted by id: each finds its own on the way, and `memories` loses those of the contacts'
// pairs. Returns how many contacts of two bodies found none, and how many impulses no contact.
int recallByIdentity(const WorldScratch& scratch, std::span<Contact> contacts,
                     std::span<const ContactMemory>& memories) {
  int missing = 0;
  const ContactMemory *m = memories.data(), *const end = m + memories.size();
  const auto pass = [&] { missing += m++->active; };
  for (Contact& c : contacts) {
    while (m != end && m->id < c.id) pass();
    const bool found = m != end && m->id == c.id;
    if (c.same_as < 0) {
      place(scratch, c);
      c.memory = found ? m : nullptr;
      missing += !found && c.a.kind == SideKind::kBody;
      recall(c);
    }
    m += found;
  }
  while (m != end && pairOf(m->id) == pairOf(contacts.back().id)) pass();
  memories = {m, end};
  return missing;
}

// The nearest of a pair's memories that no contact has taken, where they push from the same place.
const ContactMemory* findByPlace(std::span<const ContactMemory> pair, std::uint64_t taken, const Contact& c) {
  constexpr double kSamePlace = 5e-3;  // of the arm
  const ContactMemory* nearest = nullptr;
  double least = kSamePlace * kSamePlace * std::min(c.arm_a_W.squaredNorm(), c.arm_b_W.squaredNorm());
  for (std::size_t k = 0; k < std::min(pair.size(), kMostMemories); ++k) {
    if (taken >> k & 1 || pair[k].n_W.dot(c.n_W()) < kSameNormal) continue;
    const double distance = (pair[k].arm_a_W - c.arm_a_W).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = &pair[k];
  }
  return nearest;
}

// The impulse of what has no contact any more goes to the nearest one that pushes alike: where the crossing of two
// edges runs over the end of one, two contacts become one, and it carries all of what they did.
void passOn(const ContactMemory& memory, std::span<Contact> contacts) {
  Contact* nearest = nullptr;
  double least = kInfinity;
  for (Contact& c : contacts) {
    const double distance = (memory.arm_a_W - c.arm_a_W).squaredNorm();
    if (memory.n_W.dot(c.n_W()) < kSameNormal || !(distance < least)) continue;
    least = distance;
    nearest = &c;
  }
  if (!nearest) return;
  const Vec3 t2_W = memory.n_W.cross(memory.t1_W);
  const Vec3 r_W = memory.r[0] * memory.t1_W + memory.r[1] * t2_W + memory.r[kNormalRow] * memory.n_W;
  nearest->r.head<3>() += nearest->R_WC.transpose() * r_W;
}

void recallPairByPlace(std::span<const ContactMemory> memories, std::span<Contact> contacts) {
  std::uint64_t taken = 0;
  const auto take = [&](const ContactMemory* memory) {
    if (memory && memory < memories.data() + kMostMemories) taken |= std::uint64_t{1} << (memory - memories.data());
  };
  for (const Contact& c : contacts) take(c.memory);
  for (Contact& c : contacts) {
    if (c.memory) continue;
    c.memory = findByPlace(memories, taken, c);
    take(c.memory);
    if (c.memory) recall(c);
  }
  for (std::size_t k = 0; k < std::min(memories.size(), kMostMemories); ++k) {
    if (!(taken >> k & 1) && memories[k].active) passOn(memories[k], contacts);
  }
}

// The run of items of one pair that `items` begin with.
template <class Item>
std::span<Item> firstPair(std::span<Item> items) {
  std::size_t n = 1;
  while (n < items.size() && pairOf(items[n].id) == pairOf(items[0].id)) ++n;
  return items.first(n);
}

// Of two bodies, what lost its identity may be where something was.
void recallByPlace(std::span<const ContactMemory> memories, std::span<Contact> contacts) {
  while (!contacts.empty() && !memories.empty()) {
    const std::span<Contact> pair = firstPair(contacts);
    const std::span<const ContactMemory> known = firstPair(memories);
    if (pairOf(known[0].id) < pairOf(pair[0].id)) {
      memories = memories.subspan(known.size());
      continue;
    }
    if (pairOf(known[0].id) == pairOf(pair[0].id) && pair[0].a.kind == SideKind::kBody) recallPairByPlace(known, pair);
    contacts = contacts.subspan(pair.size());
  }
}

}  // namespace

std::span<const ContactMemory> recallContacts(std::span<const ContactMemory> memories, std::span<Contact> contacts,
                                              const WorldScratch& scratch) {
  std::span<const ContactMemory> left = memories;
  if (recallByIdentity(scratch, contacts, left) == 0) return left;
  recallByPlace(memories, contacts);
  return left;
}

}  // namespace pincer::engine
