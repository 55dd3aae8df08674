// mjcf: reads a robot from an MJCF file, the format of MuJoCo's models.
//
// Entries of the format that pincer has no use for are counted in the notes (soft contact, solver settings,
// sensors); what would change the robot and isn't known here is refused by name, file and line (mjcf_grammar.h is
// the list). docs/robots.md has all of it in words.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/robot_import.h"

namespace pincer::tasks {

// Files that it names lie in its folder or below, or in one of `allowed_folders`. Throws
// InputError: file, line, element, problem, remedy.
RobotImport readMjcf(const std::string& path, const std::vector<std::string>& allowed_folders = {});

}  // namespace pincer::tasks
