#include "pincer/contact/shape/smooth_lead.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/mesh_rules.h"
#include "pincer/contact/shape/solid_feature.h"
#include "pincer/contact/shape/tolerances.h"
#include "pincer/contact/surface/flat_minimum.h"
#include "pincer/contact/surface/shell_solver.h"

namespace pincer::contact {
namespace {

constexpr double kAtRest = 1e-8;     // of the size: where steps end
constexpr double kLevel = 1e-8;      // sine
constexpr double kLift = 0.02;       // of the size, beside the depth: how far a face is moved in
constexpr double kFirstStep = 0.05;  // of the size
constexpr double kLongestLead = 10;  // of the size
constexpr int kMostLess = 2;         // from a face to an edge to a corner

class SmoothLead {
 public:
  SmoothLead(const SurfaceNet& net, PatchCache& cache, const PosedSolid& solid, double size)
      : net_(net), cache_(cache), solid_(solid), size_(size) {}

  // Leaves a point where it is that has no solution beside it, and that of a crease on a sharp edge, which the two
  // cross. `whole`: over all of the face or line of the solid that faces the surface, not only over the corner or edge
  // that the point is on.
  void lead(FoundPoint& point, bool is_on_crease, bool whole) const {
    const Vec3 d = solid_.inwards(point.n_W);
    const double lift = kLift * size_ + std::max(0.0, -2 * point.phi), slack = kSamePlace * size_;
    Vec3 c = solid_.inwards(point.p_W - 0.5 * point.phi * point.n_W - solid_.p) - roundingOf(solid_) * d;
    const Vec3 on_mesh = point.p_W + 0.5 * point.phi * point.n_W;
    ShellContact found;
    found.foot = {point.triangle, closestOnFacet(net_, point.triangle, on_mesh).b};
    SolidFeature feature(solid_.shape, c, d, solid_.skin, lift, whole ? SolidFeature::kWhole : slack);
    if (is_on_crease && feature.isSharp()) return;
    if (!descend(feature, c, found)) return;
    for (int less = 0; less < kMostLess; ++less) {
      const Vec3 d_found = -solid_.inwards(found.n);
      const bool is_cut_off = feature.isCutOff(d_found);
      if (!is_cut_off && !feature.isEnd(c, slack)) break;
      feature = SolidFeature(solid_.shape, feature.moveOut(c), is_cut_off ? d_found : d, solid_.skin, lift, slack);
      if ((is_on_crease && feature.isSharp()) || !descend(feature, c, found)) return;
    }
    if (!(-found.n.dot(point.n_W) > 0)) return;
    const double phi = found.h - feature.rho();
    const Vec3 S = solid_.place(c) - found.h * found.n;
    point.n_W = -found.n;
    point.phi = phi;
    point.p_W = S + 0.5 * phi * found.n;
    point.triangle = found.foot.triangle;
    point.feature = meshFeatureOf(kMeshCornerOfB, feature.name());
  }

 private:
  ShellContact at(const Vec3& c, const Foot& foot) const { return solveShell(net_, cache_, solid_.place(c), foot); }

  // How much of the normal lies along the feature, where it may go on that way (sine).
  double slopeOf(const SolidFeature& feature, const Vec3& c, const Vec3& N) const {
    const double tau = kFirstStep * size_;
    return (c - feature.nearest(c - tau * N)).norm() / tau;
  }

  // Shading normals turn a little otherwise than the surface: a step counts where it leads down or to a lesser slope.
  bool descend(const SolidFeature& feature, Vec3& c, ShellContact& found) const {
    c = feature.nearest(c);
    found = at(c, found.foot);
    Vec3 N = solid_.inwards(found.n);
    double tau = kFirstStep * size_, slope = slopeOf(feature, c, N);
    for (int i = 0; found.converged && slope > kLevel && i < kMostQueries; ++i) {
      const Vec3 next = feature.nearest(c - tau * N), way = next - c;
      if (!(way.norm() > kAtRest * size_)) break;
      const ShellContact there = at(next, found.foot);
      const Vec3 N_there = solid_.inwards(there.n);
      const double slope_there = slopeOf(feature, next, N_there);
      if (!there.converged || !(slope_there < slope || there.h < found.h - kAtRest * size_)) {
        tau *= 0.25;
        continue;
      }
      const double along = way.dot(N_there - N);
      tau = along > 0 ? std::min(way.squaredNorm() / along, kLongestLead * size_) : 2 * tau;
      found = there;
      c = next;
      N = N_there;
      slope = slope_there;
    }
    return found.converged;
  }

