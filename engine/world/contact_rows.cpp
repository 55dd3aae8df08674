#include "engine/world/contact_rows.h"

#include <algorithm>

namespace pincer::engine {
namespace {

// Half a tick's turn of the normal and of the arms, from their motion since the last tick's middle: n_end . v_end - n_mid . v_mid.
double turnOfNormal(const WorldScratch& scratch, const Contact& c, const ContactMemory& memory) {
  const Vec3 n_W = c.n_W();
  const Vec3 v_rel_W = c.R_WC * c.v_start_C.head<3>();
  double turn = (n_W - memory.n_W).dot(v_rel_W);
  turn += n_W.dot(mover(scratch, c.a).start.w_W.cross(c.arm_a_W - memory.arm_a_W));
  turn -= n_W.dot(mover(scratch, c.b).start.w_W.cross(c.arm_b_W - memory.arm_b_W));
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

bool isStatic(const WorldModel& model, const Side& side) { return side.kind == SideKind::kBody && !model.bodies[side.index].dynamic; }

// block += sign A^T B. Written out: on columns of 3 x 4 blocks Eigen's packets cost twice as much, and a loop over the rows a third more
// (measured by instructions of a tick).
void addProduct(double sign, const Columns& A, int rows, const Columns& B, int cols, double* block) {
  const double* const a = A.data();
  for (int l = 0; l < cols; ++l, block += kMaxContactRows) {
    const double* const b = B.data() + 3 * l;
    const double x = sign * b[0], y = sign * b[1], z = sign * b[2];
    block[0] += a[0] * x + a[1] * y + a[2] * z;
    block[1] += a[3] * x + a[4] * y + a[5] * z;
    block[2] += a[6] * x + a[7] * y + a[8] * z;
    if (rows == kMaxContactRows) block[3] += a[9] * x + a[10] * y + a[11] * z;
  }
}

void crossColumns(const Vec3& arm, const Columns& lin, Columns& out) {
  for (int k = 0; k < 3; ++k) {
    const double* d = lin.data() + 3 * k;
    double* to = out.data() + 3 * k;
    to[0] = arm.y() * d[2] - arm.z() * d[1];
    to[1] = arm.z() * d[0] - arm.x() * d[2];
    to[2] = arm.x() * d[1] - arm.y() * d[0];
  }
}

void multiplyColumns(const Mat3& A, const Columns& in, int count, Columns& out) {
  for (int k = 0; k < count; ++k) {
    const double *x = in.data() + 3 * k, *a = A.data();
    double* to = out.data() + 3 * k;
    for (int i = 0; i < 3; ++i) to[i] = a[i] * x[0] + a[3 + i] * x[1] + a[6 + i] * x[2];
  }
}

void fillSide(const WorldModel& model, const WorldScratch& scratch, const Contact& c, const Side& side, const Vec3& arm_W, int count,
              const Columns& lin, SideColumns& out) {
  if (side.kind == SideKind::kPoint) {  // it doesn't turn: ang and mang are never read
    const Vec3& inverse_mass = scratch.points[side.index].inverse_mass;
    for (int k = 0; k < count; ++k) out.mlin.col(k) = inverse_mass.cwiseProduct(lin.col(k));
    return;
  }
  const double inverse_mass = model.bodies[side.index].inverse_mass;
  for (int k = 0; k < 3 * count; ++k) out.mlin.data()[k] = inverse_mass * lin.data()[k];
  crossColumns(arm_W, lin, out.ang);
  if (count == kMaxContactRows) out.ang.col(3) = c.material.torsion_radius * c.n_W();
  multiplyColumns(scratch.bodies[side.index].inverse_inertia_W, out.ang, count, out.mang);
}

void fillColumns(const WorldModel& model, const WorldScratch& scratch, const Contact& c, int count, ContactColumns& out) {
  out.lin.leftCols<3>() = c.R_WC;
  out.lin.col(3).setZero();
  if (!isStatic(model, c.a)) fillSide(model, scratch, c, c.a, c.arm_a_W, count, out.lin, out.sides[0]);
  if (!isStatic(model, c.b)) fillSide(model, scratch, c, c.b, c.arm_b_W, count, out.lin, out.sides[1]);
}

// Adds what one body or point that contacts i and j both touch makes them do to each other.
void addCoupling(const WorldScratch& scratch, int i, int side_i, int j, int side_j, bool turns, double* block) {
  const ContactColumns &x = scratch.columns[i], &y = scratch.columns[j];
  const SideColumns &sx = x.sides[static_cast<std::size_t>(side_i)], &sy = y.sides[static_cast<std::size_t>(side_j)];
  const int rows = scratch.first_row[i + 1] - scratch.first_row[i], cols = scratch.first_row[j + 1] - scratch.first_row[j];
  const double sign = side_i == side_j ? 1 : -1;
  addProduct(sign, x.lin, rows, sy.mlin, cols, block);
  if (turns) addProduct(sign, sx.ang, rows, sy.mang, cols, block);
}

void fillBlock(const WorldModel& model, const WorldScratch& scratch, int i, int j, MatrixMap& W) {
  double block[kMaxContactRows * kMaxContactRows] = {};
  const Contact &ci = scratch.contacts[i], &cj = scratch.contacts[j];
  for (int s = 0; s < 2; ++s) {
    const Side& side_i = s == 0 ? ci.a : ci.b;
    if (isStatic(model, side_i)) continue;
    for (int t = 0; t < 2; ++t) {
      const Side& side_j = t == 0 ? cj.a : cj.b;
      if (side_i.kind != side_j.kind || side_i.index != side_j.index) continue;
      addCoupling(scratch, i, s, j, t, side_i.kind == SideKind::kBody, block);
    }
  }
  const int row = scratch.first_row[i], col = scratch.first_row[j];
  for (int l = 0; col + l < scratch.first_row[j + 1]; ++l) {
    for (int k = 0; row + k < scratch.first_row[i + 1]; ++k) {
      W(row + k, col + l) = W(col + l, row + k) = block[l * kMaxContactRows + k];
    }
  }
}

void fillContact(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int i) {
  const double h = model.options.h;
  Contact& c = scratch.contacts[i];
  const int first = scratch.first_row[i], count = scratch.first_row[i + 1] - first;
  fillColumns(model, scratch, c, count, scratch.columns[i]);

  const ContactMemory* memory = c.memory >= 0 ? &state.contacts[c.memory] : nullptr;
  Eigen::Vector4d q = relativeVelocity(c, mover(scratch, c.a).free, mover(scratch, c.b).free);
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

ContactProblem assembleProblem(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  const int n = static_cast<int>(scratch.contacts.size());
  scratch.first_row[0] = 0;
  for (int i = 0; i < n; ++i) {
    scratch.first_row[i + 1] = scratch.first_row[i] + (scratch.contacts[i].material.torsion_radius > 0 ? kMaxContactRows : 3);
    fillContact(model, state, scratch, i);
  }
  const int m = scratch.first_row[n];
  MatrixMap W(scratch.W.data(), m, m);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) fillBlock(model, scratch, i, j, W);
  }
  return {{scratch.first_row.data(), static_cast<std::size_t>(n) + 1},
          {scratch.mu.data(), static_cast<std::size_t>(n)},
          W,
          VectorMap(scratch.q.data(), m)};
}

}  // namespace pincer::engine
