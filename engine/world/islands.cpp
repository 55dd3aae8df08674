#include "engine/world/islands.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "engine/solve/contact_equations.h"
#include "engine/solve/gauss_seidel.h"
#include "engine/world/contact_rows.h"
#include "engine/world/island_bias.h"
#include "engine/world/island_threads.h"
#include "engine/world/joints.h"
#include "engine/world/scratch.h"

namespace pincer::engine {
namespace {

constexpr double kLost = 1e-2;       // residual that is no answer
constexpr int kStoppingSweeps = 30;  // instead
constexpr int kLoopContacts = 12;    // fewer are solved to the end: bodies that are pinched must not creep
constexpr int kHeapContacts = 200;   // beyond, sweeps go on in the next tick from what they reached in this one
constexpr double kHeapLost = 0.3;    // their residual that is no answer: impulses were scaled down to add no energy
constexpr int kSettlingTicks = 24;   // stick offsets halve per tick: from the tolerance to round-off

// The number of what moves there in IslandScratch's arrays per mover; -1 for what doesn't.
int moverOf(const WorldModel& model, const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kBody) {
    const BodyModel& body = model.bodies[side.index];
    if (body.joint_group >= 0) return model.joint_groups[body.joint_group].bodies.front();  // joined bodies are one mover
    return body.dynamic ? side.index : -1;
  }
  const PointScratch& point = scratch.points[side.index];
  const Vec3& inverse_mass = point.inverse_mass;
  const bool moves = inverse_mass[0] != 0 || inverse_mass[1] != 0 || inverse_mass[2] != 0 || point.inverse_twist > 0;
  return moves ? static_cast<int>(model.bodies.size()) + side.index : -1;
}

int rootOf(std::vector<int>& parent, int mover) {
  while (parent[mover] != mover) mover = parent[mover] = parent[parent[mover]];
  return mover;
}

void findEnds(const WorldModel& model, const WorldScratch& scratch, IslandScratch& s) {
  ContactEnds* ends = s.ends.data();
  int *const parent = s.parent.data(), *const number = s.number.data(), *const island_of = s.island_of.data();
  for (const Contact& c : scratch.contacts) {
    *ends = {moverOf(model, scratch, c.a), moverOf(model, scratch, c.b)};
    for (const int mover : {ends->a, ends->b}) {
      if (mover < 0) continue;
      parent[mover] = mover;
      number[mover] = island_of[mover] = -1;
    }
    ++ends;
  }
}

bool touches(const ContactEnds& ends, int mover) { return ends.a == mover || ends.b == mover; }

// All contacts touch one mover, as in a grasp: they are one island.
bool haveCommonMover(std::span<const ContactEnds> all) {
  for (const int mover : {all[0].a, all[0].b}) {
    if (mover >= 0 && std::all_of(all.begin(), all.end(), [mover](const ContactEnds& ends) { return touches(ends, mover); })) return true;
  }
  return false;
}

void uniteMovers(std::span<const ContactEnds> all, IslandScratch& s) {
  for (const ContactEnds& ends : all) {
    if (ends.a < 0 || ends.b < 0) continue;
    const int a = rootOf(s.parent, ends.a), b = rootOf(s.parent, ends.b);
    s.parent[std::max(a, b)] = std::min(a, b);
  }
}

void makeOneIsland(int contacts, IslandScratch& s) {
  s.islands.clear();
  s.islands.emplace_back().contacts = contacts;
  std::iota(s.order.begin(), s.order.begin() + contacts, 0);
}

void sortContacts(std::span<const ContactEnds> all, IslandScratch& s) {
  const int n = static_cast<int>(all.size());
  s.islands.clear();
  for (int i = 0; i < n; ++i) {
    const int root = rootOf(s.parent, std::max(all[i].a, all[i].b));
    if (s.island_of[root] < 0) {
      s.island_of[root] = static_cast<int>(s.islands.size());
      s.islands.emplace_back();
    }
    s.contact_island[i] = s.island_of[root];
    ++s.islands[s.island_of[root]].contacts;
  }
  int place = 0;
  for (Island& island : s.islands) {
    island.place = place;
    place += island.contacts;
    island.contacts = 0;
  }
  for (int i = 0; i < n; ++i) {
    Island& island = s.islands[s.contact_island[i]];
    s.order[island.place + island.contacts++] = i;
  }
}

// Of a body: F = R diag(1 / sqrt(I_k)).
Mat3 rootOfInertia(const FreeRotation& rotation, const Quat& q_WI) {
  if (rotation.kind == FreeRotation::Kind::kSpherical) return rotation.root_inverse_moments[0] * Mat3::Identity();
  return q_WI.toRotationMatrix() * rotation.root_inverse_moments.asDiagonal();
}

void fillPointSide(const Contact& c, int rows, double sign, const PointScratch& point, ContactSide& out) {
  const Vec3 root = sign * point.root_inverse_mass;
  for (int k = 0; k < rows; ++k) std::fill(out.A[k], out.A[k] + kMoverFreedoms, 0.0);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) out.A[k][j] = root[j] * (point.turned ? point.R_WA.col(j).dot(c.R_WC.col(k)) : c.R_WC(j, k));
  }
  if (rows > kTorsionRow) out.A[kTorsionRow][3] = sign * radiusOf(c, kTorsionRow) * std::sqrt(point.inverse_twist);
}

