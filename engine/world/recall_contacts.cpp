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

void recall(const WorldScratch& scratch, Contact& c) {
  const ContactMemory* const memory = c.memory;
  PINCER_ASSERT(isUnitIfFinite(c.n_W()));
  if (memory)
    carryFrame(*memory, c.R_WC);
  else
    c.R_WC = frameFromNormal(c.n_W());
  PINCER_ASSERT(isRotationIfFinite(c.R_WC));
  c.arm_a_W = c.p_W - centre(scratch, c.a);
  c.arm_b_W = c.p_W - centre(scratch, c.b);
  c.mover_a = &mover(scratch, c.a);
  c.mover_b = &mover(scratch, c.b);
  c.stuck = memory && memory->active && !memory->sliding;
  withRows(rowsOf(c.material), [&](auto rows) {
    relativeVelocity(c, c.mover_a->start, c.mover_b->start, rows, c.v_start_C.data());
    for (int k = 0; k < rows; ++k) c.offset_C[k] = c.stuck ? memory->offset_C[k] : 0;
  });
  c.mu = memory && memory->sliding ? slidingFriction(c.material, c.v_start_C.head<2>().norm()) : c.material.mu_s;
  c.settling = memory ? memory->settling : 0;
}

}  // namespace

void sortContacts(WorldScratch& scratch) {
  const auto by_id = [](const Contact& x, const Contact& y) { return x.id < y.id; };
  if (!std::is_sorted(scratch.contacts.begin(), scratch.contacts.end(), by_id)) {  // nearly always they come sorted
    std::sort(scratch.contacts.begin(), scratch.contacts.end(), by_id);
  }
}

void recallContact(std::span<const ContactMemory>& memories, const WorldScratch& scratch, Contact& c) {
  while (!memories.empty() && memories.front().id < c.id) memories = memories.subspan(1);
  c.memory = !memories.empty() && memories.front().id == c.id ? &memories.front() : nullptr;
  recall(scratch, c);
}

}  // namespace pincer::engine
