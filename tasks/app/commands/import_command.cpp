#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/run/robot/import_report.h"
#include "pincer/tasks/run/robot/robot_scene.h"

namespace pincer::tasks {
namespace {

constexpr const char* kImportExample = R"(
Prints a robot's file, MJCF or URDF, as a scene (docs/robots.md), and says on standard error what of the file has no
effect here. Files that it names lie in its folder or below; --allow names further folders.

Examples:
  pincer import hand.xml > hand.json
  pincer import hand.xml --keyframe home --report text
  pincer import arm.urdf > arm.json)";

struct ImportArguments {
  std::string file, report;
  RobotSceneOptions options;
  std::vector<std::string> allowed;
};

int runImport(const ImportArguments& arguments) {
  RobotImport import = readRobotFile(arguments.file, arguments.allowed);
  if (arguments.report == "json") {
    print("{}", importJson(import));
    return kExitOk;
  }
  const std::string scene = sceneOfRobot(import.robot, arguments.options, import.notes);
  if (arguments.report == "text") {
    print("{}", importText(import));
    return kExitOk;
  }
  print("{}", scene);
  print(stderr, "{}", importText(import));
  return kExitOk;
}

}  // namespace

void addImportCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = app.add_subcommand("import", "A robot's MJCF or URDF file as a scene");
  command->add_option("file", arguments->file, "Robot (MJCF, .xml, or URDF, .urdf)")->required();
  command->add_option("--keyframe", arguments->options.keyframe,
                      "Where it starts and what its drives are told; else as drawn");
  command->add_option("--allow", arguments->allowed, "Further folders that its files may lie in")
      ->allow_extra_args(false);
  command
      ->add_option("--report", arguments->report,
                   "Print this instead of the scene: text, or json with masses and places")
      ->check(CLI::IsMember({"text", "json"}));
  command->footer(kImportExample);
  command->callback([arguments, &exit_code] { exit_code = runImport(*arguments); });
}

}  // namespace pincer::tasks
