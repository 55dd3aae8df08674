#include "engine/world/contact_rows.h"

#include <algorithm>

namespace pincer::engine {
namespace {

// Half a tick's turn of the normal and of the arms, from their motion since the last tick's middle: n_end . v_end - n_mid . v_mid.
double turnOfNormal(const WorldScratch& scratch, const Contact& c, const ContactMemory& memory) {
  const Vec3 n_W = c.n_W();
  const Vec3 v_rel_W = c.R_WC * c.v_start_C.head<3>();
  double turn = (n_W - memory.n_W).dot(v_rel_W);
  turn += n_W.dot(startMotion(scratch, c.a).w_W.cross(c.arm_a_W - memory.arm_a_W));
  turn -= n_W.dot(startMotion(scratch, c.b).w_W.cross(c.arm_b_W - memory.arm_b_W));
  return 0.5 * turn;
}

double normalBias(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, Contact& c) {
  const double h = model.options.h;
  const ContactMemory* memory = c.memory >= 0 ? &state.contacts[c.memory] : nullptr;
  // What landed in the last tick still has the speed that it landed with: it is stopped like a new contact.
  if (memory && memory->active && !memory->closing) {
    return std::max(kNormalCorrection * c.phi / h, -kLargestCorrection) + turnOfNormal(scratch, c, *memory);
  }
  const double u_n = c.v_start_C[kNormalRow];
  const double phi_start = c.phi - 0.5 * h * u_n;
  c.closing = u_n < -kClosingSpeed;
  // Slower than a few ticks of gravity is rest, not a bounce.
  const double bounce_speed = 1e-2 + 2 * h * model.options.gravity_W.norm();
  if (u_n < -bounce_speed && c.material.restitution > 0 && phi_start + h * u_n < 0) return c.material.restitution * u_n;
  return phi_start > 0 ? phi_start / h : std::max(kNormalCorrection * phi_start / h, -kLargestCorrection);
}

// Inverse mass and inertia times a row of one side.
void applyInverseMass(const WorldModel& model, const WorldScratch& scratch, const Side& side, const Vec3& lin, const Vec3& ang, Vec3& mlin,
                      Vec3& mang) {
  if (side.kind == SideKind::kPoint) {
    mlin = scratch.points[side.index].inverse_mass.cwiseProduct(lin);
    mang.setZero();
  } else if (model.bodies[side.index].dynamic) {
    mlin = model.bodies[side.index].inverse_mass * lin;
    mang = scratch.bodies[side.index].inverse_inertia_W * ang;
  } else {
    mlin.setZero();
    mang.setZero();
  }
}

void fillRow(const WorldModel& model, const WorldScratch& scratch, const Contact& c, int row_of_contact, ContactRow& row) {
  if (row_of_contact < 3) {
    row.lin = c.R_WC.col(row_of_contact);
    row.ang_a = c.arm_a_W.cross(row.lin);
    row.ang_b = c.arm_b_W.cross(row.lin);
  } else {
    row.lin.setZero();
    row.ang_a = row.ang_b = c.material.torsion_radius * c.n_W();
  }
  applyInverseMass(model, scratch, c.a, row.lin, row.ang_a, row.mlin_a, row.mang_a);
  applyInverseMass(model, scratch, c.b, row.lin, row.ang_b, row.mlin_b, row.mang_b);
}

bool same(const Side& x, const Side& y) { return x.kind == y.kind && x.index == y.index; }

// One block of W: rows of contact i against rows of contact j, through the sides that they share.
void fillBlock(const WorldScratch& scratch, int i, int j, MatrixMap& W) {
  const Contact &ci = scratch.contacts[i], &cj = scratch.contacts[j];
  const bool aa = same(ci.a, cj.a), ab = same(ci.a, cj.b), ba = same(ci.b, cj.a), bb = same(ci.b, cj.b);
  for (int k = scratch.first_row[i]; k < scratch.first_row[i + 1]; ++k) {
    const ContactRow& x = scratch.rows[k];
    for (int l = scratch.first_row[j]; l < scratch.first_row[j + 1]; ++l) {
      const ContactRow& y = scratch.rows[l];
      double w = 0;
      if (aa) w += x.lin.dot(y.mlin_a) + x.ang_a.dot(y.mang_a);
      if (ab) w -= x.lin.dot(y.mlin_b) + x.ang_a.dot(y.mang_b);
      if (ba) w -= x.lin.dot(y.mlin_a) + x.ang_b.dot(y.mang_a);
      if (bb) w += x.lin.dot(y.mlin_b) + x.ang_b.dot(y.mang_b);
      W(k, l) = W(l, k) = w;
    }
  }
}

void fillContact(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int i) {
  const double h = model.options.h;
  Contact& c = scratch.contacts[i];
  const int first = scratch.first_row[i], count = scratch.first_row[i + 1] - first;
  for (int k = 0; k < count; ++k) fillRow(model, scratch, c, k, scratch.rows[first + k]);

  const ContactMemory* memory = c.memory >= 0 ? &state.contacts[c.memory] : nullptr;
  Eigen::Vector4d q = relativeVelocity(c, freeMotion(scratch, c.a), freeMotion(scratch, c.b));
  if (memory && memory->active && !memory->sliding) {
    const Eigen::Vector4d offset_mid_C = c.offset_C + 0.5 * h * c.v_start_C;
    for (int k : {0, 1, 3}) q[k] += kTangentCorrection / h * offset_mid_C[k];
  }
  q[kNormalRow] += normalBias(model, state, scratch, c);
  q[3] *= c.material.torsion_radius;
  for (int k = 0; k < count; ++k) scratch.q[first + k] = q[k];
  for (int k = 0; k < count; ++k) scratch.r[first + k] = memory ? memory->r[k] : 0;
  scratch.mu[i] = c.mu;
}

}  // namespace

Motion startMotion(const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kPoint) return {scratch.points[side.index].v_start_W, Vec3::Zero()};
  return {scratch.bodies[side.index].v_start_W, scratch.bodies[side.index].w_start_W};
}

Motion freeMotion(const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kPoint) return {scratch.points[side.index].v_free_W, Vec3::Zero()};
  return {scratch.bodies[side.index].v_free_W, scratch.bodies[side.index].w_free_W};
}

ContactProblem assembleProblem(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  const int n = static_cast<int>(scratch.contacts.size());
  scratch.first_row[0] = 0;
  for (int i = 0; i < n; ++i) {
    const bool torsion = scratch.contacts[i].material.torsion_radius > 0;
    scratch.first_row[i + 1] = scratch.first_row[i] + (torsion ? kMaxContactRows : 3);
    fillContact(model, state, scratch, i);
  }
  const int m = scratch.first_row[n];
  MatrixMap W(scratch.W.data(), m, m);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) fillBlock(scratch, i, j, W);
  }
  return {{scratch.first_row.data(), static_cast<std::size_t>(n) + 1},
          {scratch.mu.data(), static_cast<std::size_t>(n)},
          W,
          VectorMap(scratch.q.data(), m)};
}

}  // namespace pincer::engine
