#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/measure_command.h"
#include "pincer/tasks/app/run_options.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/judge/stress/stress.h"

namespace pincer::tasks {
namespace {

constexpr const char* kStressExample = R"(
Random worlds, class by class: what must hold whatever happens is checked in every tick. Exit code 1 if
anything unflagged fails.

Examples:
  pincer stress                                          200 worlds of each class
  pincer stress --seeds 1000                             17,000 worlds in all
  pincer stress --only '*overlap' --seed 17 --seeds 1    one world again)";

struct StressArguments {
  MeasureOptions measure;
  StressOptions stress;
};

}  // namespace

void addStressCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<StressArguments>();
  CLI::App* command = app.add_subcommand("stress", "Random, hostile worlds by seed");
  addMeasureOptions(*command, arguments->measure);
  command->add_option("--seeds", arguments->stress.seeds, "Worlds per class")
      ->check(wholeWithin(1, 100'000'000))
      ->capture_default_str();
  addSeedOption(*command, arguments->stress.first_seed,
                "The first seed; after the last, 18446744073709551615, comes 0");
  command->footer(kStressExample);
  command->callback([arguments, &exit_code] {
    exit_code = runMeasurements(stressMeasurements(arguments->stress), arguments->measure, "stress");
  });
}

}  // namespace pincer::tasks
