#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "pincer/contact/io/printable.h"
#include "pincer/contact/remesh/simplify.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/mesh_commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

constexpr const char* kMeshSimplifyExample = R"(
Fewer triangles for the same smooth surface, until so many are left or the error would be larger; without
either, to 20 um, and to 10,000 triangles whatever the error. Creases and borders are kept. The error is that
of the smooth surface, as a finger feels it. Write OBJ or PLY to keep the normals.

Examples:
  pincer mesh simplify scan.stl part.obj --units mm
  pincer mesh simplify scan.stl part.obj --units mm --triangles 2000)";

constexpr const char* kMeshSubdivideExample = R"(
Each triangle becomes four, whose new vertices lie on the smooth surface: for programs that know flat
triangles only.

Example:
  pincer mesh subdivide part.obj fine.obj --units mm --levels 2)";

constexpr double kMetresPerMicrometre = 1e-6;
constexpr double kTypicalError = 20;      // [um]: less than the facets of what people print or scan
constexpr int kEnoughTriangles = 10'000;  // triangles, of a noisy scan: they fit the processor's cache

struct FinenessArguments {
  MeshInput input;
  std::string out;
  int triangles = 0;
  double error = 0;          // [um]
  double crease_angle = 40;  // [degrees]
  bool ignore_normals = false;
  int levels = 1;
};

contact::SimplifiedMesh simplified(const contact::TriangleMesh& mesh, const FinenessArguments& arguments) {
  contact::SimplifyOptions options{.triangles = arguments.triangles,
                                   .error = kMetresPerMicrometre * arguments.error,
                                   .crease_angle = arguments.crease_angle * M_PI / 180,
                                   .use_file_normals = !arguments.ignore_normals};
  if (options.triangles > 0 || options.error > 0) return contact::simplify(mesh, options);
  options.error = kMetresPerMicrometre * kTypicalError;
  contact::SimplifiedMesh simple = contact::simplify(mesh, options);
  if (simple.mesh.triangles.size() <= kEnoughTriangles) return simple;
  options.error = 0;
  options.triangles = kEnoughTriangles;
  return contact::simplify(mesh, options);
}

// Sentences about what wasn't reached of what was asked for.
void sayWhatIsMissing(const contact::SimplifiedMesh& simple, const FinenessArguments& arguments) {
  const auto left = static_cast<int>(simple.mesh.triangles.size());
  if (arguments.triangles > 0 && arguments.error == 0 && left > arguments.triangles) {
    print("{} triangles can't be reached: creases, corners and borders stay, and no facet may turn over.\n",
          arguments.triangles);
  }
  if (arguments.error > 0 && 1e6 * simple.error > arguments.error) {
    print(
        "{:g} um can't be kept to everywhere: where the smooth surface folds over itself no normals in a file say "
        "what is felt. `pincer mesh check` names such places; refine or mend them first.\n",
        arguments.error);
  }
}

void simplifyFile(const FinenessArguments& arguments) {
  const contact::TriangleMesh mesh = readWithProgress(arguments.input);
  const contact::SimplifiedMesh simple = simplified(mesh, arguments);
  print("{}: {} of {} triangles; the smooth surface is off by {:.3g} um at most, typically {:.2g} um\n",
        printable(arguments.input.file), simple.mesh.triangles.size(), mesh.triangles.size(), 1e6 * simple.error,
        1e6 * simple.typical);
  sayWhatIsMissing(simple, arguments);
  writeAndSay(arguments.input, arguments.out, simple.mesh, arguments.input.units);
}

void subdivideFile(const FinenessArguments& arguments) {
  contact::TriangleMesh mesh = readWithProgress(arguments.input);
  bool use_file_normals = !arguments.ignore_normals;
  for (int level = 0; level < arguments.levels; ++level) {
    mesh = contact::subdivide(mesh, arguments.crease_angle * M_PI / 180, use_file_normals);
    use_file_normals = true;  // those of the level before, which say what is sharp
  }
  writeAndSay(arguments.input, arguments.out, mesh, arguments.input.units);
}

std::shared_ptr<FinenessArguments> addFinenessOptions(CLI::App& command) {
  auto arguments = std::make_shared<FinenessArguments>();
  addMeshFile(command, arguments->input);
  command.add_option("out", arguments->out, "File to write (.obj, .stl, .ply or .off)")->required();
  command
      .add_option("--crease-angle", arguments->crease_angle,
                  "Edges with a larger angle between facets are sharp [degrees]")
      ->check(within({.min = 1, .max = 180, .remedy = "In degrees."}))
      ->capture_default_str();
  command.add_flag("--ignore-normals", arguments->ignore_normals, "The crease angle decides, not the file's normals");
  return arguments;
}

}  // namespace

void addMeshSimplify(CLI::App& mesh, int& exit_code) {
  CLI::App* command = mesh.add_subcommand("simplify", "Fewer triangles that feel the same");
  const auto arguments = addFinenessOptions(*command);
  command->add_option("--triangles", arguments->triangles, "Stop at so many triangles")
      ->check(wholeWithin(4, 2'000'000));
  command->add_option("--error", arguments->error, "Stop before the smooth surface is further off than this [um]")
      ->check(within({.min = 1e-3, .max = 1e5, .remedy = "In micrometres; 20 isn't felt."}));
  command->footer(kMeshSimplifyExample);
  command->callback([arguments, &exit_code] {
    simplifyFile(*arguments);
    exit_code = kExitOk;
  });
}

void addMeshSubdivide(CLI::App& mesh, int& exit_code) {
  CLI::App* command = mesh.add_subcommand("subdivide", "Four triangles for each, on the smooth surface");
  const auto arguments = addFinenessOptions(*command);
  command->add_option("--levels", arguments->levels, "How many times")->check(wholeWithin(1, 8))->capture_default_str();
  command->footer(kMeshSubdivideExample);
  command->callback([arguments, &exit_code] {
    subdivideFile(*arguments);
    exit_code = kExitOk;
  });
}

}  // namespace pincer::tasks
