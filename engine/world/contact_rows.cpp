#include "pincer/engine/world/contact_rows.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/friction_shares.h"
#include "pincer/engine/world/hollow_inertia.h"
#include "pincer/engine/world/impact.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/push_out.h"
#include "pincer/engine/world/rocking.h"
#include "pincer/engine/world/stick_bias.h"
#include "pincer/engine/world/unchanged_pairs.h"
#include "pincer/engine/world/wedge.h"

namespace pincer::engine {
namespace {

constexpr double kMostLonger = 10;  // beyond, the last part's impulses were those of a hit rather than of weights

// Data that all contacts of this part of a tick share.
struct Rates {
  double tangent, normal;  // share of what is missing that is made good, over the tick [1/s]
  double turn;             // how much of the turn since the middle of the last part of a tick is to come
  double longer;           // than the last part: impulses grow with it

  Rates(const WorldModel& model, const WorldState& state, double h)
      : tangent(h > 0 ? kTangentCorrection / model.options.h : 0),
        normal(kNormalCorrection / model.options.h),
        turn(h == state.h_last ? 0.5 : h / (h + state.h_last)),
        longer(h == state.h_last ? 1 : std::min(h / state.h_last, kMostLonger)) {}
};

// How much of a place's way round its body since the last part of a tick goes on: nothing of half the arm. A rim that
// tips from one side to the other and is foretold to go on is pushed back, in every tick.
double shareOfWander(const Vec3& arm_W, const Vec3& last_arm_W) {
  constexpr double kFar2 = 0.25;  // of the arm, squared; from half of that on, less and less of it
  const double way2 = (arm_W - last_arm_W).squaredNorm(), far2 = kFar2 * arm_W.squaredNorm();
  return way2 < far2 ? std::min(2 - 2 * way2 / far2, 1.0) : 0;
}

// The turn of the normal and of the arms from now to the end, from their motion since the middle of the last part
// of a tick: n_end . v_end - n_mid . v_mid.
double turnOfNormal(const Rates& rates, const Contact& c, const ContactMemory& memory) {
  const auto n_W = c.R_WC.col(2);
  double turn = 0;
  for (int i = 0; i < 3; ++i) {
    const double v_i = c.R_WC(i, 0) * c.v_start_C[0] + c.R_WC(i, 1) * c.v_start_C[1] + c.R_WC(i, 2) * c.v_start_C[2];
    turn += (n_W[i] - memory.n_W[i]) * v_i;
  }
  const auto turnOfArm = [&](const Motion& start, const Vec3& arm_W, const Vec3& last_arm_W) {
    if (!turns(start)) return 0.0;
    return shareOfWander(arm_W, last_arm_W) * n_W.dot(start.w_W.cross(arm_W - last_arm_W));
  };
  turn += turnOfArm(c.mover_a->start, c.arm_a_W, memory.arm_a_W);
  turn -= turnOfArm(c.mover_b->start, c.arm_b_W, memory.arm_b_W);
  return rates.turn * turn;
}

// Newton's law of impact; what touches without hitting is only kept from closing.
double impactBias(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  const double u_n = c.v_start_C[kNormalRow];
  return scratch.bounce *
         bounceRestitution(c.material.restitution, u_n, gapAcceleration(model, scratch, c), model.options.h) * u_n;
}

// True if a contact that landed in the last tick now only rolls on, round a rim or along an edge:
// all its normal velocity comes from the turn of its arms, which it meets from the middle of the
// landing to that of this tick, twice `turn`.
bool rollsOn(double u_n, double turn) {
  constexpr double kAlike = 0.2;  // of the turn: it changes from tick to tick
  return std::abs(turn) > kClosingSpeed && std::abs(u_n - 2 * turn) < kAlike * std::abs(turn);
}

// True if a link keeps nothing of the speed that it landed with: what its normal velocity has beyond the turn doesn't
// close. One that slides is pushed out, and would land in tick after tick, all its way by the rates at their ends.
bool hasStopped(const WorldModel& model, const Contact& c, double u_n, double turn) {
  const auto is_link = [&](const Side& side) {
    return side.kind == SideKind::kBody && model.bodies[side.index].tree >= 0;
  };
  return (is_link(c.a) || is_link(c.b)) && u_n - 2 * turn > -kClosingSpeed;
}

double largestCorrection(const WorldModel& model, const Contact& c) {
  return isPushedOut(model, c) ? kDeepSpeed : kLargestCorrection;
}

double normalBias(const WorldModel& model, const Rates& rates, const WorldScratch& scratch, Contact& c) {
  if (scratch.h == 0) return impactBias(model, scratch, c);
  const ContactMemory* const memory = c.memory;
  const double u_n = c.v_start_C[kNormalRow], kept = c.offset_C[kNormalRow];
  if (memory && memory->active) {
    const double turn = turnOfNormal(rates, c, *memory);
    // A contact that landed in the last tick still has the speed that it landed with: it is stopped like a new contact.
    if (!memory->closing || rollsOn(u_n, turn) || hasStopped(model, c, u_n, turn))
      return std::max(rates.normal * (c.phi - kept), -largestCorrection(model, c)) + turn;
  }
  const double phi_start = c.phi - 0.5 * scratch.h * u_n;
  c.closing = std::abs(u_n) > kClosingSpeed;  // also what hops and comes down within the tick
  const double lands =
      phi_start > 0 ? phi_start / scratch.h : std::max(rates.normal * (phi_start - kept), -largestCorrection(model, c));
  // A contact that has just left turns away as it did while it touched.
  if (memory && !memory->active)
    return std::max(
        lands, std::max(rates.normal * (c.phi - kept), -largestCorrection(model, c)) + turnOfNormal(rates, c, *memory));
  return lands;
}

// How much of the slip at the start counts besides that at the end: all of it, and friction points against their mean,
// second order; none where friction may end or turn the slip within some ticks, or what crawls in a heap would chatter.
double slidingShare(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  constexpr double kFastSlip = 48;  // times what the contact's friction takes from the slip of a point mass in a tick
  const ContactMemory* const memory = c.memory;
  if (!memory || !memory->active || !memory->sliding || scratch.h == 0 || c.a.kind != SideKind::kBody) return 0;
  const double inverse_mass = model.bodies[c.a.index].inverse_mass + model.bodies[c.b.index].inverse_mass;
  const double taken = kFastSlip * inverse_mass * c.mu * memory->r[kNormalRow];
  const double slip = std::sqrt(c.v_start_C[0] * c.v_start_C[0] + c.v_start_C[1] * c.v_start_C[1]);
  return slip < 2 * taken ? std::max(slip / taken - 1, 0.0) : 1;
}

void fillContact(const WorldModel& model, const Rates& rates, WorldScratch& scratch, int i) {
  Contact& c = scratch.contacts[i];
  const int first = scratch.first_row[i], count = scratch.first_row[i + 1] - first;
  c.closing = false;
  const double normal_bias = normalBias(model, rates, scratch, c);
  double *const q_i = scratch.q.data() + first, *const r_i = scratch.r.data() + first;
  c.bias_C.setZero();
  const double slide = slidingShare(model, scratch, c);
  withRows(count, [&](auto rows) {
    double v_free_C[kMaxContactRows];
    relativeVelocity(c, c.mover_a->free, c.mover_b->free, rows, v_free_C);
    for (int k = 0; k < rows; ++k) {
      const double tangent_bias =
          c.stuck ? rates.tangent * (c.offset_C[k] + 0.5 * scratch.h * c.v_start_C[k]) : slide * c.v_start_C[k];
      const double bias = c.bias_C[k] = k == kNormalRow ? normal_bias : tangent_bias;
      q_i[k] = (k >= kTorsionRow ? radiusOf(c, k) : 1) * (v_free_C[k] + bias);
      r_i[k] = c.r[k] *= rates.longer;
    }
  });
  if (c.a.kind == SideKind::kJoint) {
    const JointRowScratch& row = scratch.joint_rows[static_cast<std::size_t>(c.a.index)];
    if (row.isBrake()) {  // the impulse that holds it closed is given
      q_i[kNormalRow] = -row.grip * row.limit;
      r_i[kNormalRow] = row.limit;
    }
  }
  PINCER_ASSERT(!(c.mu < 0));
  scratch.mu[i] = c.mu;
}

// A few contacts from `first` on, all of each two, are recalled and filled while they are in the cache: of a thousand
// grasps all together aren't.
int endOfBatch(std::span<const Contact> contacts, int first) {
  constexpr int kBatch = 16;
  const int n = static_cast<int>(contacts.size());
  int end = std::min(first + kBatch, n);
  while (end < n && isOfSameTwo(contacts[end - 1], contacts[end])) ++end;
  return end;
}

}  // namespace

void fillContacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  const int n = static_cast<int>(scratch.contacts.size());
  const Rates rates(model, state, scratch.h);
  std::span<const ContactMemory> memories(state.contacts.data(), static_cast<std::size_t>(state.contact_count));
  PINCER_ASSERT(isAscending(scratch.contacts, &Contact::id));
  PINCER_ASSERT(isAscending(memories, &ContactMemory::id));
  PINCER_ASSERT(scratch.contacts.size() <= scratch.mu.size());
  scratch.first_row[0] = 0;
  for (int first = 0, end = 0; first < n; first = end) {
    end = model.has_hollows ? n : endOfBatch(scratch.contacts, first);
    memories = recallContacts(memories, std::span(scratch.contacts).subspan(first, end - first), scratch);
    if (model.has_hollows) {
      steadyInHollows(model, state, scratch);
      steadyRocking(model, state, scratch);
      loosenWedges(scratch);
    }
    for (int i = first; i < end; ++i) {
      scratch.first_row[i + 1] = scratch.first_row[i] + rowsOf(scratch.contacts[i].material);
      scratch.contacts[i].same_as >= 0 ? keepRows(rates.longer, scratch, i) : fillContact(model, rates, scratch, i);
    }
  }
  if (scratch.h > 0) {
    alignStickBiases(model, scratch.h, rates.tangent, scratch);
    shareFriction(scratch);
  }
  noteMemories(state, scratch);
}

}  // namespace pincer::engine
