// sim_text: parts of the text of a simulated scene (run/scene/sim_run.h) that its window's end has in common with it.
#pragma once
#include <string>

#include "pincer/tasks/run/expectation.h"

namespace pincer::tasks {

// A line for each expectation and what came of it; empty if nothing is expected.
std::string expectationsText(const ExpectationLog& log);

}  // namespace pincer::tasks
