#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/mesh_commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/scene/scene_ranges.h"

namespace pincer::tasks {
namespace {

constexpr const char* kMeshConvertExample = R"(
The formats are told from the names: OBJ, STL, PLY, OFF. With --repair every change is printed; a sound mesh
comes out as it went in. What is left to mend by hand is printed last; if that makes the mesh unfit for
grasping, the exit code is 1 although the file is written.

Examples:
  pincer mesh convert scan.stl scan.obj --units mm --to-units m --repair
  pincer mesh convert bunny.obj closed.ply --repair --fill-holes 100 --size 0.08)";

struct ConvertArguments {
  MeshInput input;
  std::string out;
  std::string to_units;
  double size = 0;  // [m], 0: as it is
  bool repair = false;
  double weld = 0;  // [mm]
  int fill_holes = 0;
};

void scaleToSize(double size, contact::TriangleMesh& mesh) {
  const contact::MeshReport report = contact::inspect(mesh);
  const double largest = (report.box_max - report.box_min).maxCoeff();
  if (!(largest > 0))
    throw InputError(fmt::format("{}: all its points coincide: it has no size. Export it again.", mesh.source));
  for (Vec3& vertex : mesh.vertices) vertex *= size / largest;
}

contact::TriangleMesh readForRepair(const MeshInput& input) {
  FaultyMesh read = readFaulty(input);
  if (read.left_out > 0)
    print("  * left-out-faces: left out {}; the first: {}\n", counted(read.left_out, "face"),
          printable(read.first_bad));
  return std::move(read.mesh);
}

contact::TriangleMesh repaired(contact::TriangleMesh mesh, const ConvertArguments& arguments) {
  contact::RepairedMesh result = contact::repair(
      std::move(mesh), {.weld = kMetresPerMillimetre * arguments.weld, .fill_holes = arguments.fill_holes});
  for (const contact::MeshChange& change : result.changes) print("  * {}: {}\n", change.name, change.text);
  if (result.changes.empty()) print("  nothing to repair\n");
  return std::move(result.mesh);
}

// False if a repair was asked for and something is left that makes the mesh unfit.
bool convert(const ConvertArguments& arguments) {
  print("{}\n", printable(arguments.input.file));
  contact::TriangleMesh mesh = arguments.repair ? readForRepair(arguments.input) : readWithProgress(arguments.input);
  if (arguments.size > 0) scaleToSize(arguments.size, mesh);
  if (arguments.repair) mesh = repaired(std::move(mesh), arguments);
  const std::string units = arguments.to_units.empty() ? arguments.input.units : arguments.to_units;
  writeAndSay(arguments.input, arguments.out, mesh, units);
  const contact::MeshReport report =
      contact::inspect(mesh, {.metres_per_unit = contact::metresPerUnit(arguments.input.units)});
  print("{}", findingsText(report.findings));
  return !arguments.repair || report.isFit();
}

}  // namespace

void addMeshConvert(CLI::App& mesh, int& exit_code) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = mesh.add_subcommand("convert", "Another format, unit or size; repairs");
  addMeshFile(*command, arguments->input);
  command->add_option("out", arguments->out, "File to write (.obj, .stl, .ply or .off)")->required();
  addUnits(*command, "--to-units", arguments->to_units, "Length unit to write (default: as read)");
  command->add_option("--size", arguments->size, "Scale it so that its largest dimension is this [m]")
      ->check(within(ranges::kLength));
  auto* repair =
      command->add_flag("--repair", arguments->repair, "Mend what can be mended without guessing at the shape");
  command->add_option("--weld", arguments->weld, "With --repair: make vertices on open edges one that are so near [mm]")
      ->check(within({.min = 0, .max = 1e3, .remedy = "In millimetres."}))
      ->needs(repair);
  command
      ->add_option("--fill-holes", arguments->fill_holes,
                   "With --repair: close nearly flat holes of at most so many edges")
      ->check(wholeWithin(0, 1000))
      ->needs(repair);
  command->footer(kMeshConvertExample);
  command->callback([arguments, &exit_code] { exit_code = convert(*arguments) ? kExitOk : kExitCheckFailed; });
}

}  // namespace pincer::tasks
