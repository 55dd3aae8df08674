// haply_parts: measurements of Haply's Inverse3 that stand in sources of their own.
#pragma once
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

// The program dies while an arm pushes: from the signal to zero at the motors.
std::vector<Record> haplyEnds(MeasureContext& context);

// Mutated messages of the service: what is taken for sound has to be JSON, finite and in range.
std::vector<Record> haplyTexts(MeasureContext& context);

}  // namespace pincer::tasks
