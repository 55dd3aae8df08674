#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/view/keys.h"

namespace pincer::tasks {

void addKeysCommand(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("keys", "What keys and mouse do in the window that --view opens (Markdown)");
  command->footer("\nExample:\n  pincer keys");
  command->callback([&exit_code] {
    print("{}", keysMarkdown());
    exit_code = kExitOk;
  });
}

}  // namespace pincer::tasks
