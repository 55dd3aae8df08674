#include "pincer/engine/tree/tree_course.h"

#include <algorithm>

#include "pincer/contact/assert.h"
#include "pincer/engine/tree/slot.h"
#include "pincer/engine/tree/tree_elements.h"

namespace pincer::engine {
namespace {

void addTimes(double factor, const std::vector<double>& x, std::vector<double>& sum) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * x[i];
}

// 1 / (c^T M^-1 c), of the factor of M in course.stage_factor.
double leastInertia(const TreeModel& tree, std::span<const ColumnShare> c, TreeCourse& course) {
  std::vector<double>& row = course.slope;
  std::fill(row.begin(), row.end(), 0.0);
  int tip = -1;
  for (const ColumnShare& share : c) {
    row[slot(share.column)] += share.share;
    tip = std::max(tip, share.column);
  }
  tip = scaleRow(tree, course.stage_factor, tip, row);
  double sum = 0;
  for (int i = tip; i >= 0; i = tree.before[slot(i)]) sum += row[slot(i)] * row[slot(i)];
  return 1 / sum;
}

// Soft springs beside stiff elements give the force of their middles: order 2, which keeps their energy. The rates
// of order 4 show a swing of it, which only Runge and Kutta's method for trees that are all soft doesn't.
void goByMiddles(const TreeModel& tree, const TreePush& push, std::span<const double> q, double h, TreeCourse& course) {
  forEachElement(tree, push, course.mid, q, course, [&](const Element& element, ElementCourse& out) {
    if (!out.soft) return;
    const double more = middleMass(element.law.stiffness, h);
    out.implied.mass += more;
    addSquare(tree, element.c, more, course.factor.entries);
  });
}

// M^ and its factor at q_m, the elements' laws from where the tick starts, and their impulses by
// columns in course.step. True if all are soft.
bool fillMiddle(const TreeModel& tree, const TreeBase& base, const TreePush& push, std::span<const double> q,
                std::span<const double> u, double h, TreeCourse& course) {
  fillInertia(tree, course.mid, course.composite, course.factor.entries);
  course.stage_factor.entries = course.factor.entries;
  if (!tree.loops.empty()) fillLoops(tree, base, course.mid, course.loop_rows);
  std::fill(course.step.begin(), course.step.end(), 0.0);
  bool are_soft = true, is_factorised = false;
  course.phase2 = 0;
  forEachElement(tree, push, course.mid, q, course, [&](const Element& element, ElementCourse& out) {
    if (!is_factorised) factoriseClosed(tree, course.loop_rows, course.stage_factor);
    is_factorised = true;
    const DriveTick& law = element.law;
    const ElementTick tick{law.stiffness, law.damping,    element.l - law.target, along(element.c, u),
                           law.way,       law.start_rate, law.end_rate,           h};
    out.rate = tick.rate;
    out.least_inertia = leastInertia(tree, element.c, course);
    out.soft = isSoft(tick.k, tick.d, out.least_inertia, h);
    are_soft = are_soft && out.soft;
    course.phase2 = std::max(course.phase2, h * h * tick.k / out.least_inertia);
    out.implied = out.soft ? softLaw(tick) : stiffLaw(tick, out.least_inertia);
    addSquare(tree, element.c, out.implied.mass, course.factor.entries);
    for (const ColumnShare& c : element.c) course.step[slot(c.column)] += c.share * out.implied.impulse;
  });
  if (!are_soft) goByMiddles(tree, push, q, h, course);
  if (!push.locked.empty()) course.inertia = course.factor.entries;
  course.sound = tree.loops.empty() ? factorise(tree, course.factor, push.locked)
                                    : factoriseClosed(tree, course.loop_rows, course.factor);
  return are_soft;
}

// Stops the locked columns: the others feel that they do.
void solveLocked(const TreeModel& tree, const TreePush& push, std::span<const double> u, TreeCourse& course,
                 std::vector<double>& change) {
  course.asked = change;
  for (std::size_t c = 0; c < u.size(); ++c) course.force[c] = push.locked[c] ? -u[c] : 0;
  multiply(tree, course.inertia, course.force, course.C);
  for (std::size_t c = 0; c < u.size(); ++c) change[c] -= course.C[c];
  solve(tree, course.factor, change);
  for (std::size_t c = 0; c < u.size(); ++c) change[c] += course.force[c];
}

// Du = M^^-1 (h (tau - C(q_m, course.u)) + p) of what goes by u at the start; into `change`.
void respond(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> u, double h,
             TreeCourse& course, std::vector<double>& change) {
  moveLinks(tree, base.mid, course.q, course.u, course.mid);
  fillConstantForces(tree, push, course.mid, course, course.force);
  fillBias(tree, course.mid, base.mid, push.gravity_W, push.forces, course.u, course.biases, course.C);
  for (std::size_t c = 0; c < change.size(); ++c) change[c] = h * (course.force[c] - course.C[c]) + course.step[c];
  if (!push.locked.empty()) return solveLocked(tree, push, u, course, change);
  solve(tree, course.factor, change);
  if (tree.loops.empty()) return;
  wantNoOpening(u, course.loop_rows);
  wantBend(tree, base.mid, push.gravity_W, course.mid, course.biases, 0.5 * h, course.loop_rows);
  addWanted(tree, course.factor, course.loop_rows, change);
}

// Half of what the contacts' expected impulses change, to course.u.
void addExpected(const TreeModel& tree, const TreePush& push, TreeCourse& course) {
  if (push.expected.empty()) return;
  std::fill(course.slope.begin(), course.slope.end(), 0.0);
  for (std::size_t l = 0; l < push.expected.size(); ++l)
    addWrench(tree, course.mid, static_cast<int>(l), push.expected[l].f_W, push.expected[l].tau_W, course.slope);
  solve(tree, course.factor, course.slope);
  addTimes(0.5, course.slope, course.u);
}

void goByTheMiddle(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> u,
                   double h, TreeCourse& course) {
  std::copy(u.begin(), u.end(), course.u.begin());
  respond(tree, base, push, u, h, course, course.slope);
  if (!push.pressed || !push.expected.empty()) {
    addTimes(0.5, course.slope, course.u);
    addExpected(tree, push, course);
    respond(tree, base, push, u, h, course, course.slope);
  }
  moveLinks(tree, base.mid, course.q, u, course.mid);
  for (std::size_t c = 0; c < u.size(); ++c) {
    course.u_free[c] = u[c] + course.slope[c];
    course.way_free[c] = h * (u[c] + 0.5 * course.slope[c]);
    if (!push.locked.empty() && push.locked[c]) course.way_free[c] = 0;
  }
}

// Where a drive's target is at share s of the tick, and how fast: the cubic with its two rates.
struct Target {
  double place, rate;
};
Target targetAt(const DriveTick& d, double s, double h) {
  const double a = d.start_rate, b = d.end_rate, mean = h > 0 ? d.way / h : 0;
  const double bend = 3 * mean - 2 * a - b, twist = a + b - 2 * mean;
  return {d.target + h * s * (a + s * (bend + s * twist)), a + s * (2 * bend + 3 * s * twist)};
}

// One look of Runge and Kutta: the columns' accelerations where course.q and course.u are, into course.slope.
void lookAt(const TreeModel& tree, const TreeBase& base, const TreePush& push, double s, double h, TreeCourse& course) {
  placeLinks(tree, base, course.q, course.stage);
  moveLinks(tree, base, course.q, course.u, course.stage);
  fillConstantForces(tree, push, course.stage, course, course.force);
  fillBias(tree, course.stage, base, push.gravity_W, push.forces, course.u, course.biases, course.C);
  for (std::size_t c = 0; c < course.slope.size(); ++c) course.slope[c] = course.force[c] - course.C[c];
  forEachElement(tree, push, course.stage, course.q, course, [&](const Element& element, const ElementCourse&) {
    const Target target = targetAt(element.law, s, h);
    const double spring = element.law.stiffness * (target.place - element.l);
    const double force = spring + element.law.damping * (target.rate - along(element.c, course.u));
    for (const ColumnShare& c : element.c) course.slope[slot(c.column)] += c.share * force;
  });
  fillInertia(tree, course.stage, course.composite, course.stage_factor.entries);
  if (!tree.loops.empty()) fillLoops(tree, base, course.stage, course.loop_rows);
  const bool is_positive = tree.loops.empty() ? factorise(tree, course.stage_factor, push.locked)
                                              : factoriseClosed(tree, course.loop_rows, course.stage_factor);
  course.sound = course.sound && is_positive;
  solve(tree, course.stage_factor, course.slope);
  if (tree.loops.empty()) return;
  std::fill(course.loop_rows.want.begin(), course.loop_rows.want.end(), 0.0);
  wantBend(tree, base, push.gravity_W, course.stage, course.biases, 1, course.loop_rows);
  addWanted(tree, course.stage_factor, course.loop_rows, course.slope);
}

// How steps from the start change where the columns go by u: of a ball's three, theta' =
// u - theta x u/2 + theta x (theta x u)/12.
void stepRates(const TreeModel& tree, std::span<const double> step, std::span<const double> u, std::span<double> out) {
  std::copy(u.begin(), u.end(), out.begin());
  for (const TreeLink& link : tree.links) {
    if (link.kind != JointKind::kBall) continue;
    const std::size_t c = slot(tree.coordinates[slot(link.first_v)].column);
    const Eigen::Map<const Vec3> theta(&step[c]), w(&u[c]);
    const Vec3 across = theta.cross(w);
    Eigen::Map<Vec3> rates(&out[c]);
    rates = w - 0.5 * across + theta.cross(across) / 12;
  }
}

// Steps of the free course that show how it turns and swings. The base's middle is known,
// no other places between its start and end.
int fineSteps(const BaseCourse& base, double h, const TreeCourse& course) {
  constexpr int kMostSteps = 4;  // of Runge and Kutta's method in a tick, at most
  const auto stands = [](const Motion& m) { return m.v_W.isZero(0) && m.w_W.isZero(0); };
  if (!stands(base.start.motion) || !stands(base.end.motion)) return 1;
  double rate2 = 0;
  for (const LinkPlace& link : course.mid.links) rate2 = std::max(rate2, link.motion.w_W.squaredNorm());
  const double size2 = std::max(h * h * rate2 / (kFineTurn * kFineTurn), course.phase2 / (kFinePhase * kFinePhase));
  int steps = 1;
  while (steps < kMostSteps && size2 > steps * steps) steps *= 2;
  return steps;
}

// One of `steps`, from what is in course.way_free and u_free on.
void stepByRungeKutta(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                      double h, int step, int steps, TreeCourse& course) {
  const std::array<const TreeBase*, 4> bases{&base.start, &base.mid, &base.mid, &base.end};
  constexpr std::array kShares{0.0, 0.5, 0.5, 1.0};                   // of the step: Runge and Kutta's stages
  constexpr std::array kWeights{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};  // of the stages: 4th order
  const double part = h / steps;
  course.old_step = course.step = course.way_free;
  course.old_u = course.u = course.u_free;
  for (std::size_t k = 0; k < kShares.size(); ++k) {
    growCoordinates(tree, q, course.step, course.q);
    lookAt(tree, *bases[k], push, (step + kShares[k]) / steps, h, course);
    stepRates(tree, course.step, course.u, course.force);
    addTimes(part * kWeights[k], course.force, course.way_free);
    addTimes(part * kWeights[k], course.slope, course.u_free);
    if (k + 1 == kShares.size()) break;
    for (std::size_t c = 0; c < course.u.size(); ++c) {
      course.step[c] = course.old_step[c] + part * kShares[k + 1] * course.force[c];
      course.u[c] = course.old_u[c] + part * kShares[k + 1] * course.slope[c];
    }
  }
}

}  // namespace

