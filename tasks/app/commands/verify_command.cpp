#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/measure_command.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

constexpr const char* kVerifyExample = R"(
Runs named scenes whose exact answer is known, and compares: closed forms, or fine integrations of the exact
equations (docs/accuracy.md). Exit code 1 if a bound isn't kept.

Examples:
  pincer verify                     all of it, in about a minute
  pincer verify --only 'pinch/*'    what begins so
  pincer verify --long              where a minute stands for ten, ten
  pincer verify --json              as records)";

}  // namespace

void addVerifyCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MeasureOptions>();
  CLI::App* command = app.add_subcommand("verify", "The accuracy suite: scenes with exact answers");
  addMeasureOptions(*command, *options);
  command->add_flag("--long", options->thorough,
                    "Long versions where there are any: the stack for ten minutes of its time");
  command->footer(kVerifyExample);
  command->callback([options, &exit_code] { exit_code = runMeasurements(verifyMeasurements(), *options, "verify"); });
}

}  // namespace pincer::tasks
