#include "pincer/contact/curve/curve.h"

#include <algorithm>
#include <limits>

#include "pincer/contact/error.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

constexpr double kSharpestBend = 90 * kDegree;     // beyond, the local centre of unequal segments leaves the inner side
constexpr double kSharpestCorner = 179 * kDegree;  // [rad]: beyond, it is folded onto itself
// [rad] of a bend, below which O counts as infinitely far: t changes by less than that
constexpr double kLeastBend = 1e-12;
constexpr double kBeyondGates = 1e-3;  // of t: so that a solution on a gate isn't at the end of the bracket
constexpr int kMaxNewton = 20, kMaxHalvings = 50;
constexpr double kSolved = 1e-14;  // of t, in the last step

Vec2 rightOf(const Vec2& e) { return {e.y(), -e.x()}; }

}  // namespace

struct Curve::Tangent {
  Vec2 F;    // foot of the centre [m]
  Vec2 n;    // unit outward normal
  double h;  // height of the centre [m]
};

Curve::Curve(const Polyline& polyline, SurfaceVariant variant) : variant_(variant), is_closed_(polyline.is_closed) {
  if (variant == SurfaceVariant::smooth_published) {
    throw InputError("curve: the variant smooth_published exists for meshes only. Allowed: smooth, facet, force.");
  }
  const CorneredPath path =
      requireSound(polyline, variant == SurfaceVariant::smooth ? kSharpestBend : kSharpestCorner, kSharpestCorner);
  addSegments(path);
  if (variant == SurfaceVariant::smooth) addBends(path);
  addGates();
}

void Curve::addSegments(const CorneredPath& path) {
  const std::vector<Vec2>& p = path.vertices;
  const std::size_t n = path.is_closed ? p.size() : p.size() - 1;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 d = p[(i + 1) % p.size()] - p[i];
    const double length = d.norm();
    const Vec2 e = d / length, right = rightOf(e);
    segments_.push_back({p[i], e, right, right, right, length});
  }
  for (std::size_t i = is_closed_ ? 0 : 1; i < n; ++i) {
    Segment &before = segments_[(i + n - 1) % n], &after = segments_[i];
    before.n_end = after.n_start = (before.n + after.n).normalized();
  }
}

void Curve::addBends(const CorneredPath& path) {
  const std::size_t n = segments_.size();
  for (std::size_t i = is_closed_ ? 0 : 1; i < n; ++i) {
    const Segment &before = segments_[(i + n - 1) % n], &after = segments_[i];
    const double a = 0.5 * before.length, b = 0.5 * after.length;
    if (path.is_sharp[i]) {
      bends_.push_back({before.start + a * before.e, after.start, after.start + b * after.e, before.e, before.n, 0, 0,
                        a, true, after.e, after.n});
      continue;
    }
    const double turn_sine = cross(before.e, after.e), turn_cosine = before.e.dot(after.e);
    const double beta = math::atan2(turn_sine, turn_cosine);
    // O lies on both bisectors, at rho from M0: rho sin(beta) = a cos(beta) + b
    const double kappa = std::abs(beta) < kLeastBend ? 0 : turn_sine / (a * turn_cosine + b);
    PINCER_ASSERT(a * turn_cosine + b > 0);  // paths turn by less than a right angle
    bends_.push_back({before.start + a * before.e, after.start, after.start + b * after.e, before.e, before.n, beta,
                      kappa, a + b * turn_cosine, false, after.e, after.n});
  }
}

void Curve::addGates() {
  const std::size_t n = segments_.size();
  if (variant_ == SurfaceVariant::smooth) {
    for (const Segment& s : segments_) gates_.push_back({s.start + 0.5 * s.length * s.e, s.e});
    return;
  }
  for (std::size_t i = 1; i < n + (is_closed_ ? 1 : 0); ++i)
    gates_.push_back({segments_[i % n].start, segments_[i - 1].e + segments_[i % n].e});
}

bool Curve::isEnd(std::int32_t cell) const {
  return !is_closed_ && (cell == 0 || cell == static_cast<std::int32_t>(gates_.size()));
}

std::int32_t Curve::nearestCell(const Vec2& C) const {
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t found = 0;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    const double along = std::clamp((C - s.start).dot(s.e), 0.0, s.length);
    const double distance2 = (C - s.start - along * s.e).squaredNorm();
    if (distance2 >= nearest) continue;
    nearest = distance2;
    found = i;
  }
  return static_cast<std::int32_t>(found);
}

std::int32_t Curve::walk(const Vec2& C, std::int32_t cell) const {
  const auto gates = static_cast<std::int32_t>(gates_.size());
  const auto ahead = [&](std::int32_t gate) {
    const Gate& g = gates_[static_cast<std::size_t>(gate)];
    return (C - g.p).dot(g.d);
  };
  std::int32_t steps = 0;
  for (; steps < gates && (is_closed_ || cell < gates) && ahead(cell) > 0; ++steps)
    cell = is_closed_ && cell + 1 == gates ? 0 : cell + 1;
  if (steps > 0) return cell;
  for (; steps < gates && (is_closed_ || cell > 0); ++steps) {
    const std::int32_t last = cell > 0 ? cell - 1 : gates - 1;
    if (!(ahead(last) < 0)) break;
    cell = last;
  }
  return cell;
}

Curve::Tangent Curve::onSegment(const Segment& segment, const Vec2& C) const {
  const double h = (C - segment.start).dot(segment.n);
  return {C - h * segment.n, segment.n, h};
}

