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

std::string unknownCommand(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* at = &app;
  std::string path = "pincer";
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const std::vector<const CLI::App*> commands = at->get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty() || word.starts_with('-')) return {};
    const auto same = std::find_if(commands.begin(), commands.end(),
                                   [&](const CLI::App* command) { return command->get_name() == word; });
    if (same == commands.end()) {
      std::vector<std::string_view> names;
      for (const CLI::App* command : commands) names.push_back(command->get_name());
      return fmt::format("\"{}\" isn't a command of {}.{} See `{} --help`.", printable(std::string(word)), path,
                         suggestion(word, names), path);
    }
    at = *same;
    path += fmt::format(" {}", word);
  }
  return {};
}

}  // namespace pincer::tasks
