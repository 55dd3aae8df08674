// grasp_text: how well the fingers hold each body, at the end of a run
// (grasp/grasp_quality.h), for a person and for machines.
#pragma once
#include <string>

#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {

// A paragraph per body that a finger presses; says so if there is none.
std::string graspText(const Simulation& simulation);

// "grasps": an object per such body. `json` is within an object.
void writeGrasps(const Simulation& simulation, JsonWriter& json);

}  // namespace pincer::tasks
