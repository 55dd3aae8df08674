#include "pincer/tasks/run/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/io/input_file.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/scene/scene_ranges.h"

namespace pincer::tasks {
namespace {

TimedPoint minimumJerk(const TimedPoint& from, const TimedPoint& to, double time) {
  const double span = to.time - from.time;
  const double s = (time - from.time) / span;
  const Vec3 way = to.p_W - from.p_W;
  const double path = s * s * s * (10 + s * (-15 + 6 * s));
  const double slope = s * s * (30 + s * (-60 + 30 * s));
  return {time, from.p_W + path * way, (slope / span) * way};
}

// Cubic Hermite interpolation.
TimedPoint cubic(const TimedPoint& from, const TimedPoint& to, double time) {
  const double span = to.time - from.time;
  const double s = (time - from.time) / span;
  const Vec3 slope = (to.p_W - from.p_W) / span;
  const Vec3 c2 = 3 * slope - 2 * from.v_W - to.v_W;
  const Vec3 c3 = from.v_W + to.v_W - 2 * slope;
  return {time, from.p_W + span * s * (from.v_W + s * (c2 + s * c3)), from.v_W + s * (2 * c2 + 3 * s * c3)};
}

Vec3 slopeBetween(const TimedPoint& a, const TimedPoint& b) { return (b.p_W - a.p_W) / (b.time - a.time); }

// Slope at b of the parabola through a, b and c.
Vec3 slopeOfParabola(const TimedPoint& a, const TimedPoint& b, const TimedPoint& c) {
  const double left = b.time - a.time;
  const double right = c.time - b.time;
  return (right * slopeBetween(a, b) + left * slopeBetween(b, c)) / (left + right);
}

void setVelocities(std::vector<TimedPoint>& points) {
  const std::size_t last = points.size() - 1;
  if (last == 0) return;
  for (std::size_t i = 1; i < last; ++i) points[i].v_W = slopeOfParabola(points[i - 1], points[i], points[i + 1]);
  points[0].v_W = slopeBetween(points[0], points[1]);
  points[last].v_W = slopeBetween(points[last - 1], points[last]);
}

// A recorded motion may have begun before the scene.
constexpr NumberRule kSampleTime = {
    .min = -ranges::kLongestDuration, .max = ranges::kLongestDuration, .remedy = "Times are in seconds."};

struct CsvPlace {
  const std::string& path;
  int line;

  [[noreturn]] void reject(const std::string& problem) const {
    throw InputError(fmt::format("{}:{}: {}", path, line, problem));
  }
};

double parseField(std::string_view field, const CsvPlace& place, const NumberRule& rule) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
    place.reject(
        fmt::format("\"{}\" isn't a finite number. Each row is time,x,y,z in seconds and metres.", printable(field)));
  }
  if (!isWithin(value, rule)) place.reject(fmt::format("{} {}", printable(field), outOfRange(rule)));
  return value;
}

TimedPoint parseRow(std::string_view row, const CsvPlace& place) {
  std::array<double, 4> values{};
  std::size_t count = 0;
  for (std::size_t begin = 0; begin <= row.size(); ++count) {
    const std::size_t end = std::min(row.find(',', begin), row.size());
    if (count < values.size())
      values[count] = parseField(row.substr(begin, end - begin), place, count == 0 ? kSampleTime : ranges::kCoordinate);
    begin = end + 1;
  }
  if (count != values.size()) place.reject(fmt::format("has {} columns, but four are needed: time,x,y,z.", count));
  return {values[0], {values[1], values[2], values[3]}, Vec3::Zero()};
}

}  // namespace

Trajectory Trajectory::throughKeyframes(std::vector<TimedPoint> keyframes) {
  PINCER_DEMAND(!keyframes.empty(), "throughKeyframes: one point at least");
  PINCER_ASSERT(isAscending(keyframes, &TimedPoint::time));
  Trajectory trajectory;
  trajectory.points_ = std::move(keyframes);
  return trajectory;
}

Trajectory Trajectory::throughSamples(std::vector<TimedPoint> samples) {
  PINCER_DEMAND(!samples.empty(), "throughSamples: one point at least");
  PINCER_ASSERT(isAscending(samples, &TimedPoint::time));
  Trajectory trajectory;
  trajectory.points_ = std::move(samples);
  trajectory.minimum_jerk_ = false;
  setVelocities(trajectory.points_);
  return trajectory;
}

TimedPoint Trajectory::at(double time) const {
  const auto after =
      std::upper_bound(points_.begin(), points_.end(), time, [](double t, const TimedPoint& p) { return t < p.time; });
  if (after == points_.begin()) return {time, points_.front().p_W, Vec3::Zero()};
  if (after == points_.end()) return {time, points_.back().p_W, Vec3::Zero()};
  return minimum_jerk_ ? minimumJerk(*(after - 1), *after, time) : cubic(*(after - 1), *after, time);
}

std::string problemBetween(const TimedPoint& from, const TimedPoint& to, double fastest) {
  const double span = to.time - from.time, way = (to.p_W - from.p_W).norm();
  constexpr double kShortestSpan = 1e-6;  // [s]: a tenth of the shortest tick
  if (!(span > 0))
    return fmt::format("time {} doesn't follow {}. Times must increase from one point to the next.", to.time,
                       from.time);
  if (span < kShortestSpan)
    return fmt::format("time {} follows {} by {:g} s; at least {:g} s are needed.", to.time, from.time, span,
                       kShortestSpan);
  if (way <= fastest * span) return "";
  return fmt::format(
      "from time {} to {} it would go {:g} in {:g} s, faster than {:g} per second. Are time and place in seconds, "
      "metres and radians?",
      from.time, to.time, way, span, fastest);
}

Trajectory readTrajectoryCsv(const std::string& path) {
  InputFile file(path, kTrajectoryFile);
  CsvPlace place{path, 1};
  std::string_view line;
  if (!file.nextLine(line) || line != "time,x,y,z")
    place.reject(fmt::format("the header is \"{}\", but must be \"time,x,y,z\".", printable(line)));
  std::vector<TimedPoint> samples;
  while (file.nextLine(line)) {
    ++place.line;
    samples.push_back(parseRow(line, place));
    const std::size_t n = samples.size();
    const std::string problem = n > 1 ? problemBetween(samples[n - 2], samples[n - 1], ranges::kFastest) : "";
    if (!problem.empty()) place.reject(problem);
  }
  if (samples.empty()) place.reject("there is no row below the header.");
  return Trajectory::throughSamples(std::move(samples));
}

}  // namespace pincer::tasks
