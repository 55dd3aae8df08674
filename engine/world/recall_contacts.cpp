#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/contact_rows.h"

namespace pincer::engine {
namespace {

Vec3 centre(const WorldScratch& scratch, const Side& side) {
  return side.kind == SideKind::kBody ? scratch.bodies[side.index].X_WI_mid.p : scratch.points[side.index].p_mid_W;
}

// 1 / sqrt(x); by its series where x is nearly 1, to round-off and in half the time.
double inverseRoot(double x) {
  const double e = 1 - x;
  if (std::abs(e) > 1e-4) return 1 / std::sqrt(x);
  return (1 + 0.5 * e) + e * e * (0.375 + e * 0.3125);
}

// Keeps the first tangent as close as possible to the one remembered, so that the warm start keeps its meaning. R holds the normal already.
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
  if (memory)
    carryFrame(*memory, c.R_WC);
  else
    c.R_WC = frameFromNormal(c.n_W());
  PINCER_ASSERT(isRotationIfFinite(c.R_WC));
  c.stuck = memory && memory->anchored;
  withRows(rowsOf(c.material), [&](auto rows) {
    relativeVelocity(c, c.mover_a->start, c.mover_b->start, rows, c.v_start_C.data());
    for (int k = 0; k < rows; ++k) c.offset_C[k] = c.stuck ? memory->offset_C[k] : 0;
  });
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

bool isOfPair(std::uint64_t id, std::uint64_t pair) { return id >> 32 == pair; }

// The memory of where the contact lies, of those of its pair that no contact has by identity.
const ContactMemory* findByPlace(std::span<const ContactMemory> pair, std::uint64_t taken, const Contact& c) {
  constexpr double kSamePlace = 5e-3, kSameNormal = 0.99;  // of the arm; the cosine
  const ContactMemory* nearest = nullptr;
  double least = kSamePlace * kSamePlace * std::min(c.arm_a_W.squaredNorm(), c.arm_b_W.squaredNorm());
  for (std::size_t k = 0; k < std::min<std::size_t>(pair.size(), 64); ++k) {
    if (taken >> k & 1 || pair[k].n_W.dot(c.n_W()) < kSameNormal) continue;
    const double distance = (pair[k].arm_a_W - c.arm_a_W).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = &pair[k];
  }
  return nearest;
}

// Of contacts and memories of one pair of bodies.
void recallPair(std::span<const ContactMemory> memories, std::span<Contact> contacts) {
  std::uint64_t taken = 0;
  std::size_t next = 0;
  int missing = 0;
  for (Contact& c : contacts) {
    while (next < memories.size() && memories[next].id < c.id) ++next;
    const bool found = next < memories.size() && memories[next].id == c.id;
    c.memory = found ? &memories[next] : nullptr;
    missing += !found;
    if (found && next < 64) taken |= std::uint64_t{1} << next;
  }
  if (missing == 0 || memories.empty() || contacts.front().a.kind == SideKind::kPoint) return;
  for (Contact& c : contacts) {
    if (c.memory) continue;
    c.memory = findByPlace(memories, taken, c);
    if (c.memory) taken |= std::uint64_t{1} << (c.memory - memories.data());
  }
}

}  // namespace

void recallContacts(std::span<const ContactMemory> memories, WorldScratch& scratch) {
  const std::span<Contact> contacts = scratch.contacts;
  for (std::size_t first = 0; first < contacts.size();) {
    const std::uint64_t pair = contacts[first].id >> 32;
    std::size_t end = first;
    for (; end < contacts.size() && isOfPair(contacts[end].id, pair); ++end) place(scratch, contacts[end]);
    while (!memories.empty() && memories.front().id >> 32 < pair) memories = memories.subspan(1);
    std::size_t known = 0;
    while (known < memories.size() && isOfPair(memories[known].id, pair)) ++known;
    recallPair(memories.first(known), contacts.subspan(first, end - first));
    memories = memories.subspan(known);
    for (; first < end; ++first) recall(contacts[first]);
  }
}

}  // namespace pincer::engine
