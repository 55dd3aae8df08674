// mesh_commands: the subcommands of `pincer mesh`, and what they share. Each adds itself to `mesh`, as commands.h says.
#pragma once
#include <string>
#include <vector>

#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/triangle_mesh.h"
#include "pincer/tasks/run/files/json_writer.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace pincer::tasks {

void addMeshInfo(CLI::App& mesh, int& exit_code);
void addMeshCheck(CLI::App& mesh, int& exit_code);
void addMeshConvert(CLI::App& mesh, int& exit_code);
void addMeshRoundEdges(CLI::App& mesh, int& exit_code);
void addMeshSimplify(CLI::App& mesh, int& exit_code);
void addMeshSubdivide(CLI::App& mesh, int& exit_code);

constexpr double kMetresPerMillimetre = 1e-3;
constexpr double kTypicalFinger = 8;  // radius of a fingertip [mm]

// The argument "file" and the option --units of a command that reads a mesh.
struct MeshInput {
  std::string file;
  std::string units = "m";
};
CLI::Option* addUnits(CLI::App& command, const std::string& name, std::string& units, const std::string& help);
void addMeshFile(CLI::App& command, MeshInput& input);

// Reads with a bar on standard error where that is a terminal. Throws InputError.
contact::TriangleMesh readWithProgress(const MeshInput& input);
// The same for what looks at faults or mends them: keeps triangles without area,
// and leaves out polygons that can't be used.
struct FaultyMesh {
  contact::TriangleMesh mesh;
  int left_out = 0;       // polygons
  std::string first_bad;  // of them, with its place in the file
};
FaultyMesh readFaulty(const MeshInput& input);
// Writes in the format of the name's ending and prints what was written and what of the mesh the format can't hold.
void writeAndSay(const MeshInput& input, const std::string& out, const contact::TriangleMesh& mesh,
                 const std::string& units);

// Everything that a finger will feel of a mesh: its report, and what SmoothMesh finds where the mesh
// is sound enough to have a smooth surface.
struct MeshCheck {
  contact::MeshReport report;  // its findings include those of the smooth surface
  bool has_surface = false;
  int folded_triangles = 0;
  double concave_radius = 0;  // [m], infinity where nothing is concave
};
MeshCheck checkMesh(const FaultyMesh& read, double metres_per_unit, double finger_radius);  // [m]

// "! name: text" per finding; "!" for those that make a mesh unfit for grasping, "-" for the others.
std::string findingsText(const std::vector<contact::MeshFinding>& findings);
void writeFindings(const std::vector<contact::MeshFinding>& findings, JsonWriter& json);

}  // namespace pincer::tasks
