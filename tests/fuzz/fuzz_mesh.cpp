#include <string>

#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/fuzz/choices.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

using namespace contact;

void demandWhole(const TriangleMesh& mesh) {
  const auto n = static_cast<int>(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) demand(p.allFinite(), "vertices are finite");
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) demand(v >= 0 && v < n, "triangles name vertices that exist");
}

bool reads(Bytes input, MeshFormat format, const ReadOptions& options) {
  return readsOrRefuses([&] { demandWhole(parseMesh(textOf(input), format, "fuzz", options)); });
}

// As `mesh convert --repair` reads a mesh, and then as the program reads a scene's, which refuses more. Most inputs are
// refused both ways: those are read once.
void readBothWays(Bytes input, MeshFormat format) {
  const bool is_read =
      reads(input, format, {.metres_per_unit = 1e-3, .degenerate = Degenerate::keep, .left_out = [](const auto& what) {
                              demand(isForPeople(what), "what is left out is told in a sentence");
                            }});
  if (is_read) reads(input, format, {});
}

// Corners on a coarse grid, so that many coincide or lie on one line; any three of them are a triangle, as a reader may
// keep them.
TriangleMesh drawMesh(Choices& choices) {
  constexpr std::size_t kMostTriangles = 200;
  TriangleMesh mesh;
  for (std::size_t i = 0, n = 3 + choices.below(30); i < n; ++i) {
    const std::size_t x = choices.below(8), y = choices.below(8), z = choices.below(8);
    mesh.vertices.push_back(0.01 * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)));
  }
  const auto corner = [&] { return static_cast<std::int32_t>(choices.below(mesh.vertices.size())); };
  const bool grouped = choices.below(2) == 1;
  do {
    const std::int32_t a = corner(), b = corner(), c = corner();
    mesh.triangles.push_back({a, b, c});
    if (grouped) mesh.smoothing_groups.push_back(corner());
  } while (!choices.empty() && mesh.triangles.size() < kMostTriangles);
  return mesh;
}

}  // namespace

void mesh_obj(Bytes input) { readBothWays(input, MeshFormat::obj); }
void mesh_stl(Bytes input) { readBothWays(input, MeshFormat::stl); }
void mesh_ply(Bytes input) { readBothWays(input, MeshFormat::ply); }
void mesh_off(Bytes input) { readBothWays(input, MeshFormat::off); }

void mesh_repair(Bytes input) {
  Choices choices(input);
  const RepairOptions options = {.weld = 0.005 * static_cast<double>(choices.below(4)),
                                 .fill_holes = static_cast<int>(choices.below(12))};
  const TriangleMesh mesh = drawMesh(choices);
  inspect(mesh);
  const RepairedMesh repaired = repair(mesh, options);
  demandWhole(repaired.mesh);
  for (const MeshChange& change : repaired.changes) demand(isForPeople(change.text), "a change is told in a sentence");
  inspect(repaired.mesh);
}

}  // namespace pincer::fuzz
