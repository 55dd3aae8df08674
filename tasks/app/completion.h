// completion: what a shell offers after the words that were typed: commands,
// options, their choices, built-in scenes, files.
#pragma once
#include <span>
#include <string>

#include "pincer/tasks/app/command_tree.h"

namespace pincer::tasks {

// For bash, to be sourced; zsh sources the same after `bashcompinit`. `scenes` are offered where a command takes one.
std::string bashCompletion(const CommandNode& root, std::span<const std::string> scenes);
std::string zshCompletion(const CommandNode& root, std::span<const std::string> scenes);
std::string fishCompletion(const CommandNode& root, std::span<const std::string> scenes);

}  // namespace pincer::tasks