// F  of a sphere a multiple of the identity
void fillBodySide(const Contact& c, int rows, double sign, const Vec3& arm_W, double root_mass, const Mat3& F, bool is_sphere,
                  ContactSide& out) {
  const double linear = sign * root_mass;
  const Vec3 arm = is_sphere ? Vec3((sign * F(0, 0)) * arm_W) : arm_W;
  for (int k = 0; k < 3; ++k) {
    const double x = c.R_WC(0, k), y = c.R_WC(1, k), z = c.R_WC(2, k);
    const double ang[3] = {arm[1] * z - arm[2] * y, arm[2] * x - arm[0] * z, arm[0] * y - arm[1] * x};
    double* const A = out.A[k];
    A[0] = linear * x;
    A[1] = linear * y;
    A[2] = linear * z;
    for (int j = 0; j < 3; ++j) A[3 + j] = is_sphere ? ang[j] : sign * (F(0, j) * ang[0] + F(1, j) * ang[1] + F(2, j) * ang[2]);
  }
  for (int k = kTorsionRow; k < rows; ++k) {
    const Vec3 ang = (sign * radiusOf(c, k)) * axisOf(c, k);
    for (int j = 0; j < 3; ++j) {
      out.A[k][j] = 0;
      out.A[k][3 + j] = F(0, j) * ang[0] + F(1, j) * ang[1] + F(2, j) * ang[2];
    }
  }
}

void fillSide(const WorldModel& model, const WorldScratch& scratch, const Contact& c, int rows, bool is_a, int mover, int number,
              IslandScratch& s, ContactSide& out) {
  out.mover = number;
  if (mover < 0) return;
  const Side& side = is_a ? c.a : c.b;
  out.is_point = side.kind == SideKind::kPoint && rows == kTorsionRow;
  const double sign = is_a ? 1 : -1;
  if (side.kind == SideKind::kPoint) return fillPointSide(c, rows, sign, scratch.points[side.index], out);
  const BodyModel& body = model.bodies[side.index];
  const Vec3& arm_W = is_a ? c.arm_a_W : c.arm_b_W;
  if (body.joint_group < 0) {
    const bool is_sphere = body.rotation.kind == FreeRotation::Kind::kSpherical;
    return fillBodySide(c, rows, sign, arm_W, body.root_inverse_mass, s.root_inertia[mover], is_sphere, out);
  }
  for (int k = 0; k < rows; ++k) std::fill(out.A[k], out.A[k] + kMoverFreedoms, 0.0);
  addJointedSide(model, scratch, c, rows, sign, side.index, arm_W, out);
}

