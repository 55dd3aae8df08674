#include "pincer/tasks/judge/bench/engine/work_precision.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/elementary.h"

namespace pincer::tasks {
namespace {

// y at x on the line through (x0, y0) and (x1, y1), all in logarithms.
double betweenLogs(double x, double x0, double y0, double x1, double y1) {
  const double s = math::log(x / x0) / math::log(x1 / x0);
  return y0 * math::pow(y1 / y0, s);
}

}  // namespace

std::vector<WorkPoint> frontierOf(std::vector<WorkPoint> points) {
  std::erase_if(points, [](const WorkPoint& p) {
    return !(p.cost > 0 && p.error > 0 && std::isfinite(p.cost) && std::isfinite(p.error));
  });
  std::sort(points.begin(), points.end(), [](const WorkPoint& a, const WorkPoint& b) {
    return a.cost < b.cost || (a.cost == b.cost && a.error < b.error);
  });
  std::vector<WorkPoint> frontier;
  for (const WorkPoint& p : points) {
    if (frontier.empty() || p.error < frontier.back().error) frontier.push_back(p);
  }
  return frontier;
}

std::optional<double> errorAtCost(const std::vector<WorkPoint>& frontier, double cost) {
  if (frontier.empty() || cost < frontier.front().cost) return std::nullopt;
  for (std::size_t i = 1; i < frontier.size(); ++i) {
    const WorkPoint &a = frontier[i - 1], &b = frontier[i];
    if (cost < b.cost) return betweenLogs(cost, a.cost, a.error, b.cost, b.error);
  }
  return frontier.back().error;
}

std::optional<double> costAtError(const std::vector<WorkPoint>& frontier, double error) {
  if (frontier.empty() || error < frontier.back().error) return std::nullopt;
  if (error >= frontier.front().error) return frontier.front().cost;
  std::size_t i = 1;
  while (frontier[i].error > error) ++i;
  const WorkPoint &a = frontier[i - 1], &b = frontier[i];
  return betweenLogs(error, a.error, a.cost, b.error, b.cost);
}

WorkRatios ratiosAt(const std::vector<WorkPoint>& ours, const WorkPoint& theirs) {
  WorkRatios ratios;
  if (const auto e = errorAtCost(ours, theirs.cost)) ratios.error = *e / theirs.error;
  if (const auto c = costAtError(ours, theirs.error)) ratios.cost = *c / theirs.cost;
  return ratios;
}

}  // namespace pincer::tasks
