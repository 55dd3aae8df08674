// plan_text: what a model's plan is, in words: which bodies, pairs and fingers there are
// and in which specialised form each runs.
#pragma once
#include <string>
#include <vector>

#include "pincer/grasp/baseline.h"

namespace pincer::tasks {

// One thing that runs in a tick, or that the plan leaves out.
struct PlanLine {
  std::string part;  // "body", "pair", "tree", "joint", "drive", "finger", "skipped"
  std::string name;  // "sphere", "left - sphere"
  std::string form;  // "free rotation: spherical, exact", ...
};

// `methods`: by which its fingers are rendered.
std::vector<PlanLine> describePlan(const grasp::GraspModel& model, const std::vector<grasp::FingerMethod>& methods);

std::string nameOf(const contact::Shape& shape);  // "sphere r 20 mm"

}  // namespace pincer::tasks
