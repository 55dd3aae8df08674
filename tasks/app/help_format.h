// help_format: how --help looks, and what is said of a command or an option that there isn't.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace pincer::tasks {

// CLI11's own, without the values of flags that switch something off: "--no-keys", not "--no-keys{false}".
class HelpFormat final : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override;
};

// A sentence about the first word that should be a command, or a long option, and isn't one; empty if there is none.
std::string unknownWord(const CLI::App& app, int argc, const char* const* argv);

}  // namespace pincer::tasks
