// session_conditions: the conditions of a session as its protocol names them, for whoever shows or exports it.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

// The name of each, as tables have it, and its label for people.
using ConditionLabels = std::vector<std::pair<std::string, std::string>>;

// In the protocol's order; none where it names none or can't be read. A condition without a label has the published
// one, or its name.
ConditionLabels conditionLabels(const SessionInfo& info);

// Of a condition that no protocol labels: what the published design calls it, else its name.
std::string publishedLabel(const std::string& condition);

}  // namespace pincer::tasks
