#include "pincer/contact/surface/published_iteration.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

constexpr double kPublishedDone = 1e-6;  // [m]
constexpr int kMaxIterations = 50;       // before it counts as failed
constexpr int kMaxEdgeCrossings = 40;    // per step
constexpr double kGain = 1;              // of a step, as published

// The vector `d` in the plane of the triangle, as a change of the barycentric coordinates of corners 0, 1, 2.
std::array<double, 3> barycentric(const std::array<Vec3, 3>& corners, const Vec3& d) {
  const Vec3 e = corners[1] - corners[0], f = corners[2] - corners[0];
  const double a = e.dot(e), b = e.dot(f), c = f.dot(f), det = a * c - b * b, x = d.dot(e), y = d.dot(f);
  const double du = (c * x - b * y) / det, dv = (a * y - b * x) / det;
  return {-du - dv, du, dv};
}

// `d` turned about edge `e` with the facet of unit normal `from` until it lies in that of `to`.
Vec3 unfold(const Vec3& d, const Vec3& e, const Vec3& from, const Vec3& to) {
  return e * d.dot(e) + to.cross(e) * d.dot(from.cross(e));
}

std::array<Vec3, 3> cornersOf(const SurfaceNet& net, std::int32_t t) {
  return {net.vertex(t, 0), net.vertex(t, 1), net.vertex(t, 2)};
}

// Moves the foot by `d` [m] along the flat triangles; stops at a border. Returns the edges crossed.
int advance(const SurfaceNet& net, Foot& foot, Vec3 d) {
  int crossings = 0;
  while (crossings < kMaxEdgeCrossings) {
    const auto corners = cornersOf(net, foot.triangle);
    const std::array<double, 3> db = barycentric(corners, d);
    double part = 1;
    std::size_t leaving = 3;
    for (std::size_t i = 0; i < 3; ++i) {
      if (foot.b[i] + db[i] >= 0 || foot.b[i] / -db[i] >= part) continue;
      part = foot.b[i] / -db[i];
      leaving = i;
    }
    for (std::size_t i = 0; i < 3; ++i) foot.b[i] = std::max(0.0, foot.b[i] + part * db[i]);
    if (leaving == 3) break;
    const std::size_t edge = (leaving + 1) % 3, end = (edge + 1) % 3;
    const double s = foot.b[end] / (foot.b[edge] + foot.b[end]);
    const Neighbour other = net.neighbour(foot.triangle, static_cast<int>(edge));
    if (other.triangle < 0) break;
    const Vec3 e = (corners[end] - corners[edge]).normalized();
    d = unfold((1 - part) * d, e, net.facetNormal(foot.triangle), net.facetNormal(other.triangle));
    const auto j = static_cast<std::size_t>(other.edge);
    foot = {other.triangle, {}};
    foot.b[j] = s;
    foot.b[(j + 1) % 3] = 1 - s;
    ++crossings;
  }
  const double sum = foot.b[0] + foot.b[1] + foot.b[2];
  PINCER_ASSERT(!(sum <= 0));
  for (double& b : foot.b) b /= sum;
  return crossings;
}

// The printed gain; `db` is the direction before it.
double gainAlong(const PatchPoint& x, const std::array<double, 3>& db, double r) {
  const Vec3 dS = x.Su * db[1] + x.Sv * db[2], dN = x.Nu * db[1] + x.Nv * db[2];
  const double NN = x.N.squaredNorm(), moved = dS.norm();
  if (!(moved > 0)) return kGain;
  const double k = (dN - x.N * (x.N.dot(dN) / NN)).norm() / (std::sqrt(NN) * moved);
  return kGain / (1 + r * k);
}

}  // namespace

ShellContact followPublished(const SurfaceNet& net, PatchCache& cache, const Vec3& C, double r, const Foot& start) {
  ShellContact contact{start, {0, 0, 1}, 0, false, {}};
  Foot foot = start;
  for (;; ++contact.cost.steps) {
    const PatchPoint x = evaluate(net.cell(foot.triangle, cache).patch, foot.b[1], foot.b[2]);
    const Vec3 n = x.N.normalized(), R = C - x.S;
    const double h = R.dot(n);
    const Vec3 T = R - h * n;
    if (T.squaredNorm() < kPublishedDone * kPublishedDone) return {foot, n, h, true, contact.cost};
    if (contact.cost.steps >= kMaxIterations || !T.allFinite()) return contact;
    const auto corners = cornersOf(net, foot.triangle);
    const std::array<double, 3> db = barycentric(corners, T);
    const Vec3 d = (corners[1] - corners[0]) * db[1] + (corners[2] - corners[0]) * db[2];
    contact.cost.crossings += advance(net, foot, gainAlong(x, db, r) * d);
  }
}

}  // namespace pincer::contact