TreeCourse::TreeCourse(const TreeModel& tree)
    : mid(tree),
      factor(tree),
      inertia(slot(tree.entries)),
      asked(tree.before.size()),
      springs(tree.coordinates.size()),
      drives(tree.drives.size()),
      u_free(tree.before.size()),
      way_free(tree.before.size()),
      end(tree),
      biases(tree.links.size()),
      composite(tree.links.size()),
      stage(tree),
      stage_factor(tree),
      loop_rows(tree),
      end_loops(tree),
      C(tree.before.size()),
      q(slot(tree.q_count)),
      u(tree.before.size()),
      step(tree.before.size()),
      force(tree.before.size()),
      slope(tree.before.size()),
      old_u(tree.before.size()),
      old_step(tree.before.size()) {
  std::size_t longest = 1;
  for (const TreeDrive& drive : tree.drives) longest = std::max(longest, drive.terms.size());
  shares.reserve(longest);
}

void goByRungeKutta(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                    std::span<const double> u, double h, TreeCourse& course) {
  course.fine = true;
  std::fill(course.way_free.begin(), course.way_free.end(), 0.0);
  std::copy(u.begin(), u.end(), course.u_free.begin());
  const int steps = fineSteps(base, h, course);
  for (int step = 0; step < steps; ++step) stepByRungeKutta(tree, base, push, q, h, step, steps, course);
}

