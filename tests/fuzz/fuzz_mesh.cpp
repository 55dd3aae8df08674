#include <string>

#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

using namespace contact;

constexpr std::size_t kMostInspected = 500;  // triangles: some inspections try all pairs of holes' edges

void demandWhole(const TriangleMesh& mesh) {
  const auto n = static_cast<int>(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) demand(p.allFinite(), "vertices are finite");
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) demand(v >= 0 && v < n, "triangles name vertices that exist");
}

void read(Bytes input, MeshFormat format, const ReadOptions& options) {
  readsOrRefuses([&] {
    const TriangleMesh mesh = parseMesh(textOf(input), format, "fuzz", options);
    demandWhole(mesh);
    if (mesh.triangles.size() > kMostInspected) return;
    inspect(mesh);
    if (options.left_out) demandWhole(repair(mesh, {.weld = 1e-4, .fill_holes = 8}).mesh);
  });
}

// As the program reads a scene's mesh, and as `mesh convert --repair` reads one.
void readBothWays(Bytes input, MeshFormat format) {
  read(input, format, {});
  read(input, format,
       {.metres_per_unit = 1e-3, .degenerate = Degenerate::keep, .left_out = [](const std::string& what) {
          demand(isForPeople(what), "what is left out is told in a sentence");
        }});
}

}  // namespace

void mesh_obj(Bytes input) { readBothWays(input, MeshFormat::obj); }
void mesh_stl(Bytes input) { readBothWays(input, MeshFormat::stl); }
void mesh_ply(Bytes input) { readBothWays(input, MeshFormat::ply); }
void mesh_off(Bytes input) { readBothWays(input, MeshFormat::off); }

}  // namespace pincer::fuzz
