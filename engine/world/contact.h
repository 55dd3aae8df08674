// contact: one contact of this tick, from finding it to remembering it, and the velocity of the two that touch.
#pragma once
#include <cstdint>

#include "pincer/engine/model.h"
#include "pincer/engine/motion.h"
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/state.h"

namespace pincer::engine {

enum class SideKind : std::uint8_t { kBody, kPoint, kJoint };  // kJoint: a row of WorldScratch::joint_rows

struct MoverScratch;

// One of the two that touch.
struct Side {
  SideKind kind = SideKind::kBody;
  std::uint16_t shape = 0;  // of a body: which of its shapes
  int index = 0;
};
inline Side sideOf(const WorldModel& model, const ColliderModel& collider) {
  const auto shape =
      static_cast<std::uint16_t>(&collider - model.colliders.data() - model.bodies[collider.body].first_collider);
  return {SideKind::kBody, shape, collider.body};
}
// whichever shape of it
inline bool isSame(const Side& x, const Side& y) { return x.kind == y.kind && x.index == y.index; }

// A contact of this tick: n_W points out of b towards a. All geometry is that of the predicted middle of the
// tick. Each group of fields has one that fills it, in this order; until then they are without a value. Rows of
// vectors that the contact doesn't have stay so.
struct Contact {
  // Found, by whoever adds it (addContact).
  std::uint64_t id = 0;
  Side a, b;
  Vec3 p_W;        // where they touch [m]
  Mat3 R_WC;       // columns (t1, t2, n); t1 and t2 are recalled
  double phi = 0;  // gap [m]
  Material material;
  // Recalled (recall_contacts.cpp): of the last tick, and how the two move.
  const ContactMemory* memory;            // null for a new contact; until this one is remembered
  const MoverScratch *mover_a, *mover_b;  // of a and b
  double mu;                              // in force in this tick
  Vec3 arm_a_W, arm_b_W;
  int open_ticks;           // before this tick, see ContactMemory
  ContactVector v_start_C;  // of a relative to b at the start of the tick, see relativeVelocity
  ContactVector offset_C;   // anchored stick, at the start of the tick; see ContactMemory
  ContactVector r;          // impulse on a in C [N s]: the last tick's, by the length of this part of it; then solved
  // Asked for (contact_rows.cpp), `stuck` and the first `settling` recalled.
  bool far = false;      // it can't close within this part of the tick, and isn't solved (far_contacts.h)
  bool closing = false;  // it closes in this tick, from a positive gap or with an approaching velocity
  bool stuck = false;    // it stuck in the last tick: its tangential biases undo the offset
  ContactVector bias_C;  // part of q that isn't velocity [m/s], from torsion on [rad/s]
  // Solved (islands.cpp, solve_contacts.cpp).
  Vec3 impulse_W;  // impulse on a at p_W [N s]; b got exactly its negative
  Vec3 u_C;        // velocity of a relative to b at the end of the tick, biases included [m/s]
  bool sliding = false;
  int settling = 0;  // see ContactMemory; of the last tick before the solve, of this one after it
  // the last tick's impulses still fit: what moves slower is at rest (rest.h) [m/s]; 0: they don't
  double rest_speed = 0;
  bool yields = false;  // walls close on what is between them (solve/squeeze.h)
  // Remembered (remember_contacts.cpp).
  bool still = false;  // nothing of it or of its bodies changed in this tick, where that was asked
  // Kept (unchanged_pairs.h).
  int same_as = -1;      // the one of the last attempt that it is up to the solve; -1: it was found
  bool as_asked = true;  // the solve left what it is asked for as it was

  Contact() {}  // NOLINT(modernize-use-equals-default): a defaulted one would clear all of a new contact
  Vec3 n_W() const { return R_WC.col(2); }
  bool active() const { return r[2] > 0; }
};

// Row k >= kTorsionRow turns about this axis; the radius makes it a velocity.
inline Vec3 axisOf(const Contact& c, int k) { return k == kTorsionRow ? c.R_WC.col(2) : c.R_WC.col(k - kRollingRow); }
inline double radiusOf(const Contact& c, int k) {
  return k == kTorsionRow ? c.material.torsion_radius : c.material.rolling_radius;
}

inline bool turns(const Motion& m) { return m.w_W.squaredNorm() != 0; }

// Adds w x arm.
[[gnu::always_inline]] inline void addTurn(const Vec3& w_W, const Vec3& arm_W, double sign, double (&v_W)[3]) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    v_W[i] += sign * (w_W[j] * arm_W[k] - w_W[k] * arm_W[j]);
  }
}

// Velocity of a relative to b where they touch, in C: along t1, t2, n [m/s]; of rows that
// the contact has, about n, t1, t2 [rad/s].
//   rows  of the contact, from withRows
// In line and number by number, here and where it is used: vectors that go through memory are
// read whole before their halves are there.
template <class Rows>
[[gnu::always_inline]] inline void relativeVelocity(const Contact& c, const Motion& a, const Motion& b, Rows rows,
                                                    double* v) {
  double v_W[3];
  for (int i = 0; i < 3; ++i) v_W[i] = a.v_W[i] - b.v_W[i];
  if (turns(a)) addTurn(a.w_W, c.arm_a_W, 1, v_W);
  if (turns(b)) addTurn(b.w_W, c.arm_b_W, -1, v_W);
  for (int k = 0; k < 3; ++k) v[k] = c.R_WC(0, k) * v_W[0] + c.R_WC(1, k) * v_W[1] + c.R_WC(2, k) * v_W[2];
  for (int k = kTorsionRow; k < rows; ++k) v[k] = axisOf(c, k).dot(a.w_W - b.w_W);
}

inline bool isOfSameTwo(const Contact& x, const Contact& y) { return isSame(x.a, y.a) && isSame(x.b, y.b); }

// Identity of a contact from tick to tick; contacts are sorted by it. From the highest bit on:
//   2 bits kind   0: body a on body b;  1: point a on body b;  2: a stop or brake of a joint
//   30 bits who   bodies a and b with 15 - s bits each, a's shape and b's with s each; or the point
//                 with 15, b with 15 - s, its shape with s
//   32 bits feature
//   shape_bits  s of the model: 0 where each body has one shape
std::uint64_t contactId(int shape_bits, const Side& a, const Side& b, std::uint32_t feature);

// Whose contact an identity is of: bodies a and b, a point's with b alone, or a joint's row. -1: none.
struct ContactOwners {
  int a = -1, b = -1, row = -1;
};
ContactOwners ownersOf(int shape_bits, std::uint64_t id);

// Two identities of the same two bodies, or of the same point and body,
// whichever shapes touch. Those follow each other.
inline bool isOfSameTwo(int shape_bits, std::uint64_t x, std::uint64_t y) {
  const int shapes = x >> 62 ? shape_bits : 2 * shape_bits;
  return x >> (32 + shapes) == y >> (32 + shapes);
}

}  // namespace pincer::engine