// Two joined bodies that touch each other are one mover: what they do is one block.
void joinSides(int rows, ContactSides& sides) {
  for (int k = 0; k < rows; ++k) {
    for (int j = 0; j < kMoverFreedoms; ++j) sides[0].A[k][j] += sides[1].A[k][j];
  }
  sides[0].is_point = false;
  sides[1].mover = -1;
}

int numberOf(const WorldModel& model, const WorldScratch& scratch, const Side& side, int mover, Island& island, IslandScratch& s) {
  if (mover < 0) return -1;
  if (s.number[mover] < 0) {
    s.number[mover] = island.movers++;
    if (side.kind == SideKind::kBody)
      s.root_inertia[mover] = rootOfInertia(model.bodies[side.index].rotation, scratch.bodies[side.index].X_WI_mid.q);
  }
  return s.number[mover];
}

// Copies what the contacts of island k are to the solver.
void gather(const WorldModel& model, const WorldScratch& scratch, int k, int row, IslandScratch& s) {
  Island& island = s.islands[k];
  island.row = row;
  int* const first_row = s.first_row.data() + island.place + k;
  const int *const order = s.order.data() + island.place, *const from_row = scratch.first_row.data();
  const Contact* const contacts = scratch.contacts.data();
  const ContactEnds* const all_ends = s.ends.data();
  const double *const all_mu = scratch.mu.data(), *const all_q = scratch.q.data(), *const all_r = scratch.r.data();
  ContactSides* const all_sides = s.sides.data() + island.place;
  double *const mu = s.mu.data() + island.place, *const q = s.q.data() + row, *const r = s.r.data() + row;
  int rows_before = 0, settling = 0;
  for (int n = 0; n < island.contacts; ++n) {
    const int i = order[n], from = from_row[i], rows = from_row[i + 1] - from;
    const Contact& c = contacts[i];
    const ContactEnds ends = all_ends[i];
    ContactSides& sides = all_sides[n];
    fillSide(model, scratch, c, rows, true, ends.a, numberOf(model, scratch, c.a, ends.a, island, s), s, sides[0]);
    fillSide(model, scratch, c, rows, false, ends.b, numberOf(model, scratch, c.b, ends.b, island, s), s, sides[1]);
    if (ends.a >= 0 && ends.a == ends.b) joinSides(rows, sides);
    first_row[n] = rows_before;
    mu[n] = all_mu[i];
    settling = std::max(settling, c.settling);
    withRows(rows, [&](auto count) {
      for (int l = 0; l < count; ++l) {
        q[rows_before + l] = all_q[from + l];
        r[rows_before + l] = all_r[from + l];
      }
    });
    rows_before += rows;
  }
  island.settling = settling;
  first_row[island.contacts] = island.rows = rows_before;
}

// For how long warm starts have to be exact to round-off: from an answer that took iterations on, until it is clear that none comes that is. One
// that fits isn't the end of it: the impulses of a body that still slows down by 1e-13 m/s in a tick, kept, would turn it round and move it off.
int nextSettling(const Island& island, double tolerance) {
  if (!(island.result.start <= tolerance)) return kSettlingTicks;
  if (island.result.method == SolveMethod::kWarmStart) return island.settling > 0 ? kSettlingTicks : 0;
  return island.settling - 1;
}

void scatter(const IslandScratch& s, const Island& island, double tolerance, WorldScratch& scratch) {
  const int settling = nextSettling(island, tolerance);
  const bool quiet = island.result.method == SolveMethod::kWarmStart;
  const int *const order = s.order.data() + island.place, *const from_row = scratch.first_row.data();
  Contact* const contacts = scratch.contacts.data();
  const double *r_k = s.r.data() + island.row, *u_k = s.u.data() + island.row;
  double *const r = scratch.r.data(), *const u = scratch.u.data();
  for (int n = 0; n < island.contacts; ++n) {
    const int i = order[n];
    contacts[i].settling = settling;
    contacts[i].quiet = quiet;
    const int first = from_row[i], rows = from_row[i + 1] - first;
    withRows(rows, [&](auto count) {
      for (int l = 0; l < count; ++l) {
        r[first + l] = r_k[l];
        u[first + l] = u_k[l];
      }
    });
    r_k += rows;
    u_k += rows;
  }
}

