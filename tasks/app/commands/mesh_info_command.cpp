#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/engine/motion/mass.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/mesh_commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/terminal.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/scene/scene_ranges.h"

namespace pincer::tasks {
namespace {

constexpr const char* kInfoExample = R"(
What a mesh is, in millimetres and grams, and what is wrong with it: "!" what makes it unfit for grasping, "-"
what is good to know. docs/meshes.md explains each finding. A file that can't be read is named with its line
(exit code 3).

Example:
  pincer mesh info bunny.obj --units m --density 1050)";

constexpr const char* kCheckExample = R"(
Exit code 0: fit for grasping; 1: something named "!" makes it unfit; 3: the file can't be read.
docs/meshes.md explains each finding.

Example:
  pincer mesh check bunny.obj --units m --finger-radius 8)";

// Radius of a fingertip [mm]: a micrometre to a metre, wider than any finger; chosen.
constexpr NumberRule kFingerMillimetres = {.min = 1e-3, .max = 1e3, .remedy = "In millimetres; a fingertip has 8."};

struct MeshArguments {
  MeshInput input;
  double density = 1000;  // [kg/m^3]
  double finger_radius = kTypicalFinger;
  bool json = false;
};

struct MeshFacts {
  MeshCheck check;
  std::string no_mass;  // why it has none; empty: the rest holds
  engine::MassProperties mass;
  Vec3 moments = Vec3::Zero();  // principal ones [kg m^2]
};

MeshFacts examine(const MeshArguments& arguments) {
  const FaultyMesh read = readFaulty(arguments.input);
  const contact::TriangleMesh& mesh = read.mesh;
  MeshFacts facts;
  facts.check =
      checkMesh(read, contact::metresPerUnit(arguments.input.units), kMetresPerMillimetre * arguments.finger_radius);
  const contact::MeshReport& report = facts.check.report;
  if (!(report.closed && report.volume > 0)) {
    facts.no_mass = "the surface encloses no volume";
    return facts;
  }
  try {
    facts.mass = engine::massPropertiesOf(mesh, arguments.density * report.volume);
    facts.moments = engine::principalInertia(facts.mass).moments;
  } catch (const InputError&) {  // a piece that faces inwards counts with a negative mass
    facts.no_mass = "parts of the surface are turned inside out, or pass through each other";
  }
  return facts;
}

std::string massText(const MeshFacts& facts, double density) {
  if (!facts.no_mass.empty()) return fmt::format("  no mass: {}\n", facts.no_mass);
  const engine::MassProperties& m = facts.mass;
  std::string out = fmt::format("  at {:g} kg/m^3: {:.4g} g, centre of mass ({:.4g}, {:.4g}, {:.4g}) mm\n", density,
                                1e3 * m.mass, 1e3 * m.p_BBcm.x(), 1e3 * m.p_BBcm.y(), 1e3 * m.p_BBcm.z());
  const Vec3 moments = 1e9 * facts.moments;
  return out + fmt::format("  principal moments of inertia {:.4g}, {:.4g}, {:.4g} g mm^2\n", moments.x(), moments.y(),
                           moments.z());
}

std::string surfaceText(const MeshCheck& check) {
  if (!check.has_surface) return "  no smooth surface: the triangles don't hang together as one needs\n";
  const std::string hollow = std::isinf(check.concave_radius)
                                 ? "nothing is concave"
                                 : fmt::format("tightest hollow {:.3g} mm", 1e3 * check.concave_radius);
  return fmt::format("  smooth surface: {}, {}\n", hollow, counted(check.folded_triangles, "folded patch"));
}

std::string findingsOrNone(const contact::MeshReport& report) {
  return report.findings.empty() ? fmt::format("  {}\n", good("nothing wrong with it")) : findingsText(report.findings);
}

const char* featureSource(const contact::MeshReport& r) {
  if (r.file_normals) return "the file's normals say which";
  return r.smoothing_groups ? "the file's smoothing groups say which" : "sharper than the crease angle of 40 degrees";
}

std::string infoText(const MeshArguments& arguments, const MeshFacts& facts) {
  const contact::MeshReport& r = facts.check.report;
  const Vec3 size = 1e3 * (r.box_max - r.box_min);
  std::string out = fmt::format("{}\n", printable(arguments.input.file));
  out += fmt::format("  {}, {}, {}, {}\n", counted(r.vertices, "vertex"), counted(r.triangles, "triangle"),
                     counted(r.edges, "edge"), counted(r.components, "piece"));
  out += fmt::format("  {:.4g} x {:.4g} x {:.4g} mm, area {:.4g} mm^2, volume {:.4g} mm^3\n", size.x(), size.y(),
                     size.z(), 1e6 * r.area, 1e9 * r.volume);
  out += fmt::format("  {}, {} at {} ({})\n", r.closed ? "closed" : "open", counted(r.crease_edges, "sharp edge"),
                     counted(r.creased_vertices, "vertex"), featureSource(r));
  return out + surfaceText(facts.check) + massText(facts, arguments.density) + findingsOrNone(r);
}

