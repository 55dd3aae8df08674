// How the subcommands of `pincer mesh` read and write files.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/contact/mesh/mesh_writer.h"
#include "pincer/tasks/app/commands/mesh_commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/run/process/interrupted.h"

namespace pincer::tasks {

CLI::Option* addUnits(CLI::App& command, const std::string& name, std::string& units, const std::string& help) {
  return command.add_option(name, units, help)->check(CLI::IsMember({"m", "cm", "mm", "in"}));
}

void addMeshFile(CLI::App& command, MeshInput& input) {
  command.add_option("file", input.file, "Mesh file (OBJ, STL, PLY or OFF)")->required();
  addUnits(command, "--units", input.units, "Length unit of the file's coordinates")->capture_default_str();
}

namespace {

contact::TriangleMesh readAs(contact::ReadOptions options, const MeshInput& input) {
  constexpr std::int64_t kSteps = 1000;  // of the progress: a file tells a share, progress counts
  Progress progress("reading", kSteps);
  options.metres_per_unit = contact::metresPerUnit(input.units);
  options.progress = [&](double fraction) {
    throwIf(interruptFlag());
    progress.update(static_cast<std::int64_t>(fraction * kSteps));
  };
  return contact::readMesh(input.file, options);
}

}  // namespace

contact::TriangleMesh readWithProgress(const MeshInput& input) { return readAs({}, input); }

FaultyMesh readFaulty(const MeshInput& input) {
  FaultyMesh faulty;
  contact::ReadOptions options;
  options.degenerate = contact::Degenerate::keep;
  options.left_out = [&](const std::string& what) {
    if (faulty.left_out++ == 0) faulty.first_bad = what;
  };
  faulty.mesh = readAs(std::move(options), input);
  return faulty;
}

void writeAndSay(const MeshInput& input, const std::string& out, const contact::TriangleMesh& mesh,
                 const std::string& units) {
  std::error_code no_such_file;
  if (std::filesystem::equivalent(input.file, out, no_such_file)) {
    throw InputError(
        fmt::format("{}: this is the file that was read; it isn't overwritten. Give the result another name.", out));
  }
  throwIf(interruptFlag());
  const contact::WriteOptions options = {.metres_per_unit = contact::metresPerUnit(units)};
  contact::writeMesh(out, mesh, options);
  print("{}: {}, {}, in {}\n", printable(out), counted(static_cast<std::int64_t>(mesh.vertices.size()), "vertex"),
        counted(static_cast<std::int64_t>(mesh.triangles.size()), "triangle"), units);
  for (const std::string& loss : contact::lossesOf(mesh, *contact::formatOfName(out), options))
    print("  - lost: {}\n", loss);
}

}  // namespace pincer::tasks
