#include "pincer/contact/remesh/simplify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/mesh/mesh_builder.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/remesh/decimation.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch.h"
#include "pincer/contact/surface/patch_cache.h"

namespace pincer::contact {

namespace {

constexpr std::size_t kMostProbes = 20000;  // over all of the mesh

// Small balls that touch a smooth surface from outside.
class Probes {
 public:
  explicit Probes(const SmoothMesh& surface, double size) : radius_(kRadius * size), cache_(makePatchCache()) {
    std::vector<bool> seen(surface.triangles().vertices.size());
    for (std::size_t t = 0; t < surface.triangles().triangles.size(); ++t) {
      const Patch patch = surface.patch(static_cast<std::int32_t>(t));
      const std::array<Vec3, 3> places = {patch.b300, patch.b030, patch.b003},
                                normals = {patch.n200, patch.n020, patch.n002};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto v = static_cast<std::size_t>(surface.triangles().triangles[t][i]);
        if (seen[v]) continue;
        seen[v] = true;
        centres_.push_back(places[i] + radius_ * normals[i]);
      }
    }
    thinOut(surface);
  }

  struct Error {
    double greatest = 0, typical = 0;
  };
  Error errorOf(const TriangleMesh& mesh) const {
    const auto surface = SmoothMesh::build(mesh);
    Error error;
    double sum = 0;
    for (const Vec3& p : centres_) {
      const double d = std::abs(heightOver(*surface, p));
      error.greatest = std::max(error.greatest, d);
      sum += d * d;
    }
    error.typical = centres_.empty() ? 0 : std::sqrt(sum / static_cast<double>(centres_.size()));
    return error;
  }

 private:
  static constexpr double kRadius = 0.01;  // of half the mesh's greatest dimension

  // Leaves out what touches another place first, as in a hollow: which one it touches may change without an error.
  void thinOut(const SmoothMesh& surface) {
    constexpr double kTouches = 1e-6;  // of the radius: further away another place is nearer
    const std::size_t stride = (centres_.size() + kMostProbes - 1) / kMostProbes;
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < centres_.size(); i += stride) {
      if (std::abs(heightOver(surface, centres_[i])) < kTouches * radius_) kept.push_back(centres_[i]);
    }
    centres_ = std::move(kept);
  }
  double heightOver(const SmoothMesh& surface, const Vec3& p) const {
    SurfaceTracker from_scratch;
    return surface.querySphere(p, radius_, 0, from_scratch, *cache_).main().phi;
  }

  double radius_;
  PatchCacheHandle cache_;
  std::vector<Vec3> centres_;
};

void requireInRange(const TriangleMesh& mesh, const SimplifyOptions& options) {
  if (options.triangles < 0 || !(options.error >= 0 && std::isfinite(options.error))) {
    throw InputError(fmt::format(
        "{}: simplify to {} triangles, {} m: neither may be negative or infinite. Typical: 2000, or 2e-5 m.",
        mesh.source, options.triangles, options.error));
  }
  if (options.triangles == 0 && options.error == 0) {
    throw InputError(
        fmt::format("{}: simplify to what? Give a number of triangles (2000), or the error that is allowed (2e-5 m).",
                    mesh.source));
  }
}

double greatestDimension(const TriangleMesh& mesh) {
  const MeshReport report = inspect(mesh);
  const double size = (report.box_max - report.box_min).maxCoeff();
  if (!(size > 0))
    throw InputError(fmt::format("{}: all its points coincide: it has no size. Export it again.", mesh.source));
  return size;
}

}  // namespace

SimplifiedMesh simplify(const TriangleMesh& mesh, const SimplifyOptions& options) {
  requireInRange(mesh, options);
  const SurfaceOptions as_given{.crease_angle = options.crease_angle, .use_file_normals = options.use_file_normals};
  const Probes probes(*SmoothMesh::build(mesh, as_given), greatestDimension(mesh) / 2);
  Decimation decimation(mesh, options.crease_angle, options.use_file_normals,
                        options.error > 0 ? options.error : kInfinity);
  decimation.reduceTo(options.triangles);
  SimplifiedMesh result;
  result.mesh = decimation.mesh();
  const Probes::Error error = probes.errorOf(result.mesh);
  result.error = error.greatest;
  result.typical = error.typical;
  return result;
}

}  // namespace pincer::contact
