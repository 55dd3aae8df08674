// expectation_text: what was expected and what came of it, as a sentence for a person.
#pragma once
#include <string>

#include "pincer/tasks/run/expectation.h"

namespace pincer::tasks {

// "ball.p_z at 1 s == 0.02 +- 1e-06 m: measured 0.021, off by 0.001"
std::string outcomeText(const Expectation& expected, const Outcome& outcome);

}  // namespace pincer::tasks
