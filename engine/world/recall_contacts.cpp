#include <algorithm>

#include "engine/world/contact_rows.h"

namespace pincer::engine {
namespace {

Vec3 centre(const WorldScratch& scratch, const Side& side) {
  return side.kind == SideKind::kBody ? scratch.bodies[side.index].X_WI_mid.p : scratch.points[side.index].p_mid_W;
}

// Keeps the first tangent as close as possible to the one remembered, so that the warm start keeps its meaning.
Mat3 carriedFrame(const Vec3& n_W, const Vec3& n_old_W, const Vec3& t1_old_W) {
  if (n_W == n_old_W) {
    Mat3 R;
    R << t1_old_W, n_W.cross(t1_old_W), n_W;
    return R;
  }
  const Vec3 t1 = t1_old_W - n_W * n_W.dot(t1_old_W);
  const double length = t1.norm();
  if (length < 0.1) return frameFromNormal(n_W);
  Mat3 R;
  R.col(0) = t1 / length;
  R.col(1) = n_W.cross(R.col(0));
  R.col(2) = n_W;
  return R;
}

void recall(const WorldState& state, WorldScratch& scratch, Contact& c) {
  const ContactMemory* memory = c.memory >= 0 ? &state.contacts[c.memory] : nullptr;
  const Vec3 n_W = c.R_WC.col(2);
  c.R_WC = memory ? carriedFrame(n_W, memory->n_W, memory->t1_W) : frameFromNormal(n_W);
  c.arm_a_W = c.p_W - centre(scratch, c.a);
  c.arm_b_W = c.p_W - centre(scratch, c.b);
  c.v_start_C = relativeVelocity(c, mover(scratch, c.a).start, mover(scratch, c.b).start);
  c.mu = memory && memory->sliding ? slidingFriction(c.material, c.v_start_C.head<2>().norm()) : c.material.mu_s;
  c.settling = memory ? memory->settling : 0;
  c.offset_C.setZero();
  if (memory && memory->active && !memory->sliding) c.offset_C = memory->offset_C;
}

}  // namespace

void recallContacts(const WorldState& state, WorldScratch& scratch) {
  const auto by_id = [](const Contact& x, const Contact& y) { return x.id < y.id; };
  if (!std::is_sorted(scratch.contacts.begin(), scratch.contacts.end(), by_id)) {  // nearly always they come sorted
    std::sort(scratch.contacts.begin(), scratch.contacts.end(), by_id);
  }
  int old = 0;
  for (Contact& c : scratch.contacts) {
    while (old < state.contact_count && state.contacts[old].id < c.id) ++old;
    c.memory = old < state.contact_count && state.contacts[old].id == c.id ? old : -1;
    recall(state, scratch, c);
  }
}

}  // namespace pincer::engine
