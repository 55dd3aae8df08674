#include "pincer/engine/tree/speed_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/engine/tree/slot.h"
#include "pincer/engine/tree/tree_elements.h"

namespace pincer::engine {
namespace {

// x^T M x, of the packed M.
double squareIn(const TreeModel& tree, const std::vector<double>& M, std::span<const double> x) {
  double sum = 0;
  for (int i = 0; i < tree.columnCount(); ++i) {
    double row = 0.5 * M[entryOf(tree, i, i)] * x[slot(i)];
    for (int j = tree.before[slot(i)]; j >= 0; j = tree.before[slot(j)]) row += M[entryOf(tree, i, j)] * x[slot(j)];
    sum += 2 * x[slot(i)] * row;
  }
  return sum;
}

double springShare(const TreeModel& tree, const TreePush& push, const TreePlace& place, std::span<const double> q,
                   bool at_end, TreeCourse& course) {
  double sum = 0;
  forEachElement(tree, push, place, q, course, [&](const Element& element, const ElementCourse&) {
    const double e = element.l - element.law.target - (at_end ? element.law.way : 0);
    sum += element.law.stiffness * e * e;
  });
  return sum;
}

// Sum of k^1/2 |s|, and I in course.step.
double fillImpulses(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                    double h, TreeCourse& course) {
  std::fill(course.u.begin(), course.u.end(), 0.0);
  placeLinks(tree, base.mid, course.q, course.stage);
  moveLinks(tree, base.mid, course.q, course.u, course.stage);
  fillBias(tree, course.stage, base.mid, push.gravity_W, push.forces, course.u, course.biases, course.C);
  fillConstantForces(tree, push, course.stage, course, course.force);
  for (std::size_t c = 0; c < course.step.size(); ++c) course.step[c] = h * (course.force[c] - course.C[c]);
  double sum = 0;
  forEachElement(tree, push, course.stage, q, course, [&](const Element& element, const ElementCourse&) {
    sum += std::sqrt(element.law.stiffness) * std::abs(element.law.way);
    for (const ColumnShare& c : element.c)
      course.step[slot(c.column)] += c.share * element.law.damping * element.law.way;
  });
  return sum;
}

// The factor that takes `square` down to `most`; 1 if it isn't more.
double factorFor(double square, double most) {
  if (square <= most) return 1;
  return square < std::numeric_limits<double>::infinity() && most > 0 ? std::sqrt(most / square) : 0;
}

// True if u, of this square, had to be scaled down to `most`.
bool scaleDown(double square, double most, std::span<double> u) {
  const double factor = factorFor(square, most);
  if (factor == 1) return false;
  for (double& rate : u) rate = factor > 0 ? factor * rate : 0;
  return true;
}

}  // namespace

void noteMost(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
              std::span<const double> u, double h, TreeCourse& course) {
  std::vector<double>& M = course.stage_factor.entries;
  placeLinks(tree, base.start, q, course.stage);
  fillInertia(tree, course.stage, course.composite, M);
  double most = std::sqrt(squareIn(tree, M, u) + springShare(tree, push, course.stage, q, false, course));
  for (std::size_t c = 0; c < u.size(); ++c) course.step[c] = 0.5 * h * u[c];
  growCoordinates(tree, q, course.step, course.q);
  most += fillImpulses(tree, base, push, q, h, course);
  fillInertia(tree, course.stage, course.composite, M);
  factorise(tree, course.stage_factor);
  double impulse2 = 0;
  course.slope = course.step;
  solve(tree, course.stage_factor, course.slope);
  for (std::size_t c = 0; c < u.size(); ++c) impulse2 += course.step[c] * course.slope[c];
  most += std::sqrt(std::max(impulse2, 0.0));
  course.most = most * most;
}

void limitFreeCourse(const TreeModel& tree, const BaseCourse& base, const TreePush& push, std::span<const double> q,
                     std::span<const double> u, double h, TreeCourse& course) {
  noteMost(tree, base, push, q, u, h, course);
  std::vector<double>& M = course.stage_factor.entries;
  fillInertia(tree, course.stage, course.composite, M);
  scaleDown(squareIn(tree, M, course.u_free), course.most, course.u_free);
  for (std::size_t c = 0; c < u.size(); ++c) course.way_free[c] = 0.5 * h * (u[c] + course.u_free[c]);
}

void limitRates(const TreeModel& tree, const TreeBase& base, const TreePush& push, std::span<const double> q,
                double given, TreeCourse& course, std::span<double> u) {
  std::vector<double>& M = course.stage_factor.entries;
  fillInertia(tree, course.end, course.composite, M);
  const double reach = std::sqrt(course.most) + given,
               most = reach * reach - springShare(tree, push, course.end, q, true, course);
  if (scaleDown(squareIn(tree, M, u), most, u)) moveLinks(tree, base, q, u, course.end);
}

void limitGained(const TreeModel& tree, double given, TreeCourse& course, std::span<double> gained) {
  std::vector<double>& M = course.stage_factor.entries;
  fillInertia(tree, course.mid, course.composite, M);
  for (std::size_t c = 0; c < gained.size(); ++c) course.u[c] = course.u_free[c] + gained[c];
  const double reach = std::sqrt(course.most) + given;
  if (!scaleDown(squareIn(tree, M, course.u), reach * reach, course.u)) return;
  for (std::size_t c = 0; c < gained.size(); ++c) gained[c] = course.u[c] - course.u_free[c];
}

void limitStruck(const TreeModel& tree, std::span<const double> u_before, TreeCourse& course, std::span<double> u) {
  std::vector<double>& M = course.stage_factor.entries;
  fillInertia(tree, course.mid, course.composite, M);
  scaleDown(squareIn(tree, M, u), squareIn(tree, M, u_before), u);
}

}  // namespace pincer::engine
