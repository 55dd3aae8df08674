// plan_joints: a plan's trees of joints, what drives them and what the tick leaves out of them, in words.
#pragma once
#include <vector>

#include "pincer/tasks/app/plan_text.h"

namespace pincer::tasks {

void describeTrees(const engine::WorldModel& world, std::vector<PlanLine>& lines);

}  // namespace pincer::tasks
