#include "contact/surface/smooth_mesh.h"

#include <fmt/format.h>

#include <limits>

#include "contact/mesh/mesh_report.h"
#include "contact/surface/convex_hull.h"
#include "contact/surface/shell_solver.h"
#include "contact/surface/surface_net.h"
#include "contact/surface/surface_search.h"
#include "contact/surface/surface_variant.h"

namespace pincer::contact {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  return hull;
}

double boundingRadiusOf(const SurfaceNet& net) {
  double radius2 = 0;
  for (std::int32_t t = 0; t < net.size(); ++t) {
    for (const Vec3& p : controlPoints(net.build(t).patch)) radius2 = std::max(radius2, p.squaredNorm());
  }
  return std::sqrt(radius2);
}

Foot footOf(const SurfaceSlot& slot) {
  const double w = std::max(0.0, 1 - slot.u - slot.v);
  return {slot.triangle, {w, slot.u, slot.v}};
}

SurfaceContacts report(const ShellContact& contact, const Vec3& C, double r, std::uint32_t status, SurfaceTracker& tracker) {
  tracker.slots[0] = {contact.foot.triangle, contact.foot.b[1], contact.foot.b[2]};
  tracker.p_BC = C;
  tracker.has_centre = true;
  tracker.status = status;
  SurfaceContacts found;
  found.points[0] = {C - contact.h * contact.n, contact.n, contact.h - r, 0};
  found.count = 1;
  return found;
}

}  // namespace

struct SmoothMesh::Data {
  Data(TriangleMesh m, const SurfaceOptions& options)
      : net(std::move(m), options.crease_angle, options.use_file_normals),
        variant(options.variant),
        search(net),
        features(net.mesh(), net.neighbours()),
        hull(hullOf(net.mesh())),
        bounding_radius(boundingRadiusOf(net)),
        folded(findFoldedTriangles(net)),
        concave_radius(findTightestConcaveRadius(net)) {}

  SurfaceNet net;
  SurfaceVariant variant;
  SurfaceSearch search;
  MeshFeatures features;
  std::vector<Vec3> hull;
  double bounding_radius;
  std::vector<std::int32_t> folded;
  double concave_radius;

  bool isContact(const ShellContact& followed, PatchCache& cache, const Vec3& C, double r, const Foot& start) const;
  ShellContact nearestWithin(PatchCache& cache, const Vec3& C, double r, double bound) const;
};

// Whether the followed solution is one that the finger touches. A centre that begins well above the surface and ends below it has been led
// to the far side of the body, where the equation has solutions too.
bool SmoothMesh::Data::isContact(const ShellContact& followed, PatchCache& cache, const Vec3& C, double r, const Foot& start) const {
  if (!followed.converged || followed.h >= r) return false;
  return followed.h >= 0 || tangentContact(net, cache, C, start).h < 0.25 * r;
}

// The nearest solution; not converged if there is none nearer than `bound`. In free space a seed that leads to no solution as near (shading
// normals may point past the nearest place by a few degrees) stands for itself: far from contact the distance counts, not the direction.
ShellContact SmoothMesh::Data::nearestWithin(PatchCache& cache, const Vec3& C, double r, double bound) const {
  constexpr double kStrayed = 20e-6;  // [m]
  const SurfaceSeed seed = search.nearest(net, cache, C, bound);
  if (!seed.found) return {};
  ShellContact contact = followContact(variant, net, cache, C, seed.foot);
  const bool strayed = !contact.converged || std::abs(contact.h) > seed.distance + kStrayed;
  if (strayed && seed.distance > r) {
    const PatchPoint x = evaluate(net.cell(seed.foot.triangle, cache).patch, seed.foot.b[1], seed.foot.b[2]);
    const double sign = (C - x.S).dot(x.N) < 0 ? -1 : 1;
    return {seed.foot, sign / seed.distance * (C - x.S), sign * seed.distance, true, {}};
  }
  contact.converged = contact.converged && std::abs(contact.h) < bound;
  return contact;
}

