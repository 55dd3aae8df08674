#include <CLI/CLI.hpp>

#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/mesh_commands.h"

namespace pincer::tasks {

void addMeshCommand(CLI::App& app, int& exit_code) {
  CLI::App* mesh =
      app.add_subcommand("mesh", "What a mesh file holds; repair, conversion, rounding, fewer or more triangles");
  mesh->require_subcommand(1);
  mesh->footer(
      "\nExamples:\n  pincer mesh info bunny.obj --units m\n  pincer mesh convert scan.stl scan.obj --units mm "
      "--repair");
  addMeshInfo(*mesh, exit_code);
  addMeshCheck(*mesh, exit_code);
  addMeshConvert(*mesh, exit_code);
  addMeshRoundEdges(*mesh, exit_code);
  addMeshSimplify(*mesh, exit_code);
  addMeshSubdivide(*mesh, exit_code);
}

}  // namespace pincer::tasks
