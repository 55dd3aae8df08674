// speed_limit: the most that a tree can get to in a part of a tick that is too long to show how it turns.
//
//   |u+|^2 + sum of k e+^2  <=  N^2,     |u|^2 = u^T M(q) u
//   N = (|u|^2 + sum of k e^2)^1/2 + |I|_M^-1 + sum of k^1/2 |s|
//   I = h (tau - C(q_m, 0)) + sum of c d s
//
// N follows from the triangle inequality: the motion's own forces do no work, dampers take some, and springs keep
// theirs. Symbols: drive_law.h, tree_course.h. A tree that turns further than that per part of a tick would gain
// energy by its own inertia, without an end.
#pragma once
#include "pincer/engine/tree/tree_course.h"

namespace pincer::engine {

// After predictTree: N^2 into course.most.
void noteMost(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
              std::span<const double> u, double h, TreeCourse& course);

// After predictTree: keeps the rates at the end of the free course within N, its way within that of their mean with
// those at the start, and N^2 in course.most.
void limitFreeCourse(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                     std::span<const double> u, double h, TreeCourse& course);

// Scales the rates u at q so that |u| is at most N + `given`, less the springs' share there; contacts give nothing.
void limitRates(const TreeModel& tree, const TreeBase& base, const TreePush& push, std::span<const double> q,
                double given, TreeCourse& course, std::span<double> u);

// Scales the rates at the end, u_free + gained, in the middle likewise, so that the way is within reach, too.
void limitGained(const TreeModel& tree, double given, TreeCourse& course, std::span<double> gained);

// After an impact at course.mid: scales the rates u down to |u_before|.
void limitStruck(const TreeModel& tree, std::span<const double> u_before, TreeCourse& course, std::span<double> u);

}  // namespace pincer::engine
