// strip_chart: the last seconds of one or more quantities, and the scale to draw them at.
#pragma once
#include <deque>
#include <string>
#include <vector>

namespace pincer::tasks {

class StripChart {
 public:
  static constexpr double kSeconds = 8;  // that the chart shows [s]

  // Keeps the last kSeconds of one quantity per name in `lines`; a name may be empty.
  // `dead`: of a value, less counts as nothing, so that round-off isn't drawn over the whole height [unit].
  StripChart(std::string title, std::string unit, std::vector<std::string> lines, double dead = 0)
      : title_(std::move(title)), unit_(std::move(unit)), lines_(std::move(lines)), dead_(dead) {}

  // Values of all lines at `time` [s]. A time before the last one begins anew: the person has gone back.
  void add(double time, std::vector<double> values);

  struct Point {
    double time;
    std::vector<double> values;
  };
  const std::deque<Point>& points() const { return points_; }
  const std::string& title() const { return title_; }
  const std::string& unit() const { return unit_; }
  const std::vector<std::string>& lines() const { return lines_; }
  // 0 within the dead band
  double last(std::size_t line) const { return points_.empty() ? 0 : points_.back().values[line]; }
  const Point* at(double time) const;  // the last point at or before `time` [s], else the first; null: there is none

  // From zero, or the lowest value rounded down, to the highest rounded up: to 1, 2 or 5 times a power of ten; at least
  // ten dead bands.
  struct Range {
    double low, high;
  };
  Range range() const;

 private:
  std::string title_, unit_;
  std::vector<std::string> lines_;
  double dead_;
  std::deque<Point> points_;
};

}  // namespace pincer::tasks
