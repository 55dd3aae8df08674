// work_precision: what accuracy costs, from runs of several engines at several steps.
//
//   frontier    of points (c, e): those with which no other is both as cheap and as accurate. c: cost,
//               us of processor time per simulated second; e: error. Between two of its points log e
//               is linear in log c; it isn't extrapolated
//   e(c), c(e)  the frontier's error at a cost, and its cost at an error
//
// Of two frontiers, ours and theirs, at their point (c, e): the ratios e_ours(c)/e and c_ours(e)/c.
// Source: E. Hairer, S. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
// ed., 1993, II.10 (work-precision diagrams).
#pragma once
#include <optional>
#include <vector>

namespace pincer::tasks {

struct WorkPoint {
  double cost = 0;   // > 0
  double error = 0;  // > 0
};

// Ascending in cost, descending in error. Points that aren't finite and positive are left out.
std::vector<WorkPoint> frontierOf(std::vector<WorkPoint> points);

// nullopt where every point costs more than `cost`; beyond the dearest point, its error.
std::optional<double> errorAtCost(const std::vector<WorkPoint>& frontier, double cost);

// nullopt where every point errs more than `error`; coarser than the cheapest point, its cost.
std::optional<double> costAtError(const std::vector<WorkPoint>& frontier, double error);

struct WorkRatios {
  std::optional<double> error;  // of ours over theirs at equal cost
  std::optional<double> cost;   // of ours over theirs at equal error
};
WorkRatios ratiosAt(const std::vector<WorkPoint>& ours, const WorkPoint& theirs);

}  // namespace pincer::tasks
