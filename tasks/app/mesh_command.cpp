#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "contact/mesh/mesh_reader.h"
#include "contact/mesh/mesh_report.h"
#include "engine/motion/mass.h"
#include "tasks/app/app.h"
#include "tasks/app/commands.h"
#include "tasks/app/json_writer.h"
#include "tasks/app/terminal.h"

namespace pincer::tasks {
namespace {

constexpr const char* kExample = R"(
What a mesh is, in millimetres and grams, and what is wrong with it. A file that isn't a sound OBJ, STL, PLY or OFF is named with its line (exit code 3).

Example:
  pincer mesh info bunny.obj --units m --density 1050)";

struct MeshArguments {
  std::string file;
  std::string units;
  double density = 1000;  // [kg/m^3]
  bool json = false;
};

struct MeshFacts {
  contact::MeshReport report;
  bool solid = false;  // closed and turned outwards: it has a mass
  engine::MassProperties mass;
};

MeshFacts examine(const MeshArguments& arguments) {
  const contact::TriangleMesh mesh = contact::readMesh(arguments.file, {.metres_per_unit = contact::metresPerUnit(arguments.units)});
  MeshFacts facts;
  facts.report = contact::inspect(mesh);
  facts.solid = facts.report.closed && facts.report.volume > 0;
  if (facts.solid) facts.mass = engine::massPropertiesOf(mesh, arguments.density * facts.report.volume);
  return facts;
}

std::string massText(const MeshFacts& facts, double density) {
  if (!facts.solid) return "  no mass: the surface encloses no volume\n";
  const engine::MassProperties& m = facts.mass;
  std::string out = fmt::format("  at {:g} kg/m^3: {:.4g} g, centre of mass ({:.4g}, {:.4g}, {:.4g}) mm\n", density, 1e3 * m.mass,
                                1e3 * m.p_BBcm.x(), 1e3 * m.p_BBcm.y(), 1e3 * m.p_BBcm.z());
  const Vec3 moments = 1e9 * engine::principalInertia(m).moments;
  return out + fmt::format("  principal moments of inertia {:.4g}, {:.4g}, {:.4g} g mm^2\n", moments.x(), moments.y(), moments.z());
}

std::string meshText(const MeshArguments& arguments, const MeshFacts& facts) {
  const contact::MeshReport& r = facts.report;
  const Vec3 size = 1e3 * (r.box_max - r.box_min);
  std::string out = fmt::format("{}\n", arguments.file);
  out += fmt::format("  {} vertices, {} triangles, {} edges, {} piece{}\n", r.vertices, r.triangles, r.edges, r.components,
                     r.components == 1 ? "" : "s");
  out += fmt::format("  {:.4g} x {:.4g} x {:.4g} mm, area {:.4g} mm^2, volume {:.4g} mm^3\n", size.x(), size.y(), size.z(), 1e6 * r.area,
                     1e9 * r.volume);
  out += fmt::format("  {}, {} sharp edges\n", r.closed ? "closed" : "open", r.crease_edges);
  out += massText(facts, arguments.density);
  for (const contact::MeshFinding& finding : r.findings) out += fmt::format("  {} {}\n", bad("!"), finding.text);
  if (r.findings.empty()) out += fmt::format("  {}\n", good("nothing wrong with it"));
  return out;
}

void writeMass(const MeshFacts& facts, double density, JsonWriter& json) {
  json.key("mass").beginObject().key("density").value(density).key("mass").value(facts.mass.mass);
  json.key("p_BBcm").value(facts.mass.p_BBcm).key("principal_moments").value(engine::principalInertia(facts.mass).moments).endObject();
}

std::string meshJson(const MeshArguments& arguments, const MeshFacts& facts) {
  const contact::MeshReport& r = facts.report;
  JsonWriter json;
  json.beginObject().key("file").value(arguments.file).key("units").value(arguments.units);
  json.key("vertices")
      .value(r.vertices)
      .key("unused_vertices")
      .value(r.unused_vertices)
      .key("duplicate_vertices")
      .value(r.duplicate_vertices);
  json.key("triangles").value(r.triangles).key("edges").value(r.edges).key("components").value(r.components);
  json.key("boundary_edges").value(r.boundary_edges).key("nonmanifold_edges").value(r.nonmanifold_edges);
  json.key("nonmanifold_vertices").value(r.nonmanifold_vertices).key("crease_edges").value(r.crease_edges);
  json.key("box_min").value(r.box_min).key("box_max").value(r.box_max).key("area").value(r.area).key("volume").value(r.volume);
  json.key("closed").value(r.closed).key("inverted").value(r.inverted);
  if (facts.solid) writeMass(facts, arguments.density, json);
  json.key("findings").beginArray();
  for (const contact::MeshFinding& finding : r.findings) json.value(finding.text);
  return json.endArray().endObject().text();
}

}  // namespace

void addMeshCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<MeshArguments>();
  CLI::App* mesh = app.add_subcommand("mesh", "What a mesh file holds");
  mesh->require_subcommand(1);
  mesh->footer("\nExample:\n  pincer mesh info bunny.obj --units m");
  CLI::App* info = mesh->add_subcommand("info", "Size, mass properties and faults of a mesh");
  info->add_option("file", arguments->file, "Mesh file (OBJ, STL, PLY or OFF)")->required();
  info->add_option("--units", arguments->units, "Length unit of the file's coordinates")
      ->required()
      ->check(CLI::IsMember({"m", "cm", "mm", "in"}));
  info->add_option("--density", arguments->density, "Density of the solid [kg/m^3]")->check(CLI::PositiveNumber)->capture_default_str();
  info->add_flag("--json", arguments->json, "Print the result as JSON, in SI units");
  info->footer(kExample);
  info->callback([arguments, &exit_code] {
    const MeshFacts facts = examine(*arguments);
    fmt::print("{}", arguments->json ? meshJson(*arguments, facts) : meshText(*arguments, facts));
    exit_code = kExitOk;
  });
}

}  // namespace pincer::tasks