  const SurfaceNet& net_;
  PatchCache& cache_;
  const PosedSolid& solid_;
  const double size_;
};

// Where on the mesh a point is.
enum class MeshPlace { flat, smooth, sharp };

bool isFlatPatch(const SurfaceNet& net, std::int32_t t) {
  constexpr double kFlat = 1e-9;  // [rad]
  const Vec3 n = (net.vertex(t, 1) - net.vertex(t, 0)).cross(net.vertex(t, 2) - net.vertex(t, 0)).normalized();
  for (int i = 0; i < 3; ++i) {
    if ((net.normal(t, i) - n).squaredNorm() > kFlat * kFlat) return false;
  }
  return true;
}

MeshPlace meshPlaceOf(const SurfaceNet& net, const FoundPoint& point) {
  const std::int32_t t = point.triangle;
  const auto b = closestOnFacet(net, t, point.p_W + 0.5 * point.phi * point.n_W).b;
  const bool of_solid = point.feature >> 30 == kMeshCornerOfB;
  for (int i = 0; !of_solid && i < 3; ++i) {
    const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>((i + 1) % 3);
    if (b[from] + b[to] >= 1 && b[from] > 0 && b[to] > 0 && net.isSharp(t, i)) return MeshPlace::sharp;
    bool is_sharp = false;
    if (b[from] >= 1)
      net.visitCorners({t, i}, [&](const CellCorner& c) {
        is_sharp = is_sharp || net.isSharp(c.triangle, c.corner) || net.isSharp(c.triangle, (c.corner + 2) % 3);
      });
    if (is_sharp) return MeshPlace::sharp;
  }
  return isFlatPatch(net, t) ? MeshPlace::flat : MeshPlace::smooth;
}

// True if another point with a like normal is deeper.
bool isShadowed(const FoundPoints& points, const FoundPoint& point) {
  return std::any_of(points.points.begin(), points.points.begin() + points.count, [&](const FoundPoint& other) {
    return &other != &point && other.n_W.dot(point.n_W) > kLikeNormals &&
           (other.phi < point.phi || (other.phi == point.phi && other.feature < point.feature));
  });
}

// Several of one feature of the solid are told apart by their number, by depth; sorted by feature.
void nameApart(FoundPoints& points) {
  const auto by_feature = [](const FoundPoint& x, const FoundPoint& y) {
    return x.feature < y.feature || (x.feature == y.feature && x.phi < y.phi);
  };
  std::sort(points.all().begin(), points.all().end(), by_feature);
  std::uint32_t last = 0, number = 0;
  for (FoundPoint& point : points.all()) {
    const std::uint32_t feature = point.feature;
    number = feature == last ? number + 1 : 0;
    last = feature;
    point.feature += number << 16;
  }
}

}  // namespace

void leadToSurface(const SurfaceNet& net, PatchCache& cache, const PosedSolid& solid, double size, double margin,
                   FoundPoints& points) {
  const SmoothLead leader(net, cache, solid, size);
  FoundPoints led;
  const auto add = [&](const FoundPoint& point) {
    if (!(point.phi < margin)) return;
    const auto is_same = [&](const FoundPoint& other) {
      return (other.p_W - point.p_W).squaredNorm() < kOnePoint * kOnePoint * size * size &&
             other.n_W.dot(point.n_W) > kLikeNormals;
    };
    FoundPoint* const end = led.points.data() + led.count;
    FoundPoint* const known = std::find_if(led.points.data(), end, is_same);
    if (known != end && !(point.phi < known->phi)) return;
    if (known == end && led.count == kMaxPairPoints) return;
    *known = point;
    led.count += known == end;
  };
  for (const FoundPoint& point : points.all()) {
    const MeshPlace place = meshPlaceOf(net, point);
    const bool is_on_crease = place == MeshPlace::sharp;
    if (place != MeshPlace::flat && !isShadowed(points, point)) {
      FoundPoint deepest = point;
      leader.lead(deepest, is_on_crease, true);
      add(deepest);
    }
    FoundPoint there = point;
    if (place == MeshPlace::smooth) leader.lead(there, false, false);
    add(there);
  }
  nameApart(led);
  points = led;
}

}  // namespace pincer::contact
