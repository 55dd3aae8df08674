// tree_course: a tick of a tree, contacts apart.
//
//   q_m = q (+) h u/2: geometry, M, J;     u+ = u + Du;     q+ = q (+) h (u + u+)/2;     M^ = M + sum of c c^T m^
//   M^ Du = h (tau - C(q_m, u + h a/2)) + p + J^T r,        M^ h a = h (tau - C(q_m, u)) + p
//
// q_m is without forces, so that what rests is found where it is. m^ and p of springs, dampers and drives: drive_law.h;
// tau of what is constant. Loops are closed in all of these (loop_closure.h). Of a tree that contacts press a has
// M^^-1 J^T r/h in it, by the impulses r of the last tick: else a link that slides along something would lose or gain
// energy at first order in h. Where these aren't known C is that of u: a without them is far from how the tree moves,
// and a grasp at rest would feel forces of a motion that isn't there.
//
// A tree that nothing else pushes goes by Runge and Kutta's method of 4th order where all of those are soft (balls
// by exponentials: H. Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115-127); on a base at rest in up to four steps, if a
// link turns by more than kFineTurn in one, or a spring swings by more than kFinePhase.
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/tree/drive_law.h"
#include "pincer/engine/tree/loop_closure.h"
#include "pincer/engine/tree/sparse_ldl.h"
#include "pincer/engine/tree/tree_bias.h"
#include "pincer/engine/tree/tree_inertia.h"

namespace pincer::engine {

// A drive in this tick: F = force + stiffness (target - l) + damping (target' - l').
struct DriveTick {
  double stiffness = 0, damping = 0, force = 0;
  double target = 0, way = 0, start_rate = 0, end_rate = 0;  // at the start; how far it goes, and how fast
};

constexpr double kFineTurn = 0.01;  // [rad]: the error goes with the fifth power
constexpr double kFinePhase = 0.1;  // of 2 pi per period: a step takes phase^6/144 of a swing

// Loads on a tree.
struct TreePush {
  Vec3 gravity_W = Vec3::Zero();
  std::span<const LinkForce> forces{};  // one per link, or none
  std::span<const DriveTick> drives{};  // one per drive of the tree
  std::span<const double> constant{};   // forces that stay all through the tick, by coordinates, or none
  bool may_be_fine = true;              // the free course by Runge and Kutta, if all is soft
  bool pressed = false;                 // contacts hold back what drives would do in the tick
  std::span<const char> locked{};       // true for columns that stop and stay; empty if none do
  // Impulses of contacts on each link [N s, N m s], as the last tick lets expect; none: unknown.
  std::span<const LinkForce> expected{};
};

// The base at the start, the middle and the end of the tick.
struct BaseCourse {
  TreeBase start, mid, end;
};

// A spring or drive along its length at the start of the tick; what it adds to M and to the impulses.
struct ElementCourse {
  double rate = 0;
  double least_inertia = 0;  // m; 0 where nobody had to look
  bool soft = true;
  ImpliedInertia implied;
};

struct TreeCourse {
  explicit TreeCourse(const TreeModel& tree);

  bool sound = true;                           // M^ was positive definite
  bool soft = true;                            // all springs and drives are
  double phase2 = 0;                           // the most of h^2 k/m among them
  bool fine = false;                           // by Runge and Kutta
  bool rough = false;                          // the middle doesn't show how it turns: speed_limit.h
  double most = 0;                             // N^2 there
  TreePlace mid;                               // at q_m, with the motion of u there
  TreeFactor factor;                           // of M^ there
  std::vector<double> inertia, asked;          // M^, and h (tau - C) + p, where columns are locked
  std::vector<ElementCourse> springs, drives;  // of coordinates; of drives
  std::vector<double> u_free, way_free;        // by columns: rates at the end, steps until then
  TreePlace end;                               // as moveFreeEnd or advanceTree left it
  // Scratch.
  std::vector<LinkBias> biases;
  std::vector<CompositeInertia> composite;
  TreePlace stage;
  TreeFactor stage_factor;
  LoopRows loop_rows;
  LoopBasis end_loops;
  std::vector<double> C, q, u, step, force, slope, old_u, old_step;
  std::vector<ColumnShare> shares;
};

// The free course of a tree that is at q (q_count) and goes by u (columns). Allocates nothing. h > 0.
void predictTree(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                 std::span<const double> u, double h, TreeCourse& course);

// The free course by Runge and Kutta, after predictTree, where all is soft. Locked columns are at rest.
void goByRungeKutta(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                    std::span<const double> u, double h, TreeCourse& course);

// Motions at the end of the free course as contacts in the middle see them, in `course.end`:
//
//   J(q (+) h u) u + J(q_m) (u_free - u),   the base at the tick's end, and in its middle for what u_free adds
//
// The turn is that of the rates at the start: by those of the free course a drive that presses a link against
// something would turn it through that, and what rests would seem to move. What u_free adds is along the axes by which
// contacts hold it back: along those of a base that has turned on, something of it would be left across them, and what
// two jaws hold would be wrung by each against the other.
void moveFreeEnd(const TreeModel& tree, const BaseCourse& base, std::span<const double> q, std::span<const double> u,
                 double h, TreeCourse& course);

// How the tick went once impulses have changed the columns' rates at its end by `gained`. `closing`: all the way goes
// by the rates at the end, for what lands.
struct TreeGain {
  std::span<const double> gained{};
  double h = 0;
  bool closing = false;
};
// The step of a column over the whole tick.
inline double wayOf(const TreeCourse& course, const TreeGain& gain, std::size_t column, double u) {
  const double gained = gain.gained[column], u_end = course.u_free[column] + gained;
  if (gained == 0) return course.way_free[column];
  return gain.h * (gain.closing ? u_end : 0.5 * (u + u_end));
}
// At `t` after the tick's start, 0 .. h: q and the columns' rates, places and motions in `course.end`.
// Neither `q_out` nor `u_out` may be `q` or `u`.
void advanceTree(const TreeModel& tree, const TreeBase& base, const TreeGain& gain, double t, std::span<const double> q,
                 std::span<const double> u, TreeCourse& course, std::span<double> q_out, std::span<double> u_out);

// Impulse of an element along its length over the tick, where that goes by `rate_end` in the end [N s, N m s];
// the drive's constant force comes on top.
inline double impulseOf(const ElementCourse& element, double rate_end) {
  return element.implied.impulse - element.implied.mass * (rate_end - element.rate);
}

// Impulses that hold the locked columns, by columns, where contacts and joints' rows gave `impulse` and changed the
// rates by `gained`: M^ Du - h (tau - C) - p - J^T r.
void holdingImpulses(const TreeModel& tree, const TreeCourse& course, std::span<const double> u,
                     std::span<const double> gained, std::span<const double> impulse, std::vector<double>& change,
                     std::vector<double>& out);

// Length of a drive at q.
double lengthOf(const TreeModel& tree, const TreeDrive& drive, std::span<const double> q);

// How a drive's length changes with the columns' rates, at this place; `out` keeps its memory.
// Columns that two terms share stand once.
void columnShares(const TreeModel& tree, const TreePlace& place, const TreeDrive& drive, std::vector<ColumnShare>& out);

}  // namespace pincer::engine