void predictTree(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                 std::span<const double> u, double h, TreeCourse& course) {
  PINCER_ASSERT(h > 0 && push.drives.size() == tree.drives.size());
  for (std::size_t c = 0; c < u.size(); ++c) course.step[c] = 0.5 * h * u[c];
  growCoordinates(tree, q, course.step, course.q);
  placeLinks(tree, base.mid, course.q, course.mid);
  moveLinks(tree, base.mid, course.q, u, course.mid);
  course.soft = fillMiddle(tree, base.mid, push, q, u, h, course);
  course.fine = false;
  if (course.soft && push.may_be_fine) {
    goByRungeKutta(tree, base, push, q, u, h, course);
  } else {
    goByTheMiddle(tree, base, push, u, h, course);
  }
}

void moveFreeEnd(const TreeModel& tree, const BaseCourse& base, std::span<const double> q, std::span<const double> u,
                 double h, TreeCourse& course) {
  for (std::size_t c = 0; c < u.size(); ++c) {
    course.step[c] = 0.5 * h * u[c];
    course.u[c] = course.u_free[c] - u[c];
  }
  growCoordinates(tree, q, course.step, course.q);
  TreeBase standing = base.mid;
  standing.motion = {};
  placeLinks(tree, standing, course.q, course.stage);
  moveLinks(tree, standing, course.q, course.u, course.stage);
  for (std::size_t c = 0; c < u.size(); ++c) course.step[c] = h * u[c];
  growCoordinates(tree, q, course.step, course.q);
  placeLinks(tree, base.end, course.q, course.end);
  moveLinks(tree, base.end, course.q, u, course.end);
  for (std::size_t l = 0; l < course.end.links.size(); ++l) {
    Motion& motion = course.end.links[l].motion;
    const Motion& gained = course.stage.links[l].motion;
    motion = {motion.v_W + gained.v_W, motion.w_W + gained.w_W};
  }
}

