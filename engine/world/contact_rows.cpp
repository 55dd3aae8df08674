#include "engine/world/contact_rows.h"

#include <algorithm>

#include "engine/world/impact.h"
#include "engine/world/push_out.h"
#include "engine/world/stick_bias.h"

namespace pincer::engine {
namespace {

// The turn of the normal and of the arms from now to the end, from their motion since the middle of the last part of a tick: n_end . v_end - n_mid . v_mid.
double turnOfNormal(const WorldScratch& scratch, double h_last, const Contact& c, const ContactMemory& memory) {
  const Vec3 n_W = c.n_W();
  const Vec3 v_rel_W = c.R_WC * c.v_start_C.head<3>();
  double turn = (n_W - memory.n_W).dot(v_rel_W);
  if (turns(c.mover_a->start)) turn += n_W.dot(c.mover_a->start.w_W.cross(c.arm_a_W - memory.arm_a_W));
  if (turns(c.mover_b->start)) turn -= n_W.dot(c.mover_b->start.w_W.cross(c.arm_b_W - memory.arm_b_W));
  return scratch.h / (scratch.h + h_last) * turn;
}

// Newton's law of impact; what touches without hitting is only kept from closing.
double impactBias(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  const double u_n = c.v_start_C[kNormalRow];
  return scratch.bounce * bounceRestitution(c.material.restitution, u_n, gapAcceleration(model, c), model.options.h) * u_n;
}

// Whether a contact that landed in the last tick now only rolls on, round a rim or along an edge: all its normal velocity comes from the turn of
// its arms, which it meets from the middle of the landing to that of this tick, twice `turn`.
bool rollsOn(double u_n, double turn) {
  constexpr double kAlike = 0.2;  // of the turn: it changes from tick to tick
  return std::abs(turn) > kClosingSpeed && std::abs(u_n - 2 * turn) < kAlike * std::abs(turn);
}

double largestCorrection(const WorldModel& model, const Contact& c) { return isPushedOut(model, c) ? kDeepSpeed : kLargestCorrection; }

double normalBias(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, Contact& c) {
  if (scratch.h == 0) return impactBias(model, scratch, c);
  const double h = model.options.h;
  const ContactMemory* const memory = c.memory;
  const double u_n = c.v_start_C[kNormalRow];
  if (memory && memory->active) {
    const double turn = turnOfNormal(scratch, state.h_last, c, *memory);
    // What landed in the last tick still has the speed that it landed with: it is stopped like a new contact.
    if (!memory->closing || rollsOn(u_n, turn)) return std::max(kNormalCorrection * c.phi / h, -largestCorrection(model, c)) + turn;
  }
  const double phi_start = c.phi - 0.5 * scratch.h * u_n;
  c.closing = std::abs(u_n) > kClosingSpeed;  // also what hops and comes down within the tick
  if (phi_start > 0) return phi_start / scratch.h;
  return std::max(kNormalCorrection * phi_start / h, -largestCorrection(model, c));
}

void fillContact(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int i) {
  const double rate = scratch.h > 0 ? kTangentCorrection / model.options.h : 0;
  Contact& c = scratch.contacts[i];
  const int first = scratch.first_row[i], count = scratch.first_row[i + 1] - first;
  const ContactMemory* const memory = c.memory;
  ContactVector q = relativeVelocity(c, c.mover_a->free, c.mover_b->free);
  c.stuck = memory && memory->active && !memory->sliding;
  c.closing = false;
  c.bias_C.setZero();
  if (c.stuck) c.bias_C = rate * (c.offset_C + 0.5 * scratch.h * c.v_start_C);
  c.bias_C[kNormalRow] = normalBias(model, state, scratch, c);
  q += c.bias_C;
  for (int k = kTorsionRow; k < count; ++k) q[k] *= radiusOf(c, k);
  const double longer = memory ? scratch.h / state.h_last : 0;  // than the last part of a tick: impulses grow with it
  double *const q_i = scratch.q.data() + first, *const r_i = scratch.r.data() + first;
  withRows(count, [&](auto rows) {
    for (int k = 0; k < rows; ++k) {
      q_i[k] = q[k];
      r_i[k] = memory ? longer * memory->r[k] : 0;
    }
  });
  scratch.mu[i] = c.mu;
}

}  // namespace

void fillContacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  const int n = static_cast<int>(scratch.contacts.size());
  scratch.first_row[0] = 0;
  for (int i = 0; i < n; ++i) {
    scratch.first_row[i + 1] = scratch.first_row[i] + rowsOf(scratch.contacts[i].material);
    fillContact(model, state, scratch, i);
  }
  if (scratch.h > 0) alignStickBiases(scratch.h, kTangentCorrection / model.options.h, scratch);
}

}  // namespace pincer::engine
