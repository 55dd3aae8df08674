// command_tree: what commands the program has and what they take, as its own --help tells: an
// option that is added is covered by itself.
#pragma once
#include <string>
#include <vector>

#include "pincer/tests/campaign/row.h"

namespace pincer::campaign {

struct Option {
  std::string name;  // "--seed"
  std::string type;  // "UINT", "TEXT:{a,b}"; empty: a flag
  bool required = false;
};

struct Command {
  std::vector<std::string> words;  // "mesh", "info"
  std::vector<Option> options;
  std::vector<Option> positionals;  // `name` without dashes
};

// Commands that can be run, without groups that only hold others.
std::vector<Command> commandsOf(const Ground& ground);

// Arguments with which the command runs, and shortly, as far as its options allow it; files are of ground.inputs().
std::vector<std::string> soundArguments(const Ground& ground, const Command& command);

}  // namespace pincer::campaign
