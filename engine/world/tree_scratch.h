// tree_scratch: working memory of a tree in a tick.
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/state.h"
#include "pincer/engine/tree/tree_course.h"

namespace pincer::engine {

struct TreeScratch {
  explicit TreeScratch(const TreeModel& tree);

  BaseCourse base;
  std::vector<DriveTick> drives;  // of this part of the tick
  std::vector<LinkForce> forces;  // applied to links
  std::vector<double> constant;   // forces of joints that slide against dry friction, by coordinates
  TreeCourse course;
  // Contacts' impulses and the rates that they change, by columns.
  std::vector<double> impulse, gained;
  bool touched = false, closing = false;  // some contact pushes on a link or a joint; one of those closes in this tick
  double rest_speed = 0;                  // see MoverScratch
  // Columns that dry friction holds without a row (joint_rows.h), and if there are any; columns that
  // bodies' contacts push; impulses that hold.
  std::vector<char> locked, pressed;
  bool has_locked = false;
  std::vector<double> held;
  bool is_near = false;      // some contact of a link or a stop was looked at, whether it pushes or not
  bool was_pressed = false;  // something pushed on a link or a joint in the last part of a tick
  // By links, of a tree that was pressed: what contacts may be expected to give in this part; if that is known.
  std::vector<LinkForce> expected;
  bool is_expected = false;
  bool rests = false;  // nothing of it changed in this part of the tick
  // Between uses.
  std::vector<double> row, q, old_free, old_way;
};

// A tree's share of the state.
inline std::span<const double> treeCoordinates(const TreeModel& tree, const WorldState& state) {
  return std::span(state.tree_q)
      .subspan(static_cast<std::size_t>(tree.first_q), static_cast<std::size_t>(tree.q_count));
}
inline std::span<const double> treeRates(const TreeModel& tree, const WorldState& state) {
  return std::span(state.tree_v).subspan(static_cast<std::size_t>(tree.first_v), tree.before.size());
}
inline std::span<double> treeCoordinates(const TreeModel& tree, WorldState& state) {
  return std::span(state.tree_q)
      .subspan(static_cast<std::size_t>(tree.first_q), static_cast<std::size_t>(tree.q_count));
}
inline std::span<double> treeRates(const TreeModel& tree, WorldState& state) {
  return std::span(state.tree_v).subspan(static_cast<std::size_t>(tree.first_v), tree.before.size());
}

}  // namespace pincer::engine
