#include "pincer/tasks/app/help_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/spelling.h"

namespace pincer::tasks {

std::string HelpFormat::make_option_name(const CLI::Option* option, bool is_positional) const {
  std::string name = Formatter::make_option_name(option, is_positional);
  for (std::size_t at = 0; (at = name.find('{')) != name.npos;) name.erase(at, name.find('}', at) - at + 1);
  return name;
}

namespace {

std::string unknownCommand(const CLI::App& app, std::string_view word, const std::string& path) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return fmt::format("\"{}\" isn't a command of {}.{} See `{} --help`.", printable(std::string(word)), path,
                     suggestion(word, names), path);
}

// Empty if the word is no long option, or one of the command's.
std::string unknownOption(const CLI::App& app, std::string_view word, const std::string& path) {
  if (!word.starts_with("--") || word == "--") return {};
  const std::string_view name = word.substr(2, word.find('=') - 2);
  std::vector<std::string_view> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& known : option->get_lnames()) names.push_back(known);
  if (std::find(names.begin(), names.end(), name) != names.end()) return {};
  const std::string_view meant = closestWord(name, names);
  return fmt::format("\"--{}\" isn't an option of {}.{} See `{} --help`.", printable(std::string(name)), path,
                     meant.empty() ? "" : fmt::format(" Did you mean \"--{}\"?", meant), path);
}

}  // namespace

std::string unknownWord(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* at = &app;
  std::string path = "pincer";
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--") return {};
    const std::vector<const CLI::App*> commands = at->get_subcommands([](const CLI::App*) { return true; });
    if (!commands.empty() && word.starts_with('-')) return {};
    if (commands.empty()) {
      std::string problem = unknownOption(*at, word, path);
      if (!problem.empty()) return problem;
      continue;
    }
    const auto same = std::find_if(commands.begin(), commands.end(),
                                   [&](const CLI::App* command) { return command->get_name() == word; });
    if (same == commands.end()) return unknownCommand(*at, word, path);
    at = *same;
    path += fmt::format(" {}", word);
  }
  return {};
}

}  // namespace pincer::tasks
