#include <CLI/CLI.hpp>
#include <array>

#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/run_tasks.h"

namespace pincer::tasks {
namespace {

// The experiments, in the order in which --help shows them.
constexpr std::array kRunTasks = {addManipulationTask, addSpherePickupTask, addCylinderAlignmentTask,
                                  addSmoothnessTask,   addShapeTask,        addLocalisationTask,
                                  addBacklashTask,     addDelayTask,        addFindingsTask};

constexpr const char* kRunExample = R"(
A simulated participant on simulated arms and contact location displays does the experiment; trials, events
and samples are kept in DIR/session.db, a page with plots in DIR/report.html. Each experiment has its own
options: pincer run EXPERIMENT --help

Example:
  pincer run sphere-pickup --repetitions 2 --seed 7 --out out/first)";

}  // namespace

void addRunCommand(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", "An experiment, with a simulated participant");
  command->require_subcommand(1);
  for (const auto add : kRunTasks) add(*command, exit_code);
  command->footer(kRunExample);
}

}  // namespace pincer::tasks
