// joint_row_parts: what stops, brakes and drives have in common (joint_rows.h).
#pragma once
#include "pincer/engine/state.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// most of w h F: what a brake can hold doesn't count among the problem's speeds [m/s, rad/s]
constexpr double kGripSpeed = 1;

inline const TreeModel& treeOf(const WorldModel& model, const JointRowScratch& row) { return model.trees[row.tree]; }
inline std::uint64_t idOfRow(int slot) { return std::uint64_t{2} << 62 | static_cast<std::uint64_t>(slot) << 32; }

// A coordinate's rate when the columns go at `u`, and that of a drive's length.
inline double rateOf(const TreeModel& tree, const TreePlace& place, int coordinate, std::span<const double> u) {
  return place.coordinates[coordinate].share * u[tree.coordinates[coordinate].column];
}
inline double lengthRate(const TreeModel& tree, const TreePlace& place, const TreeDrive& drive,
                         std::span<const double> u) {
  double rate = 0;
  for (const TreeDrive::Term& term : drive.terms) rate += term.factor * rateOf(tree, place, term.coordinate, u);
  return rate;
}
// A coordinate's rate at the end of the tick, contacts included.
inline double endRate(const TreeModel& tree, const TreeScratch& s, int coordinate) {
  const int column = tree.coordinates[coordinate].column;
  return s.course.mid.coordinates[coordinate].share * (s.course.u_free[column] + s.gained[column]);
}

// Rate that a unit impulse along the row gives it.
double mobilityOf(const WorldModel& model, const JointRowScratch& row, TreeScratch& s);

// Puts a row among the contacts; null if there is no room.
Contact* addRow(double phi, int slot, const JointRowScratch& row, WorldScratch& scratch);

}  // namespace pincer::engine
