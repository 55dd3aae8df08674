#include "pincer/contact/shape/convex_pairs.h"

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/direction.h"
#include "pincer/contact/shape/face_contact.h"
#include "pincer/contact/shape/facet_overlap.h"
#include "pincer/contact/shape/separation.h"

namespace pincer::contact {
namespace {

struct Segment {
  Vec3 centre, half;  // [m]; half the vector from end to end
};

Segment axisOf(const Capsule& c, const PosedSolid& s) { return {s.p, c.half_length * s.R.col(2)}; }

// Parameters in [-1, 1] of the nearest points of two segments. Source: C. Ericson, Real-Time Collision Detection
// (2005), sec. 5.1.9; parallel ones: the middle of what they share, so that round-off doesn't choose an end.
Vec2 nearestOnSegments(const Segment& a, const Segment& b) {
  constexpr double kParallel = 1e-14;  // squared sine
  const Vec3 d = b.centre - a.centre;
  const double aa = a.half.squaredNorm(), bb = b.half.squaredNorm(), ab = a.half.dot(b.half);
  const double ad = a.half.dot(d), bd = b.half.dot(d);
  const auto clamp = [](double x) { return std::min(std::max(x, -1.0), 1.0); };
  const double det = aa * bb - ab * ab;
  if (!(aa > 0)) return {0, bb > 0 ? clamp(-bd / bb) : 0};
  if (!(bb > 0)) return {clamp(ad / aa), 0};
  double s;
  if (det > kParallel * aa * bb) {
    s = clamp((ad * bb - ab * bd) / det);
  } else {
    const double reach = std::abs(ab) / aa;
    s = 0.5 * (std::max(-1.0, ad / aa - reach) + std::min(1.0, ad / aa + reach));
    s = clamp(s);
  }
  const double t = clamp((s * ab - bd) / bb);
  return {clamp((t * ab + ad) / aa), t};
}

Separation separateCapsules(const PosedSolid& a, const PosedSolid& b) {
  const Segment sa = axisOf(std::get<Capsule>(a.shape), a), sb = axisOf(std::get<Capsule>(b.shape), b);
  const Vec2 at = nearestOnSegments(sa, sb);
  const auto [n, gap] = directionOf<Vec3>(sa.centre + at.x() * sa.half - sb.centre - at.y() * sb.half, Vec3::Zero());
  if (gap > 0) return {n, gap};
  return {directionOf<Vec3>(sa.half.cross(sb.half), Vec3(a.R.col(0))).n, 0};  // the axes meet
}

// The centre's direction is a lower bound: far apart no more need be known.
bool areApart(const PosedSolid& a, const PosedSolid& b, double reach) {
  const auto [n, length] = directionOf<Vec3>(a.p - b.p, Vec3::UnitZ());
  return length > 0 && !(gapAlong(a, b, n) < reach);
}

// Both posed about the same origin.
void collidePosed(const PosedSolid& A, const PosedSolid& B, double margin, const LastPoints& last, PairPoints& out) {
  out.count = 0;
  const double size = std::min(boundingRadius(A.shape), boundingRadius(B.shape)),
               reach = margin + roundingOf(A) + roundingOf(B);
  const auto finish = [&](const Separation& s) {
    return s.gap < reach && overlapFacets(A, B, s, size, margin, last, out);
  };
  if (std::holds_alternative<Capsule>(A.shape) && std::holds_alternative<Capsule>(B.shape)) {
    finish(separateCapsules(A, B));
    return;
  }
  if (std::holds_alternative<Box>(A.shape) && std::holds_alternative<Box>(B.shape)) {
    const Separation s = separateBoxes(A, B);
    // Apart, the nearest may be two corners, or a corner and an edge: none of the 15 directions.
    if (!(s.gap < reach) || finish(s) || s.gap < 0) return;
  } else if (last.n_W == Vec3::Zero() && areApart(A, B, reach)) {
    return;
  }
  finish(separate(A, B, size, reach, last.n_W));
}

}  // namespace

void collideConvex(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin,
                   const LastPoints& last, PairPoints& out) {
  out.count = 0;
  PINCER_ASSERT(isConvex(a) && isConvex(b) && a.index() <= b.index());
  const double furthest = boundingRadius(a) + boundingRadius(b) + margin;
  const Vec3 p_BA = X_WA.p - X_WB.p;
  if (!(p_BA.squaredNorm() < furthest * furthest)) return;
  collidePosed({a, X_WA.q.toRotationMatrix(), 0.5 * p_BA}, {b, X_WB.q.toRotationMatrix(), -0.5 * p_BA}, margin, last,
               out);
  for (int i = 0; i < out.count; ++i) out.points[static_cast<std::size_t>(i)].p_W += 0.5 * (X_WA.p + X_WB.p);
}

void collidePadWithConvex(const Shape& core, double rounding, const Pose& X_BF, const Shape& body, double margin,
                          const LastPoints& last, PairPoints& out) {
  PINCER_ASSERT(isConvex(core) && isConvex(body) && rounding >= 0);
  // Half of the way each from the origin in between, as two bodies are: round-off is theirs alike.
  const PosedSolid pad{core, X_BF.q.toRotationMatrix(), 0.5 * X_BF.p, rounding},
      solid{body, Mat3::Identity(), -0.5 * X_BF.p};
  const double size = std::min(boundingRadius(core), boundingRadius(body));
  if (last.n_W == Vec3::Zero() || !touchOnFaces(pad, solid, last, size, margin, out))
    collidePosed(pad, solid, margin, last, out);
  for (int i = 0; i < out.count; ++i) out.points[static_cast<std::size_t>(i)].p_W += 0.5 * X_BF.p;
}

}  // namespace pincer::contact
