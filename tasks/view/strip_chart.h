// strip_chart: the last seconds of one or more quantities, and the scale to draw them at.
#pragma once
#include <deque>
#include <string>
#include <vector>

namespace pincer::tasks {

class StripChart {
 public:
  // Keeps the last `seconds` of `lines` quantities.
  // `dead`: of a value, less counts as nothing, so that round-off isn't drawn over the whole height [unit].
  StripChart(std::string title, std::string unit, std::size_t lines, double dead = 0, double seconds = 8)
      : title_(std::move(title)), unit_(std::move(unit)), lines_(lines), dead_(dead), seconds_(seconds) {}

  // Values of all lines at `time` [s]. A time before the last one begins anew: the person has gone back.
  void add(double time, std::vector<double> values);

  struct Point {
    double time;
    std::vector<double> values;
  };
  const std::deque<Point>& points() const { return points_; }
  const std::string& title() const { return title_; }
  const std::string& unit() const { return unit_; }
  std::size_t lines() const { return lines_; }
  double seconds() const { return seconds_; }
  double last(std::size_t line) const { return points_.empty() ? 0 : points_.back().values[line]; }  // 0 within the dead band

  // From zero, or the lowest value rounded down, to the highest rounded up: to 1, 2 or 5 times a power of ten; at least ten dead bands.
  struct Range {
    double low, high;
  };
  Range range() const;

 private:
  std::string title_, unit_;
  std::size_t lines_;
  double dead_, seconds_;
  std::deque<Point> points_;
};

}  // namespace pincer::tasks