void advanceTree(const TreeModel& tree, const TreeBase& base, const TreeGain& gain, double t, std::span<const double> q,
                 std::span<const double> u, TreeCourse& course, std::span<double> q_out, std::span<double> u_out) {
  PINCER_ASSERT(gain.h > 0 && t >= 0);
  const double share = t / gain.h;
  for (std::size_t c = 0; c < u.size(); ++c) {
    const double u_end = course.u_free[c] + gain.gained[c], way = wayOf(course, gain, c, u[c]);
    const bool lands = gain.closing && gain.gained[c] != 0;
    // The part of the way beyond that of the rates at the start grows with the square of the time.
    course.step[c] = share == 1 ? way : lands ? share * way : t * u[c] + share * share * (way - gain.h * u[c]);
    u_out[c] = lands ? u_end : u[c] + share * (u_end - u[c]);
  }
  growCoordinates(tree, q, course.step, q_out);
  placeLinks(tree, base, q_out, course.end);
  if (tree.loops.empty()) {
    moveLinks(tree, base, q_out, u_out, course.end);
  } else {
    closeLoops(tree, base, course.factor, kClosingPasses, course.loop_rows, course.end_loops, q_out, u_out, course.end);
  }
}

void holdingImpulses(const TreeModel& tree, const TreeCourse& course, std::span<const double> u,
                     std::span<const double> gained, std::span<const double> impulse, std::vector<double>& change,
                     std::vector<double>& out) {
  for (std::size_t c = 0; c < u.size(); ++c) change[c] = course.u_free[c] + gained[c] - u[c];
  multiply(tree, course.inertia, change, out);
  for (std::size_t c = 0; c < u.size(); ++c) out[c] -= course.asked[c] + impulse[c];
}

double lengthOf(const TreeModel& tree, const TreeDrive& drive, std::span<const double> q) {
  double l = 0;
  for (const TreeDrive::Term& term : drive.terms) l += term.factor * q[slot(tree.coordinates[slot(term.coordinate)].q)];
  return l;
}

void columnShares(const TreeModel& tree, const TreePlace& place, const TreeDrive& drive,
                  std::vector<ColumnShare>& out) {
  out.clear();
  for (const TreeDrive::Term& term : drive.terms) {
    const int column = tree.coordinates[slot(term.coordinate)].column;
    const double share = term.factor * place.coordinates[slot(term.coordinate)].share;
    const auto same = std::find_if(out.begin(), out.end(), [&](const ColumnShare& c) { return c.column == column; });
    if (same == out.end()) {
      out.push_back({column, share});
    } else {
      same->share += share;
    }
  }
}

}  // namespace pincer::engine