std::string checkText(const MeshArguments& arguments, const MeshFacts& facts) {
  const contact::MeshReport& r = facts.check.report;
  return fmt::format("{}: {}\n", printable(arguments.input.file),
                     r.isFit() ? good("fit for grasping") : bad("unfit for grasping")) +
         findingsOrNone(r);
}

void writeCounts(const contact::MeshReport& r, JsonWriter& json) {
  json.key("vertices").value(r.vertices).key("unused_vertices").value(r.unused_vertices);
  json.key("duplicate_vertices").value(r.duplicate_vertices).key("triangles").value(r.triangles);
  json.key("zero_area_triangles").value(r.zero_area_triangles).key("needle_triangles").value(r.needle_triangles);
  json.key("duplicate_triangles")
      .value(r.duplicate_triangles)
      .key("edges")
      .value(r.edges)
      .key("components")
      .value(r.components);
  json.key("boundary_edges").value(r.boundary_edges).key("boundary_loops").value(r.boundary_loops);
  json.key("nonmanifold_edges").value(r.nonmanifold_edges).key("reversed_edges").value(r.reversed_edges);
  json.key("nonmanifold_vertices").value(r.nonmanifold_vertices);
  json.key("crease_edges").value(r.crease_edges).key("creased_vertices").value(r.creased_vertices);
  json.key("file_normals").value(r.file_normals).key("smoothing_groups").value(r.smoothing_groups);
  json.key("box_min").value(r.box_min).key("box_max").value(r.box_max).key("area").value(r.area).key("volume").value(
      r.volume);
  json.key("closed").value(r.closed).key("inverted").value(r.inverted).key("fit").value(r.isFit());
}

void writeMass(const MeshFacts& facts, double density, JsonWriter& json) {
  json.key("mass").beginObject().key("density").value(density).key("mass").value(facts.mass.mass);
  json.key("p_BBcm").value(facts.mass.p_BBcm).key("principal_moments").value(facts.moments).endObject();
}

std::string meshJson(const MeshArguments& arguments, const MeshFacts& facts) {
  JsonWriter json;
  json.beginObject().key("file").value(arguments.input.file).key("units").value(arguments.input.units);
  writeCounts(facts.check.report, json);
  if (facts.check.has_surface) {
    json.key("folded_triangles")
        .value(facts.check.folded_triangles)
        .key("concave_radius")
        .value(facts.check.concave_radius);
  }
  if (facts.no_mass.empty()) writeMass(facts, arguments.density, json);
  writeFindings(facts.check.report.findings, json);
  return json.endObject().text();
}

void addCommonOptions(CLI::App& command, MeshArguments& arguments) {
  addMeshFile(command, arguments.input);
  command.add_option("--finger-radius", arguments.finger_radius, "Radius of the fingertip that will touch it [mm]")
      ->check(within(kFingerMillimetres))
      ->capture_default_str();
  command.add_flag("--json", arguments.json, "Print the result as JSON, in SI units");
}

}  // namespace

void addMeshInfo(CLI::App& mesh, int& exit_code) {
  auto arguments = std::make_shared<MeshArguments>();
  CLI::App* info = mesh.add_subcommand("info", "Size, mass properties and faults of a mesh");
  addCommonOptions(*info, *arguments);
  info->get_option("--units")->required();
  info->add_option("--density", arguments->density, "Density of the solid [kg/m^3]")
      ->check(within(ranges::kDensity))
      ->capture_default_str();
  info->footer(kInfoExample);
  info->callback([arguments, &exit_code] {
    const MeshFacts facts = examine(*arguments);
    print("{}", arguments->json ? meshJson(*arguments, facts) : infoText(*arguments, facts));
    exit_code = kExitOk;
  });
}

void addMeshCheck(CLI::App& mesh, int& exit_code) {
  auto arguments = std::make_shared<MeshArguments>();
  CLI::App* check = mesh.add_subcommand("check", "Whether a mesh is fit for grasping; what is wrong and what helps");
  addCommonOptions(*check, *arguments);
  check->footer(kCheckExample);
  check->callback([arguments, &exit_code] {
    const MeshFacts facts = examine(*arguments);
    print("{}", arguments->json ? meshJson(*arguments, facts) : checkText(*arguments, facts));
    exit_code = facts.check.report.isFit() ? kExitOk : kExitCheckFailed;
  });
}

}  // namespace pincer::tasks
