#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "tasks/app/app.h"
#include "tasks/app/commands.h"
#include "tasks/app/interrupt.h"
#include "tasks/app/progress.h"
#include "tasks/app/replay.h"

namespace pincer::tasks {
namespace {

constexpr const char* kReplayExample = R"(
Runs the trials of a session with simulated participants again, through the same tick, and compares every kept sample and every trial to the
bit. Exit code 1 when something differs; then the first differing tick is named.

Example:
  pincer replay out/first/session.db --trial 3)";

struct ReplayArguments {
  std::string session;
  std::optional<std::int64_t> trial;
};

int replay(const ReplayArguments& arguments) {
  const SessionReader session(arguments.session);
  std::unique_ptr<Progress> line;
  const ReplayResult result = replaySession(session, arguments.trial, interruptFlag(), [&](std::int64_t done, std::int64_t total) {
    if (!line) line = std::make_unique<Progress>("trials", total);
    line->update(done);
  });
  line.reset();
  if (result.first) {
    const ReplayDifference& d = *result.first;
    fmt::print("Differs first in trial {}, {}: {}\n", d.trial,
               d.tick < 0 ? std::string("its row") : fmt::format("tick {} ({:.3f} s)", d.tick, d.time), d.what);
    return kExitCheckFailed;
  }
  fmt::print("The same to the bit: {} trials, {} samples\n", result.trials, result.samples);
  return interruptFlag() ? kExitInterrupted : kExitOk;
}

}  // namespace

void addReplayCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command = app.add_subcommand("replay", "A session again, compared to the bit");
  command->add_option("session", arguments->session, "Session file")->required();
  command->add_option("--trial", arguments->trial, "Only this trial");
  command->footer(kReplayExample);
  command->callback([arguments, &exit_code] { exit_code = replay(*arguments); });
}

}  // namespace pincer::tasks
