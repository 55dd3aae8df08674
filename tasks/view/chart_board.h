// chart_board: the quantities that charts show over time; a digit key each (docs/keys.md).
//
//   1 normal force of each finger [N]     2 height of the followed body over its start [mm]   3 time of a tick [us]
//   4 speed of the body [mm/s]            5 its turn since the start [deg]                    6 its place, x y z [mm]
//   7 force of all its contacts [N]       8 share of friction that a finger uses, tangential force / (mu normal) [-]
//
// Forces on the body are those on it; a sum of sizes, so that a squeeze counts. Speeds are differences of two
// snapshots.
#pragma once
#include <array>
#include <optional>

#include "pincer/tasks/run/tick/snapshot.h"
#include "pincer/tasks/view/strip_chart.h"

namespace pincer::tasks {

class ChartBoard {
 public:
  static constexpr std::size_t kQuantities = 8;  // a key each, 1 to 8

  // Shows the first three of those that there are. `start` says where bodies were at first; `fingers` are their names.
  ChartBoard(const Snapshot& start, const std::vector<std::string>& fingers);

  // From now on of this body; what was charted of another is forgotten.
  void follow(int body, const std::string& name);
  void add(const Snapshot& snapshot);
  // Shows it, or no longer. Returns false if there is none: no finger, no body.
  bool toggle(std::size_t quantity);
  std::vector<const StripChart*> shown() const;
  double seconds() const { return StripChart::kSeconds; }

 private:
  struct Entry {
    std::optional<StripChart> chart;  // absent: there is nothing to chart
    bool shown = false;
  };
  void makeChart(std::size_t quantity, const std::string& of, std::vector<std::string> lines);
  std::vector<double> valuesOf(std::size_t quantity, const Snapshot& snapshot) const;
  Vec3 offset_W(const Snapshot& snapshot) const;  // of the body from its start [m]

  std::array<Entry, kQuantities> entries_;
  std::vector<Pose> start_X_WB_;
  int body_ = -1;
  std::optional<double> before_;  // the snapshot before: its time [s]
  Vec3 before_p_W_ = Vec3::Zero();
};

}  // namespace pincer::tasks
