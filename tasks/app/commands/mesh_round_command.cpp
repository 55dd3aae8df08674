#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/contact/mesh/round_edges.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/mesh_commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

constexpr const char* kMeshRoundExample = R"(
Sharp edges and corners become arcs of the radius, tangent to both faces, with normals: write OBJ or PLY to
keep these. A finger then keeps contact where it would fly off a sharp edge.

Example:
  pincer mesh round-edges cube.obj round.obj --units mm --radius 1.5)";

struct RoundArguments {
  MeshInput input;
  std::string out;
  double radius = 1.5;       // [mm]
  double crease_angle = 40;  // [degrees]
  int segments = 4;
  bool ignore_normals = false;
};

void roundFile(const RoundArguments& arguments) {
  const contact::TriangleMesh mesh = readWithProgress(arguments.input);
  const contact::RoundedMesh rounded = contact::roundEdges(mesh, {.radius = kMetresPerMillimetre * arguments.radius,
                                                                  .crease_angle = arguments.crease_angle * M_PI / 180,
                                                                  .use_file_normals = !arguments.ignore_normals,
                                                                  .segments = arguments.segments});
  if (rounded.creases + rounded.tips == 0) {
    print("{}: no edge is sharp; the result is a copy\n", printable(arguments.input.file));
  } else {
    print("{}: rounded {}, {} and {} to {} mm\n", printable(arguments.input.file), counted(rounded.creases, "edge"),
          counted(rounded.corners, "corner"), counted(rounded.tips, "tip"), arguments.radius);
  }
  writeAndSay(arguments.input, arguments.out, rounded.mesh, arguments.input.units);
}

}  // namespace

void addMeshRoundEdges(CLI::App& mesh, int& exit_code) {
  auto arguments = std::make_shared<RoundArguments>();
  CLI::App* command = mesh.add_subcommand("round-edges", "Round sharp edges, so that a finger keeps contact there");
  addMeshFile(*command, arguments->input);
  command->add_option("out", arguments->out, "File to write (.obj, .stl, .ply or .off)")->required();
  command->add_option("--radius", arguments->radius, "Radius of the rounding [mm]")
      ->check(within({.min = 1e-3, .max = 1e3, .remedy = "In millimetres."}))
      ->capture_default_str();
  command
      ->add_option("--crease-angle", arguments->crease_angle,
                   "Edges with a larger angle between facets are sharp [degrees]")
      ->check(within({.min = 1, .max = 180, .remedy = "In degrees."}))
      ->capture_default_str();
  command->add_option("--segments", arguments->segments, "Pieces of an arc of 90 degrees")
      ->check(wholeWithin(1, 64))
      ->capture_default_str();
  command->add_flag("--ignore-normals", arguments->ignore_normals, "The crease angle decides, not the file's normals");
  command->footer(kMeshRoundExample);
  command->callback([arguments, &exit_code] {
    roundFile(*arguments);
    exit_code = kExitOk;
  });
}

}  // namespace pincer::tasks
