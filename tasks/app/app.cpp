#include "pincer/tasks/app/app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/devices/window/surface.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/help_format.h"
#include "pincer/tasks/app/process.h"
#include "pincer/tasks/run/process/interrupted.h"
#include "pincer/tasks/run/servo/hand_devices.h"
#include "pincer/tasks/run/session/build_info.h"

namespace pincer::tasks {
namespace {

struct CommandEntry {
  const char* group;
  void (*add)(CLI::App& app, int& exit_code);
};

// Headings of the groups of commands in --help.
constexpr const char* kExperiments = "Commands for experiments and sessions";
constexpr const char* kPhysics = "Commands for physics";
constexpr const char* kJudges = "Commands that judge pincer";
constexpr const char* kThings = "Commands for meshes and devices";
constexpr const char* kTexts = "Commands that tell about pincer";

// The program's table of contents, in the order in which --help shows it.
constexpr CommandEntry kCommands[] = {
    {kExperiments, addRunCommand},    {kExperiments, addReportCommand}, {kExperiments, addExportCommand},
    {kExperiments, addReplayCommand}, {kExperiments, addShareCommand},  {kExperiments, addSweepCommand},
    {kPhysics, addSimCommand},        {kPhysics, addTestCommand},       {kPhysics, addPlanCommand},
    {kPhysics, addImportCommand},     {kPhysics, addSolveCommand},      {kJudges, addVerifyCommand},
    {kJudges, addStressCommand},      {kJudges, addBenchCommand},       {kThings, addMeshCommand},
    {kThings, addDevicesCommand},     {kTexts, addKeysCommand},         {kTexts, addSchemaCommand},
    {kTexts, addManualCommand},       {kTexts, addCompletionCommand}};

// Stands below the commands in --help.
constexpr const char* kExamples = R"(
Examples:
  pincer run sphere-pickup --out out/first               a simulated participant picks up spheres
  pincer report out/first/session.db                     the session as a table and a page with plots
  pincer share pickup --out pickup.html                  a scene or session as a page that any browser plays
  pincer sim tasks/scenes/s4_pinch.json                  plain physics of a scene, its expectations checked
  pincer plan tasks/scenes/s4_pinch.json                 what runs in a tick, and what it costs
  pincer bench contact                                   what touching a mesh costs and how well it is felt
  pincer mesh info bunny.obj --units m                   what a mesh is, and what is wrong with it

Exit codes: 0 ok, 1 a check failed, 2 usage, 3 bad input, 4 device, 5 interrupted.)";

// Printed text may have gone to a full disk or a closed pipe.
int flushed(int exit_code) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return exit_code;
  complain(
      "standard output can't be written: what was printed there isn't whole. Is the disk full, or has its reader "
      "ended?");
  return exit_code == kExitOk ? kExitBadInput : exit_code;
}

// "pincer mesh info": as far as the command line named commands.
std::string commandOf(const CLI::App& app) {
  std::string words = app.get_name();
  for (std::vector<CLI::App*> named = app.get_subcommands(); !named.empty(); named = named.front()->get_subcommands())
    words += " " + named.front()->get_name();
  return words;
}

int reportUsage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return flushed(app.exit(error));  // --help, --version
  complain(fmt::format("{}. See `{} --help`.", printableMessage(error.what()), commandOf(app)));
  return kExitUsage;
}

int run(int argc, char** argv) {
  CLI::App app("pincer: multi-finger manipulation physics", "pincer");
  app.set_version_flag("--version", versionText());
  app.footer(kExamples);
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormat>());
  // --json=2 is a mistake; of --json=99999999999999999999 CLI11 makes an out_of_range
  app.option_defaults()->disable_flag_override();
  int exit_code = kExitOk;
  for (const CommandEntry& command : kCommands) {
    command.add(app, exit_code);
    app.get_subcommands([](const CLI::App*) { return true; }).back()->group(command.group);
  }
  if (const std::string problem = unknownWord(app, argc, argv); !problem.empty()) {
    complain(problem);
    return kExitUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return reportUsage(app, error);
  }
  return flushed(exit_code);
}

}  // namespace

int runApp(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    complain(kNotEnoughMemory);
    return kExitBadInput;
  } catch (const Interrupted&) {
    complain("interrupted. What was whole by then is kept, the rest is removed.");
    return kExitInterrupted;
  } catch (const devices::DisplayError& error) {
    complain(printableMessage(error.what()));
    return kExitDevice;
  } catch (const DeviceError& error) {
    complain(printableMessage(error.what()));
    return kExitDevice;
  } catch (const std::exception& error) {  // InputError; and what the system refuses, such as a thread
    complain(printableMessage(error.what()));
    return kExitBadInput;
  }
}

}  // namespace pincer::tasks