void addResult(const SolveResult& island, SolveResult& all) {
  all.method = std::max(all.method, island.method);
  all.iterations += island.iterations;
  all.residual = std::max(all.residual, island.residual);
  all.converged = all.converged && island.converged;
}

}  // namespace

IslandScratch::IslandScratch(const WorldModel& model) {
  const auto n = static_cast<std::size_t>(model.options.max_contacts), m = kMaxContactRows * n;
  const std::size_t movers = model.bodies.size() + model.points.size();
  islands.reserve(n);
  for (std::vector<int>* per_contact : {&order, &contact_island}) per_contact->resize(n);
  ends.resize(n);
  for (std::vector<int>* per_mover : {&parent, &number, &island_of}) per_mover->resize(movers);
  first_row.resize(2 * n + 1);
  sides.resize(n);
  root_inertia.resize(movers);
  mu.resize(n);
  for (std::vector<double>* per_row : {&q, &r, &u}) per_row->resize(m);
  for (int t = 0; t < model.options.threads; ++t)
    solvers.push_back(std::make_unique<SolverScratch>(model.options.max_contacts, static_cast<int>(movers)));
  if (model.options.threads > 1) threads = std::make_unique<IslandThreads>(model.options.threads);
}

IslandScratch::~IslandScratch() = default;
IslandScratch::IslandScratch(IslandScratch&&) noexcept = default;

