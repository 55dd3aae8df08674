#include "pincer/tasks/app/command_tree.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <utility>

namespace pincer::tasks {
namespace {

CommandOption optionOf(const CLI::Option& option) {
  CommandOption found;
  if (option.get_positional()) {
    found.names = {option.get_name(true, false)};
  } else {
    for (const std::string& name : option.get_snames()) found.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) found.names.push_back("--" + name);
  }
  if (option.get_type_size() != 0) {
    const std::string type = option.get_type_name();
    const std::size_t colon = type.find(':');
    found.type = type.substr(0, colon);
    if (colon != type.npos) found.range = type.substr(colon + 1);
    found.fallback = option.get_default_str();
  }
  found.description = option.get_description();
  found.required = option.get_required();
  found.many = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  return found;
}

}  // namespace

std::vector<std::string> CommandOption::choices() const {
  std::vector<std::string> words;
  if (!range.starts_with('{') || !range.ends_with('}')) return words;
  std::istringstream list(range.substr(1, range.size() - 2));
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

CommandNode commandTree(const CLI::App& app, std::vector<std::string> path) {
  CommandNode node{std::move(path), app.get_description(), app.get_footer(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    (option->get_positional() ? node.positionals : node.options).push_back(optionOf(*option));
  }
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    std::vector<std::string> longer = node.path;
    longer.push_back(command->get_name());
    node.commands.push_back(commandTree(*command, std::move(longer)));
  }
  return node;
}

std::vector<const CommandNode*> everyCommand(const CommandNode& root) {
  std::vector<const CommandNode*> all = {&root};
  for (const CommandNode& command : root.commands) {
    const std::vector<const CommandNode*> below = everyCommand(command);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  return fmt::format("{}", fmt::join(words, between));
}

}  // namespace pincer::tasks
