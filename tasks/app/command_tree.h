// command_tree: the command line as data, read from its own definition: for manual pages and completions.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pincer::tasks {

struct CommandOption {
  std::vector<std::string> names;  // "-o", "--out"; of a positional its name
  std::string type;                // "FLOAT", "TEXT"; empty: a flag, which takes no value
  std::string range;               // "in (0, inf)", "{scene,mouse}"; empty: any
  std::string fallback;            // that it has by default; empty: none is told
  std::string description;
  bool required = false, many = false;
  std::vector<std::string> choices() const;  // of a range in braces
};

struct CommandNode {
  std::vector<std::string> path;  // {"pincer", "mesh", "check"}
  std::string description, details;
  std::vector<CommandOption> positionals, options;
  std::vector<CommandNode> commands;
};

// `app` is the program or a command of it, `path` its name and those above.
CommandNode commandTree(const CLI::App& app, std::vector<std::string> path);

// The node and all below it, from above.
std::vector<const CommandNode*> everyCommand(const CommandNode& root);

// The path, parted by `between`.
std::string joined(const std::vector<std::string>& words, const std::string& between);

}  // namespace pincer::tasks