SmoothMesh::SmoothMesh(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
SmoothMesh::~SmoothMesh() = default;

std::shared_ptr<const SmoothMesh> SmoothMesh::build(TriangleMesh mesh, const SurfaceOptions& options) {
  if (!(options.crease_angle > 0 && options.crease_angle <= M_PI)) {
    throw InputError(
        fmt::format("{}: crease angle {} rad is out of range (0, 3.1416]; typical: 0.7 (40 degrees).", mesh.source, options.crease_angle));
  }
  requireVariant(options.variant, mesh.source);
  requireManifold(mesh);
  return std::shared_ptr<const SmoothMesh>(new SmoothMesh(std::make_unique<const Data>(std::move(mesh), options)));
}

SurfaceContacts SmoothMesh::querySphere(const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker, PatchCache& cache) const {
  static_cast<void>(margin);
  const Data& d = *data_;
  const SurfaceSlot& slot = tracker.slots[0];
  const bool tracked = slot.triangle >= 0 && slot.triangle < d.net.size();
  const Foot start = tracked ? footOf(slot) : Foot{};
  ShellContact followed;
  if (tracked) followed = followContact(d.variant, d.net, cache, p_BC, start);
  if (d.isContact(followed, cache, p_BC, r, start)) return report(followed, p_BC, r, kQueryOk, tracker);

  const ShellContact nearest = d.nearestWithin(cache, p_BC, r, followed.converged ? std::abs(followed.h) : kInfinity);
  if (followed.converged) return report(nearest.converged ? nearest : followed, p_BC, r, kQueryOk, tracker);

  // A contact that was lost may come back on its own side only: the far side of a thin wall is as near as this one.
  const ShellContact held = tangentContact(d.net, cache, p_BC, tracked ? start : nearest.foot);
  const bool same_side = !tracked || held.h >= r || nearest.n.dot(held.n) > 0;
  if (nearest.converged && same_side) return report(nearest, p_BC, r, tracked ? kQueryReseeded : kQueryOk, tracker);
  return report(held, p_BC, r, kQueryHeldDirection, tracker);
}

const std::vector<Vec3>& SmoothMesh::hullVertices() const { return data_->hull; }
const MeshFeatures& SmoothMesh::features() const { return data_->features; }
double SmoothMesh::boundingRadius() const { return data_->bounding_radius; }
const TriangleMesh& SmoothMesh::triangles() const { return data_->net.mesh(); }
const std::vector<std::int32_t>& SmoothMesh::foldedTriangles() const { return data_->folded; }
double SmoothMesh::tightestConcaveRadius() const { return data_->concave_radius; }

std::vector<std::string> SmoothMesh::findings(double r) const {
  std::vector<std::string> findings;
  if (!data_->folded.empty()) {
    const Vec3 p =
        1000 *
        data_->net.mesh().vertices[static_cast<std::size_t>(data_->net.mesh().triangles[static_cast<std::size_t>(data_->folded[0])][0])];
    findings.push_back(fmt::format(
        "the smooth surface folds over {} triangle(s), the first near ({:.4g}, {:.4g}, {:.4g}) mm: neighbouring normals differ too much. "
        "Refine the mesh there, or lower the crease angle.",
        data_->folded.size(), p.x(), p.y(), p.z()));
  }
  constexpr double kTightest = 0.8;  // r kappa beyond which one contact jumps between the two sides of a groove
  if (r > kTightest * data_->concave_radius) {
    findings.push_back(
        fmt::format("a finger of {:.3g} mm radius doesn't fit into the tightest hollow, of {:.3g} mm radius: contact may jump across it. "
                    "Fill or widen such hollows.",
                    1000 * r, 1000 * data_->concave_radius));
  }
  return findings;
}

}  // namespace pincer::contact
