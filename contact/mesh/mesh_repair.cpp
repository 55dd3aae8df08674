#include "pincer/contact/mesh_repair.h"

#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/mesh/repair_steps.h"

namespace pincer::contact {

namespace {

constexpr int kMostHoleEdges = 1000;  // ear clipping is quadratic

void requireInRange(const TriangleMesh& mesh, const RepairOptions& options) {
  if (!(options.weld >= 0 && std::isfinite(options.weld))) {
    throw InputError(
        fmt::format("{}: welding distance = {} is out of range [0, inf) m; typical: 1e-5.", mesh.source, options.weld));
  }
  if (options.fill_holes < 0 || options.fill_holes > kMostHoleEdges) {
    throw InputError(
        fmt::format("{}: fill_holes = {} is out of range 0 .. {} edges. Close larger holes in a mesh editor.",
                    mesh.source, options.fill_holes, kMostHoleEdges));
  }
}

}  // namespace

RepairedMesh repair(TriangleMesh mesh, const RepairOptions& options) {
  requireInRange(mesh, options);
  RepairedMesh result{std::move(mesh), {}};
  TriangleMesh& m = result.mesh;
  const auto note = [&](const MaybeChange& change) {
    if (change) result.changes.push_back(*change);
  };
  note(weldVertices(m, options.weld));
  note(dropPointlessTriangles(m));
  note(dropDuplicateTriangles(m));
  note(orientConsistently(m));
  note(turnFlatTriangles(m));
  note(cutApart(m));
  if (options.fill_holes > 0) note(fillHoles(m, options.fill_holes));
  note(turnOutwards(m));
  note(dropOpposingNormals(m));
  note(dropUnusedVertices(m));
  return result;
}

}  // namespace pincer::contact
