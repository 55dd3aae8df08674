// record_text: measured figures (tasks/run/measure/record.h) as a table for people and as JSON for machines.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/measure/record.h"

namespace pincer::tasks {

// One aligned line per record under a heading; `ok` in green or `FAIL` in red where standard
// output is a terminal and NO_COLOR isn't set.
std::string recordTable(const std::vector<Record>& records);
// An array of objects with all of Record's members; the bound of a figure without a promise is
// null, and so is a value that isn't a number.
std::string recordJson(const std::vector<Record>& records);

}  // namespace pincer::tasks
