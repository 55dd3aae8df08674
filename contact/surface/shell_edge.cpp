#include "pincer/contact/surface/shell_edge.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

constexpr double kAlongEdge = 1e-3;      // eps
constexpr double kEdgeTolerance = 1e-8;  // of the chord
constexpr int kMaxEdgeSteps = 24;        // of Newton's method

struct Quadratic {
  Vec3 value, derivative;
};

Quadratic evaluateQuadratic(const std::array<Vec3, 3>& n, double s) {
  const double q = 1 - s;
  return {n[0] * (q * q) + n[1] * (2 * q * s) + n[2] * (s * s), 2 * ((n[1] - n[0]) * q + (n[2] - n[1]) * s)};
}

// The part of R across the normal `N`.
Vec3 residual(const Vec3& R, const Vec3& N) { return R - R.dot(N) / N.squaredNorm() * N; }

EdgeFoot describe(const SharpEdge& edge, const Vec3& C, double s) {
  EdgeFoot foot{s, evaluate(edge, s), false, false};
  const Vec3 R = C - foot.x.E;
  foot.leads_left = residual(R, foot.x.left).dot(foot.x.left.cross(foot.x.E1)) > 0;
  foot.leads_right = !edge.is_border && residual(R, foot.x.right).dot(foot.x.E1.cross(foot.x.right)) > 0;
  return foot;
}

}  // namespace

SharpEdge sharpEdge(const SurfaceNet& net, PatchCache& cache, std::int32_t triangle, int i) {
  const SurfaceCell cell = net.cell(triangle, cache);
  const Neighbour other = cell.neighbours[static_cast<std::size_t>(i)];
  SharpEdge edge{edgeCurve(cell.patch, i), edgeNormals(cell.patch, i), {}, other.triangle < 0};
  edge.right = edge.left;
  if (edge.is_border) return edge;
  const auto back = edgeNormals(net.cell(other.triangle, cache).patch, other.edge);
  edge.right = {back[2], back[1], back[0]};
  return edge;
}

SharpEdgePoint evaluate(const SharpEdge& edge, double s) {
  const auto& c = edge.curve;
  const double q = 1 - s;
  SharpEdgePoint x;
  x.E = c[0] * (q * q * q) + c[1] * (3 * q * q * s) + c[2] * (3 * q * s * s) + c[3] * (s * s * s);
  x.E1 = 3 * ((c[1] - c[0]) * (q * q) + (c[2] - c[1]) * (2 * q * s) + (c[3] - c[2]) * (s * s));
  x.E2 = 6 * ((c[2] - 2 * c[1] + c[0]) * q + (c[3] - 2 * c[2] + c[1]) * s);
  const auto [left, left1] = evaluateQuadratic(edge.left, s);
  const auto [right, right1] = evaluateQuadratic(edge.right, s);
  x.left = left;
  x.right = right;
  const Vec3 across = left.cross(right);
  const double sign = across.dot(x.E1) < 0 ? -1 : 1;
  const double along = kAlongEdge / (c[3] - c[0]).norm();
  x.D = sign * across + along * x.E1;
  x.D1 = sign * (left1.cross(right) + left.cross(right1)) + along * x.E2;
  return x;
}

EdgeFoot footOnEdge(const SharpEdge& edge, const Vec3& C, double s) {
  PINCER_ASSERT(edge.curve[3] != edge.curve[0]);
  const double tolerance = kEdgeTolerance * (edge.curve[3] - edge.curve[0]).norm();
  double low = -1, high = 2;  // beyond the ends: those aren't known yet
  s = std::clamp(s, 0.0, 1.0);
  for (int i = 0; i < kMaxEdgeSteps; ++i) {
    const SharpEdgePoint x = evaluate(edge, s);
    const Vec3 R = C - x.E;
    const double g = R.dot(x.D);
    (g > 0 ? low : high) = s;
    if (low == 1 || high == 0) break;  // beyond an end
    const double flat = x.E1.dot(x.D);
    const double slope = std::max(flat - R.dot(x.D1), 0.1 * flat);
    double next = std::clamp(s + g / slope, 0.0, 1.0);
    const bool is_solved = std::abs(next - s) * x.E1.norm() < tolerance;
    if (!is_solved && (next <= low || next >= high)) next = 0.5 * (low + high);
    s = next;
    if (is_solved) break;
  }
  return describe(edge, C, s);
}

FeatureContact contactWithPoint(const Vec3& C, const Vec3& p, const Vec3& outward, bool is_border, double on_feature) {
  const Vec3 R = C - p;
  const double distance = R.norm();
  if (distance < on_feature) return {outward.normalized(), R.dot(outward.normalized())};
  const double sign = is_border || R.dot(outward) >= 0 ? 1 : -1;
  return {sign / distance * R, sign * distance};
}

}  // namespace pincer::contact