Curve::Tangent Curve::onBend(const Bend& bend, const Vec2& C, double& t) const {
  const Vec2 d0 = bend.P - bend.M0, d1 = bend.M1 - bend.P;
  double low = -kBeyondGates, high = 1 + kBeyondGates;
  Tangent line{};
  for (int i = 0; i < kMaxNewton + kMaxHalvings; ++i) {
    const Vec2 A = bend.M0 + t * d0, B = bend.P + t * d1, D = B - A;  // de Casteljau
    const double length2 = D.squaredNorm();
    const Vec2 T = D / std::sqrt(length2), N = rightOf(T), R = C - A - t * D;
    // dT/dt = -turning N, dN/dt = turning T
    const double h = R.dot(N), along = R.dot(T), turning = cross(d0, d1) / length2;
    line = {C - h * N, N, h};
    const Vec2 dF = -turning * (along * N + h * T);
    const double x = (line.F - bend.M0).dot(bend.e), y = (line.F - bend.M0).dot(bend.n);
    const double dx = dF.dot(bend.e), dy = dF.dot(bend.n);
    double t_of_F = x / bend.reach, slope = dx / bend.reach;
    if (bend.kappa != 0) {
      const double u = bend.kappa * x, w = 1 + bend.kappa * y;
      t_of_F = math::atan2(u, w) / bend.beta;
      slope = bend.kappa * (w * dx - u * dy) / ((u * u + w * w) * bend.beta);
    }
    const double ahead = t_of_F - t;
    (ahead > 0 ? low : high) = t;
    double next = t + ahead / (1 - slope);
    if (!(next > low && next < high) || i >= kMaxNewton) next = 0.5 * (low + high);
    const bool is_solved = std::abs(next - t) <= kSolved;
    t = next;
    if (is_solved) break;
  }
  return line;
}

// One of the two segments, where the finger's centre is over it, in a hollow
// the nearer; between them the corner itself.
Curve::Tangent Curve::onCorner(const Bend& bend, const Vec2& C) {
  const Vec2 from = C - bend.P;
  const double h_before = from.dot(bend.n), h_after = from.dot(bend.n_after);
  const Tangent before{C - h_before * bend.n, bend.n, h_before},
      after{C - h_after * bend.n_after, bend.n_after, h_after};
  const bool over_before = from.dot(bend.e) <= 0, over_after = from.dot(bend.e_after) >= 0;
  if (over_before && over_after) return h_before < h_after ? before : after;
  if (over_before) return before;
  if (over_after) return after;
  const double distance = from.norm();  // > 0: neither product is 0
  return {bend.P, from / distance, distance};
}

// Contact with the end point itself: the finger rolls over it, as over an open border of a mesh.
Curve::Tangent Curve::beyondEnd(const Tangent& line, const Vec2& C, std::int32_t cell) const {
  const Segment& segment = cell == 0 ? segments_.front() : segments_.back();
  const double along = (line.F - segment.start).dot(segment.e);
  const bool is_before = cell == 0 && along < 0;
  const bool is_behind = cell == static_cast<std::int32_t>(gates_.size()) && along > segment.length;
  if (!is_before && !is_behind) return line;
  const Vec2 end = is_before ? segment.start : segment.start + segment.length * segment.e;
  const double distance = (C - end).norm();
  return {end, (C - end) / distance, distance};  // > 0: C isn't straight above or below the end
}

CurveContact Curve::follow(const Vec2& C, double r, CurveTracker& tracker) const {
  const std::int32_t reached = walk(C, tracker.cell);
  if (reached != tracker.cell) tracker = {reached, 0.5};
  const auto cell = static_cast<std::size_t>(tracker.cell);
  Tangent line;
  if (variant_ == SurfaceVariant::smooth && !isEnd(tracker.cell)) {
    const Bend& bend = bends_[is_closed_ ? cell : cell - 1];
    line = bend.is_corner ? onCorner(bend, C) : onBend(bend, C, tracker.t);
  } else {
    line = onSegment(segments_[std::min(cell, segments_.size() - 1)], C);
    if (isEnd(tracker.cell)) line = beyondEnd(line, C, tracker.cell);
  }
  Vec2 n = line.n;
  if (variant_ == SurfaceVariant::force) {
    const Segment& s = segments_[cell];
    const double share = std::clamp((line.F - s.start).dot(s.e) / s.length, 0.0, 1.0);
    if (line.n == s.n) n = ((1 - share) * s.n_start + share * s.n_end).normalized();
  }
  return {line.F, n, line.h - r, math::atan2(-line.n.x(), line.n.y())};
}

CurveContact Curve::queryCircle(const Vec2& p_BC, double r, CurveTracker& tracker) const {
  PINCER_ASSERT(r > 0 && p_BC.allFinite());
  PINCER_ASSERT(tracker.cell <= static_cast<std::int32_t>(gates_.size()));
  if (tracker.cell >= 0) {
    const CurveContact followed = follow(p_BC, r, tracker);
    if (followed.phi <= 0) return followed;
    CurveTracker other{nearestCell(p_BC), 0.5};
    if (other.cell == tracker.cell) return followed;
    const CurveContact found = follow(p_BC, r, other);
    if (!(found.phi < followed.phi) || other.cell == tracker.cell) return followed;
    tracker = other;
    return found;
  }
  tracker = {nearestCell(p_BC), 0.5};
  return follow(p_BC, r, tracker);
}

}  // namespace pincer::contact