namespace {

// What is kept of the budget for stopOnly: support doesn't depend on it.
std::int64_t reserveFor(const Island& island) { return kStoppingSweeps * kPerContactSwept * island.contacts; }

// Contacts that contradict each other have no answer: what overlaps in all directions can't be pushed apart. Then they only stop what closes:
// biases that push are left out, and sweeps from no impulse at all each take energy away. Support is better than falling through the floor.
void stopOnly(const ContactProblem& problem, const SolverOptions& options, Island& island, SolverScratch& memory, WorldScratch& scratch) {
  IslandScratch& s = scratch.islands;
  double *const q = s.q.data() + island.row, *const r = s.r.data() + island.row;
  for (int n = 0; n < island.contacts; ++n) {
    const Contact& c = scratch.contacts[s.order[island.place + n]];
    const int first = problem.firstRow(n);
    for (int k = 0; k < problem.rows(n); ++k) {
      if (k != kNormalRow || c.bias_C[k] < 0) q[first + k] -= (k >= kTorsionRow ? radiusOf(c, k) : 1) * c.bias_C[k];
    }
  }
  std::fill(r, r + island.rows, 0.0);
  SolverOptions sweeps = options;
  sweeps.newton_iterations = sweeps.proximal_rounds = sweeps.interior_point_iterations = sweeps.shift_updates = 0;
  sweeps.gauss_seidel_sweeps = sweeps.large_sweeps = kStoppingSweeps;
  const SolveResult lost = island.result;
  const std::int64_t left = memory.operations_left;
  memory.operations_left = kNoLimit;
  solveContacts(problem, sweeps, memory, VectorMap(r, island.rows), VectorMap(s.u.data() + island.row, island.rows));
  memory.operations_left = left - reserveFor(island);
  island.result = lost;
}

// What is tried before what contacts ask for is fitted to what was found.
SolverOptions withoutCostly(SolverOptions options) {
  options.interior_point_iterations = options.shift_updates = options.gauss_seidel_sweeps = 0;
  return options;
}

// Around loops of bodies that are held more than six-fold, what sticks here and slips there can't be told apart to the last digits: a contact
// that slips by some 10 nm/s has its friction's direction from that.
SolverOptions asOfLoops(SolverOptions options) {
  constexpr double kEnough = 5e-7;  // residual [-]
  options.contentment = std::max(options.contentment, kEnough);
  return options;
}

SolveResult again(const SolveResult& first, SolveResult second) {
  second.iterations += first.iterations;
  second.start = first.start;
  return second;
}

bool isLost(const SolveResult& result, bool is_heap) { return !result.converged && result.residual > (is_heap ? kHeapLost : kLost); }

void solveIsland(const WorldModel& model, int k, int thread, WorldScratch& scratch) {
  IslandScratch& s = scratch.islands;
  Island& island = s.islands[k];
  const auto n = static_cast<std::size_t>(island.contacts);
  const ContactProblem problem{{s.first_row.data() + island.place + k, n + 1},
                               {s.mu.data() + island.place, n},
                               {s.sides.data() + island.place, n},
                               VectorMap(s.q.data() + island.row, island.rows),
                               island.movers,
                               island.settling > 0};
  SolverScratch& memory = *s.solvers[thread];
  const bool is_heap = island.contacts > kHeapContacts, is_entangled = is_heap && chooseForm(problem, memory) == EquationForm::kTooLarge;
  const auto fit = [&](PushingBy pushing) {
    if (scratch.h > 0 && (!is_heap || is_entangled))
      fitIslandBiases(pushing, scratch.h, kTangentCorrection / model.options.h, problem, s.r.data() + island.row, s.q.data() + island.row,
                      {s.order.data() + island.place, n}, scratch.contacts, memory);
  };
  const bool is_limited = scratch.operations_left < kNoLimit;
  const std::int64_t share = is_limited ? std::max<std::int64_t>(scratch.operations_left, 0) * island.rows / s.rows : kNoLimit;
  const std::int64_t reserve = is_limited ? reserveFor(island) : 0;
  memory.operations_left = share - reserve;
  fit(PushingBy::kLastTick);
  const VectorMap r(s.r.data() + island.row, island.rows), u(s.u.data() + island.row, island.rows);
  if (scratch.h > 0 && !is_heap && mayContradict(problem)) {
    island.result = solveContacts(problem, withoutCostly(model.options.solver), memory, r, u);
    if (!island.result.converged) {
      fit(PushingBy::kImpulses);
      const SolverOptions& whole = model.options.solver;
      island.result = again(island.result, solveContacts(problem, n < kLoopContacts ? whole : asOfLoops(whole), memory, r, u));
    }
  } else {
    island.result = solveContacts(problem, model.options.solver, memory, r, u);
  }
  if (isLost(island.result, is_heap)) stopOnly(problem, model.options.solver, island, memory, scratch);
  island.operations = is_limited ? share - reserve - memory.operations_left : 0;
}

}  // namespace

void solveIslands(const WorldModel& model, WorldScratch& scratch) {
  IslandScratch& s = scratch.islands;
  scratch.solve = {};
  if (scratch.contacts.empty()) return;
  findEnds(model, scratch, s);
  const std::span<const ContactEnds> ends(s.ends.data(), scratch.contacts.size());
  if (haveCommonMover(ends)) {
    makeOneIsland(static_cast<int>(ends.size()), s);
  } else {
    uniteMovers(ends, s);
    sortContacts(ends, s);
  }
  int row = 0;
  const int count = static_cast<int>(s.islands.size());
  for (int k = 0; k < count; ++k) {
    gather(model, scratch, k, row, s);
    row += s.islands[k].rows;
  }
  s.rows = row;
  const auto solve = [&](int k, int thread) { solveIsland(model, k, thread, scratch); };
  if (s.threads && count > 1) {
    s.threads->run(count, solve);
  } else {
    for (int k = 0; k < count; ++k) solve(k, 0);
  }
  std::int64_t operations = 0;
  for (const Island& island : s.islands) {
    scatter(s, island, model.options.solver.tolerance, scratch);
    addResult(island.result, scratch.solve);
    operations += island.operations;
  }
  if (scratch.operations_left < kNoLimit) scratch.operations_left -= operations;  // below 0 if one of them ran out
}

}  // namespace pincer::engine
