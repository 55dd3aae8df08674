// tree_elements: springs, dampers and drives of a tree at one place of it, and the forces that stay all through a tick.
#pragma once
#include <algorithm>

#include "pincer/engine/tree/slot.h"
#include "pincer/engine/tree/tree_course.h"

namespace pincer::engine {

// A spring, a damper or a drive at one place of the tree.
struct Element {
  std::span<const ColumnShare> c;  // how its length changes with the columns
  double l = 0;
  const DriveTick& law;
};

// f(element, course) of each spring and damper of a joint, then of each drive, but of
// those that are a constant force at most.
template <class F>
void forEachElement(const TreeModel& tree, const TreePush& push, const TreePlace& place, std::span<const double> q,
                    TreeCourse& course, F f) {
  for (std::size_t i = 0; i < tree.coordinates.size(); ++i) {
    const TreeCoordinate& own = tree.coordinates[i];
    if (!(own.damping > 0 || own.traits.stiffness > 0)) continue;
    const ColumnShare share{own.column, place.coordinates[i].share};
    const DriveTick law{.stiffness = own.traits.stiffness, .damping = own.damping, .target = own.traits.rest};
    f(Element{std::span(&share, 1), own.q < 0 ? 0 : q[slot(own.q)], law}, course.springs[i]);
  }
  for (std::size_t d = 0; d < tree.drives.size(); ++d) {
    if (!(push.drives[d].stiffness > 0 || push.drives[d].damping > 0)) continue;
    columnShares(tree, place, tree.drives[d], course.shares);
    f(Element{course.shares, lengthOf(tree, tree.drives[d], q), push.drives[d]}, course.drives[d]);
  }
}

// The forces that stay, by columns: they need no law.
inline void fillConstantForces(const TreeModel& tree, const TreePush& push, const TreePlace& place, TreeCourse& course,
                               std::vector<double>& force) {
  std::fill(force.begin(), force.end(), 0.0);
  for (std::size_t i = 0; i < push.constant.size(); ++i)
    force[slot(tree.coordinates[i].column)] += place.coordinates[i].share * push.constant[i];
  for (std::size_t d = 0; d < tree.drives.size(); ++d) {
    if (push.drives[d].force == 0) continue;
    columnShares(tree, place, tree.drives[d], course.shares);
    for (const ColumnShare& c : course.shares) force[slot(c.column)] += c.share * push.drives[d].force;
  }
}

inline double along(std::span<const ColumnShare> c, std::span<const double> u) {
  double rate = 0;
  for (const ColumnShare& share : c) rate += share.share * u[slot(share.column)];
  return rate;
}

}  // namespace pincer::engine
