// man_page: a command's manual page (roff, the macros of man(7)).
#pragma once
#include <string>

#include "pincer/tasks/app/command_tree.h"

namespace pincer::tasks {

std::string manPage(const CommandNode& command, const std::string& version);

// "pincer-mesh-check.1"
std::string manPageName(const CommandNode& command);

}  // namespace pincer::tasks
