#include "pincer/contact/smooth_mesh.h"

#include <fmt/format.h>

#include <mutex>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/surface/convex_hull.h"
#include "pincer/contact/surface/mesh_features.h"
#include "pincer/contact/surface/surface_net.h"
#include "pincer/contact/surface/surface_search.h"
#include "pincer/contact/surface/touch_surface.h"

namespace pincer::contact {

namespace {

// Vertices of the hull; those that no triangle uses have no part in it.
std::vector<Vec3> hullOf(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t v : triangle) used[static_cast<std::size_t>(v)] = true;
  }
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) points.push_back(mesh.vertices[i]);
  }
  std::vector<Vec3> hull;
  for (const std::int32_t i : hullCorners(points)) hull.push_back(points[static_cast<std::size_t>(i)]);
  hull.shrink_to_fit();
  return hull;
}

// Shares of the time that building takes, as measured on a million triangles.
constexpr double kManifoldKnown = 0.1, kNetBuilt = 0.5, kSearchBuilt = 0.9;

using Progress = std::function<void(double)>;

Progress part(const Progress& progress, double from, double to) {
  if (!progress) return nullptr;
  return [&progress, from, to](double share) { progress(from + (to - from) * share); };
}

}  // namespace

struct SmoothMesh::Data {
  Data(TriangleMesh mesh, const SurfaceOptions& options) : Data(std::move(mesh), options, NetInspector()) {}
  Data(TriangleMesh mesh, const SurfaceOptions& options, NetInspector&& inspector)
      : net(std::move(mesh), options.crease_angle, options.use_file_normals, options.variant),
        search(net, inspector, part(options.progress, kNetBuilt, kSearchBuilt)),
        variant(options.variant),
        hull(hullOf(net.mesh())),
        findings(inspector.findings()) {}

  SurfaceNet net;
  SurfaceSearch search;
  SurfaceVariant variant;
  mutable std::once_flag features_wanted;
  mutable std::unique_ptr<const MeshFeatures> features;  // null until wanted
  std::vector<Vec3> hull;
  NetFindings findings;
};

SmoothMesh::SmoothMesh(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
SmoothMesh::~SmoothMesh() = default;

std::shared_ptr<const SmoothMesh> SmoothMesh::build(TriangleMesh mesh, const SurfaceOptions& options) {
  if (!(options.crease_angle > 0 && options.crease_angle <= M_PI)) {
    throw InputError(fmt::format("{}: crease angle {} rad is out of range (0, 3.1416]; typical: 0.7 (40 degrees).",
                                 mesh.source, options.crease_angle));
  }
  requireWellFormed(mesh);
  requireManifold(mesh);
  if (options.progress) options.progress(kManifoldKnown);
  std::shared_ptr<const SmoothMesh> built(new SmoothMesh(std::make_unique<const Data>(std::move(mesh), options)));
  if (options.progress) options.progress(1);
  return built;
}

SurfaceContacts SmoothMesh::querySphere(const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker,
                                        PatchCache& cache) const {
  PINCER_DEMAND(r > 0, "querySphere: the fingertip's radius is positive");
  return touchSurface({data_->variant, data_->net, cache}, data_->search, p_BC, r, margin, tracker);
}

const std::vector<Vec3>& SmoothMesh::hullVertices() const { return data_->hull; }
double SmoothMesh::boundingRadius() const { return data_->findings.bounding_radius; }
std::size_t SmoothMesh::memoryBytes() const {
  return data_->net.memoryBytes() + data_->search.memoryBytes() + data_->hull.capacity() * sizeof(Vec3) +
         (data_->features ? data_->features->memoryBytes() : 0);
}
const MeshFeatures& SmoothMesh::features() const {
  const Data& d = *data_;
  std::call_once(d.features_wanted, [&] {
    d.features = std::make_unique<const MeshFeatures>(d.net.mesh(), findNeighbours(d.net.mesh()));
  });
  return *d.features;
}
const SurfaceNet& SmoothMesh::net() const { return data_->net; }
double SmoothMesh::bulge() const { return data_->search.bulge(); }
const TriangleMesh& SmoothMesh::triangles() const { return data_->net.mesh(); }
Patch SmoothMesh::patch(std::int32_t triangle) const { return data_->net.build(triangle).patch; }
SurfaceVariant SmoothMesh::variant() const { return data_->variant; }
const std::vector<std::int32_t>& SmoothMesh::foldedTriangles() const { return data_->findings.folded; }
double SmoothMesh::tightestConcaveRadius() const { return data_->findings.concave_radius; }

std::vector<std::string> SmoothMesh::findings(double r) const {
  std::vector<std::string> findings;
  if (!data_->findings.folded.empty()) {
    const Vec3 p = 1000 * data_->net.mesh().vertices[static_cast<std::size_t>(
                              data_->net.mesh().triangles[static_cast<std::size_t>(data_->findings.folded[0])][0])];
    findings.push_back(
        fmt::format("the smooth surface folds over {} triangle(s), the first near ({:.4g}, {:.4g}, {:.4g}) mm: "
                    "neighbouring normals differ too much. "
                    "Refine the mesh there, or lower the crease angle.",
                    data_->findings.folded.size(), p.x(), p.y(), p.z()));
  }
  constexpr double kTightest = 0.8;  // r kappa beyond which one contact jumps between the two sides of a groove
  if (r > kTightest * data_->findings.concave_radius) {
    findings.push_back(
        fmt::format("the tightest hollow has {:.3g} mm radius; a finger of {:.3g} mm needs {:.3g} mm, else contact may "
                    "jump from one side to the other. Fill or widen such hollows, or take a smaller finger.",
                    1000 * data_->findings.concave_radius, 1000 * r, 1000 * r / kTightest));
  }
  return findings;
}

}  // namespace pincer::contact
