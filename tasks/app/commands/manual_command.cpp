#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/command_tree.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/completion.h"
#include "pincer/tasks/app/man_page.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/session/build_info.h"

namespace pincer::tasks {
namespace {

constexpr const char* kManualExample = R"(
Writes a page per command, pincer.1, pincer-sim.1, ..., for man(1). The Debian package brings them.

Example:
  pincer manual --out man1)";

constexpr const char* kCompletionExample = R"(
Prints what a shell sources to complete pincer's commands, options and scenes at the Tab key. The Debian
package brings it.

Example:
  pincer completion bash > pincer-completion.sh)";

int writeManual(const CLI::App& program, const std::string& directory) {
  makeDirectory(directory);
  const CommandNode root = commandTree(program, {"pincer"});
  const std::vector<const CommandNode*> commands = everyCommand(root);
  for (const CommandNode* command : commands) {
    writeAtomically((std::filesystem::path(directory) / manPageName(*command)).string(),
                    manPage(*command, kBuildInfo.version));
  }
  print("{}: {}\n", printablePath(directory), counted(static_cast<std::int64_t>(commands.size()), "page"));
  return kExitOk;
}

int printCompletion(const CLI::App& program, const std::string& shell) {
  const CommandNode root = commandTree(program, {"pincer"});
  std::vector<std::string> scenes;
  for (const BuiltinScene& scene : builtinScenes()) scenes.emplace_back(scene.name);
  const auto write = shell == "bash" ? bashCompletion : shell == "zsh" ? zshCompletion : fishCompletion;
  print("{}", write(root, scenes));
  return kExitOk;
}

}  // namespace

void addManualCommand(CLI::App& app, int& exit_code) {
  auto directory = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("manual", "Manual pages of all commands");
  command->add_option("--out", *directory, "Directory for the pages")->required();
  command->footer(kManualExample);
  command->callback([&app, directory, &exit_code] { exit_code = writeManual(app, *directory); });
}

void addCompletionCommand(CLI::App& app, int& exit_code) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Completion of commands, options and scenes for a shell");
  command->add_option("shell", *shell, "Which shell")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(kCompletionExample);
  command->callback([&app, shell, &exit_code] { exit_code = printCompletion(app, *shell); });
}

}  // namespace pincer::tasks
