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
constexpr int kMostRounds = 8;              // chosen: what is missed then are folded patches

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
        probes_.push_back({places[i] + radius_ * normals[i], v});
      }
    }
    thinOut(surface);
  }

  struct Error {
    double greatest = 0, typical = 0;  // [m]
    std::vector<std::size_t> missed;   // vertices of the input, by more than is allowed
    std::size_t probes = 0;
  };
  Error errorOf(const TriangleMesh& mesh, double allowed) const {
    const auto surface = SmoothMesh::build(mesh);
    Error error;
    error.probes = probes_.size();
    double sum = 0;
    for (const Probe& probe : probes_) {
      const double d = std::abs(heightOver(*surface, probe.centre));
      error.greatest = std::max(error.greatest, d);
      sum += d * d;
      if (!(d <= allowed)) error.missed.push_back(probe.vertex);
    }
    error.typical = probes_.empty() ? 0 : std::sqrt(sum / static_cast<double>(probes_.size()));
    return error;
  }

 private:
  static constexpr double kRadius = 0.01;  // of half the mesh's greatest dimension

  struct Probe {
    Vec3 centre;
    std::size_t vertex;
  };

  // Leaves out what touches another place first, as in a hollow: which one it touches may change without an error.
  void thinOut(const SmoothMesh& surface) {
    constexpr double kTouches = 1e-6;  // of the radius: further away another place is nearer
    const std::size_t stride = (probes_.size() + kMostProbes - 1) / kMostProbes;
    std::vector<Probe> kept;
    for (std::size_t i = 0; i < probes_.size(); i += stride) {
      if (std::abs(heightOver(surface, probes_[i].centre)) < kTouches * radius_) kept.push_back(probes_[i]);
    }
    probes_ = std::move(kept);
  }
  double heightOver(const SmoothMesh& surface, const Vec3& p) const {
    SurfaceTracker from_scratch;
    return surface.querySphere(p, radius_, 0, from_scratch, *cache_).main().phi;
  }

  double radius_;
  PatchCacheHandle cache_;
  std::vector<Probe> probes_;
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

// To so many triangles by the least error that leads there, to a factor of two.
void reduceTo(int triangles, Decimation& decimation, double size) {
  constexpr double kLeast = 1e-6, kMost = 1e-2;  // errors that are tried, of the size
  for (double error = kLeast * size; error < kMost * size; error *= 2) decimation.reduceTo(triangles, error);
  decimation.reduceTo(triangles, kInfinity);
}

// Holds the vertices that were missed where they are few; all to less where they are many, or come up again and again.
void tighten(const Probes::Error& measured, double error, int round, double& allowed, std::vector<bool>& stays) {
  constexpr double kFew = 0.02, kBelow = 0.9,
                   kLeast = 0.5;  // of all probes; of the bound that would just do; at a time
  const bool are_few = static_cast<double>(measured.missed.size()) < kFew * static_cast<double>(measured.probes);
  if (!are_few || round >= kMostRounds / 2) allowed *= kBelow * std::max(kLeast, error / measured.greatest);
  if (!are_few) return;
  for (const std::size_t vertex : measured.missed) stays[vertex] = true;
}

// True if the mesh means the same read again without options.
bool speaksForItself(const SimplifyOptions& options) {
  return options.use_file_normals && options.crease_angle == SimplifyOptions().crease_angle;
}

}  // namespace

SimplifiedMesh simplify(const TriangleMesh& mesh, const SimplifyOptions& options) {
  requireInRange(mesh, options);
  const SurfaceOptions as_given{.crease_angle = options.crease_angle, .use_file_normals = options.use_file_normals};
  const double size = greatestDimension(mesh);
  const Probes probes(*SmoothMesh::build(mesh, as_given), size / 2);
  std::vector<bool> stays(mesh.vertices.size());
  double allowed = options.error;
  for (int round = 0;; ++round) {
    Decimation decimation(mesh, options.crease_angle, options.use_file_normals, stays);
    if (options.error > 0) decimation.reduceTo(options.triangles, allowed);
    if (!(options.error > 0)) reduceTo(options.triangles, decimation, size);
    SimplifiedMesh result{decimation.mesh()};
    if (result.mesh.triangles.size() == mesh.triangles.size() && speaksForItself(options)) return {mesh};
    const Probes::Error error = probes.errorOf(result.mesh, options.error > 0 ? options.error : kInfinity);
    result.error = error.greatest;
    result.typical = error.typical;
    if (error.missed.empty() || round == kMostRounds) return result;
    tighten(error, options.error, round, allowed, stays);
  }
}

}  // namespace pincer::contact
