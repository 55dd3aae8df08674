#include "pincer/contact/shape/convex_features.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

constexpr double kInset = 0.05;  // of the least half width: how far insetOf moves the faces
constexpr double kCos = 0.92387953251128674, kSin = 0.38268343236508977;  // of 2 pi / kRimCorners

Vec2 unitOr(const Vec2& v, const Vec2& otherwise) {
  const double length = v.norm();
  return length > kNoAngle ? Vec2(v / length) : otherwise;
}

// Furthest point of the disc of radius r along d; its centre where d has no direction.
Vec2 onDisc(double r, const Vec2& d) {
  const double length = d.norm();
  return length > 0 ? Vec2(r / length * d) : Vec2(Vec2::Zero());
}

Vec2 nextOnRim(const Vec2& p) { return {kCos * p.x() - kSin * p.y(), kSin * p.x() + kCos * p.y()}; }

Vec3 boxSupport(const Vec3& half, const Vec3& d) {
  return {signOf(d.x()) * half.x(), signOf(d.y()) * half.y(), signOf(d.z()) * half.z()};
}

// Cores without a rim have corners only.
template <class Solid>
Mat3 bend(const Solid&, const Vec3&) {
  return Mat3::Zero();
}

// Second derivative of R |d_xy| at the unit vector d.
Mat3 rimBend(double radius, const Vec3& d) {
  const double length = d.head<2>().norm();
  Mat3 H = Mat3::Zero();
  if (!(length > kNoAngle)) return H;
  const Vec2 across(-d.y() / length, d.x() / length);
  H.topLeftCorner<2, 2>() = radius / length * across * across.transpose();
  return H;
}

// --- sphere and capsule: a point and a segment, rounded

double rounding(const Sphere& s) { return s.radius; }
double rounding(const Capsule& c) { return c.radius; }
template <class Solid>
double rounding(const Solid&) {
  return 0;
}

Vec3 support(const Sphere&, const Vec3&) { return Vec3::Zero(); }
Vec3 inset(const Sphere&, const Vec3&) { return Vec3::Zero(); }
void facet(const Sphere&, const Vec3&, Facet& f) { f.add(Vec3::Zero(), 0, 0); }
void strata(const Sphere&, const Vec3&, Strata&) {}

Vec3 support(const Capsule& c, const Vec3& d) { return {0, 0, signOf(d.z()) * c.half_length}; }
Vec3 inset(const Capsule& c, const Vec3& d) { return support(c, d); }
void facet(const Capsule& c, const Vec3& d, Facet& f) {
  constexpr double kUpended = 0.9999;  // cosine: seen along d the segment is a point
  const double z = signOf(d.z()) * c.half_length;
  f.add({0, 0, z}, z < 0, 0);
  if (c.half_length > 0 && std::abs(d.z()) < kUpended * d.norm()) f.add({0, 0, -z}, z >= 0, 0);
  f.line_radius = c.radius;
}
void strata(const Capsule& c, const Vec3&, Strata& s) {
  if (c.half_length > 0) s.addEdge(Vec3::UnitZ());
}

// --- box: corners by the bits of their signs; edges 4 along each axis

Vec3 support(const Box& b, const Vec3& d) { return boxSupport(b.half, d); }
Vec3 inset(const Box& b, const Vec3& d) { return boxSupport(b.half.array() - kInset * b.half.minCoeff(), d); }
void facet(const Box& b, const Vec3& d, Facet& f) {
  const Vec3 size = d.cwiseAbs();
  const int i = size.z() >= size.x() && size.z() >= size.y() ? 2 : size.y() >= size.x() ? 1 : 0;
  const double sign = signOf(d[i]);
  const int j = sign > 0 ? (i + 1) % 3 : (i + 2) % 3, k = 3 - i - j;  // i, j, k right-handed about the outward normal
  f.n = sign * Vec3::Unit(i);
  constexpr std::array<std::array<int, 2>, 4> loop = {{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  for (const auto& [sj, sk] : loop) {
    // Where it belongs at once: a vector that is copied right after its numbers were written is waited for.
    FacetCorner& corner = f.corners[static_cast<std::size_t>(f.count++)];
    corner.p[i] = sign * b.half[i];
    corner.p[j] = sj * b.half[j];
    corner.p[k] = sk * b.half[k];
    const int vertex = (sign > 0) << i | (sj > 0) << j | (sk > 0) << k;
    const int along = sj == sk ? j : k;        // the edge to the next corner
    const int fixed = vertex & ~(1 << along);  // and the two signs that it keeps
    corner.vertex = static_cast<std::uint16_t>(vertex);
    corner.edge = static_cast<std::uint16_t>(8 * along + fixed);
  }
}
void strata(const Box&, const Vec3& d, Strata& s) {
  for (int i = 0; i < 3; ++i) {
    s.addNormal(signOf(d[i]) * Vec3::Unit(i));
    s.addEdge(Vec3::Unit(i));
  }
}

// --- cylinders: corners of an end 32 e + k, e = 0 at +z, those of the flat k = 16 (y
// > 0) and 17; lines of the wall from 64 on

Vec3 cylinderSupport(double radius, double half_length, const Vec3& d) {
  const Vec2 p = onDisc(radius, d.head<2>());
  return {p.x(), p.y(), signOf(d.z()) * half_length};
}
bool facesEnd(const Vec3& d) { return std::abs(d.z()) > d.head<2>().norm(); }

// A straight line of the wall, its end in the direction of d first.
void addLine(const Vec2& p, double half_length, const Vec3& d, int name, Facet& f) {
  const double z = signOf(d.z()) * half_length;
  f.add({p.x(), p.y(), z}, name + (z < 0), name);
  f.add({p.x(), p.y(), -z}, name + (z >= 0), name);
}

struct OutlinePoint {
  Vec2 p;
  int name;  // of the point; of the edge to the next as well
};

// An end's outline, given counter-clockwise seen from +z.
template <std::size_t N>
void addEnd(const std::array<OutlinePoint, N>& outline, int count, double half_length, bool up, Facet& f) {
  const int base = up ? 0 : 32;
  f.n = up ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ());
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(up ? i : count - 1 - i);
    // to the next in this order
    const std::size_t edge = up ? at : at == 0 ? static_cast<std::size_t>(count) - 1 : at - 1;
    const OutlinePoint& o = outline[at];
    f.add({o.p.x(), o.p.y(), up ? half_length : -half_length}, base + o.name, base + outline[edge].name);
  }
}

Vec3 support(const Cylinder& c, const Vec3& d) { return cylinderSupport(c.radius, c.half_length, d); }
Vec3 inset(const Cylinder& c, const Vec3& d) {
  const double in = kInset * std::min(c.radius, c.half_length);
  return cylinderSupport(c.radius - in, c.half_length - in, d);
}
void facet(const Cylinder& c, const Vec3& d, Facet& f) {
  if (!facesEnd(d)) {
    f.line_radius = c.radius;
    return addLine(c.radius * unitOr(d.head<2>(), Vec2::UnitX()), c.half_length, d, 64, f);
  }
  Vec2 p = startOfRim(c.radius, d.head<2>(), kBetweenSixteen);
  f.rim_radius = c.radius;
  std::array<OutlinePoint, kRimCorners> outline;
  for (int k = 0; k < kRimCorners; ++k, p = nextOnRim(p)) outline[static_cast<std::size_t>(k)] = {p, k};
  addEnd(outline, kRimCorners, c.half_length, d.z() > 0, f);
}
void strata(const Cylinder&, const Vec3& d, Strata& s) {
  s.addNormal(signOf(d.z()) * Vec3::UnitZ());
  s.addEdge(Vec3::UnitZ());
}
Mat3 bend(const Cylinder& c, const Vec3& d) { return rimBend(c.radius, d); }

double halfChord(double radius, double flat_distance) {
  return std::sqrt((radius - flat_distance) * (radius + flat_distance));
}

Vec3 cutSupport(double radius, double half_length, double flat_distance, const Vec3& d) {
  Vec3 p = cylinderSupport(radius, half_length, d);
  if (p.x() > flat_distance) p.x() = flat_distance, p.y() = signOf(d.y()) * halfChord(radius, flat_distance);
  return p;
}

Vec3 support(const CylinderWithFlat& c, const Vec3& d) {
  return cutSupport(c.radius, c.half_length, c.flat_distance, d);
}
Vec3 inset(const CylinderWithFlat& c, const Vec3& d) {
  const double in = kInset * std::min({c.radius, c.half_length, c.flat_distance});
  return cutSupport(c.radius - in, c.half_length - in, c.flat_distance - in, d);
}

// The arc's points in their order from the flat's upper corner round to its lower one.
void cutEnd(const CylinderWithFlat& c, const Vec3& d, Facet& f) {
  std::array<OutlinePoint, kRimCorners + 2> outline;
  int count = 0;
  const double w = halfChord(c.radius, c.flat_distance);
  outline[static_cast<std::size_t>(count++)] = {{c.flat_distance, w}, 16};
  std::array<Vec2, kRimCorners> rim;
  rim[0] = startOfRim(c.radius, d.head<2>(), kBetweenSixteen);
  for (std::size_t k = 1; k < rim.size(); ++k) rim[k] = nextOnRim(rim[k - 1]);
  std::size_t start = 0;  // the first at or after +x
  for (std::size_t k = 0; k < rim.size(); ++k) {
    if (rim[k].x() > 0 && rim[k].y() >= 0 && rim[(k + rim.size() - 1) % rim.size()].y() < 0) start = k;
  }
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const std::size_t k = (start + i) % rim.size();
    if (rim[k].x() < c.flat_distance) outline[static_cast<std::size_t>(count++)] = {rim[k], static_cast<int>(k)};
  }
  outline[static_cast<std::size_t>(count++)] = {{c.flat_distance, -w}, Facet::kFlatEdge};
  f.rim_radius = c.radius;
  addEnd(outline, count, c.half_length, d.z() > 0, f);
}

void cutWall(const CylinderWithFlat& c, const Vec3& d, Facet& f) {
  const double w = halfChord(c.radius, c.flat_distance);
  const double cosine = c.flat_distance / c.radius;  // of the flat's half angle
  const Vec2 u = unitOr(d.head<2>(), Vec2::UnitX());
  if (u.x() <= cosine) {
    f.line_radius = c.radius;
    return addLine(c.radius * u, c.half_length, d, 64, f);
  }
  if (u.x() < std::sqrt(0.5 * (1 + cosine)))
    return addLine({c.flat_distance, signOf(u.y()) * w}, c.half_length, d, u.y() < 0 ? 66 : 68, f);
  f.n = Vec3::UnitX();
  constexpr std::array<std::array<int, 2>, 4> loop = {{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  int name = 70;
  for (const auto& [y, z] : loop) f.add({c.flat_distance, y * w, z * c.half_length}, name, name), ++name;
}

void facet(const CylinderWithFlat& c, const Vec3& d, Facet& f) { facesEnd(d) ? cutEnd(c, d, f) : cutWall(c, d, f); }
void strata(const CylinderWithFlat&, const Vec3& d, Strata& s) {
  s.addNormal(signOf(d.z()) * Vec3::UnitZ());
  if (d.x() > 0) s.addNormal(Vec3::UnitX());
  s.addEdge(Vec3::UnitZ());
  s.addEdge(Vec3::UnitY());
}
Mat3 bend(const CylinderWithFlat& c, const Vec3& d) {
  return c.radius * d.x() > c.flat_distance * d.head<2>().norm() ? Mat3(Mat3::Zero()) : rimBend(c.radius, d);
}

// --- convex hull

const Vec3& vertexOf(const Polytope& hull, int i) { return hull.vertices()[static_cast<std::size_t>(i)]; }

Vec3 support(const Convex& c, const Vec3& d) { return vertexOf(*c.hull, c.hull->extremeVertex(d)); }
Vec3 inset(const Convex& c, const Vec3& d) {
  const std::vector<Vec3>& corners = c.hull->insetVertices();
  std::size_t best = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (d.dot(corners[i]) > d.dot(corners[best])) best = i;
  }
  return corners[best];
}

// Of a face with very many corners every n-th is taken.
void addFace(const Polytope& hull, const Polytope::Face& face, Facet& f) {
  f.n = face.n;
  const std::span<const int> corners = hull.cornersOf(face), edges = hull.edgesOf(face);
  const std::size_t stride = (corners.size() + Facet::kMost - 1) / Facet::kMost;
  for (std::size_t k = 0; k < corners.size(); k += stride) f.add(vertexOf(hull, corners[k]), corners[k], edges[k]);
}

// One of the faces around a vertex, another one for each of its edges.
int faceBeside(const Polytope::Edge& edge, int vertex) { return edge.from == vertex ? edge.left : edge.right; }

const Polytope::Face& faceTowards(const Polytope& hull, int vertex, const Vec3& d) {
  const Polytope::Face* best = nullptr;
  double most = 0;
  for (const int e : hull.edgesAt(vertex)) {
    const int i = faceBeside(hull.edges()[static_cast<std::size_t>(e)], vertex);
    const Polytope::Face& face = hull.faces()[static_cast<std::size_t>(i)];
    const double x = d.dot(face.n);
    if (!best || x > most) most = x, best = &face;
  }
  PINCER_ASSERT(best);  // every corner of a hull has edges
  return *best;
}

bool isAcross(const Polytope& hull, const Vec3& d, int e) {
  const Polytope::Edge& edge = hull.edges()[static_cast<std::size_t>(e)];
  const Vec3 along = vertexOf(hull, edge.to) - vertexOf(hull, edge.from);
  const double x = d.dot(along);
  return x * x < kNoAngle * kNoAngle * d.squaredNorm() * along.squaredNorm();
}

// The face around a vertex with most edges that d is across; of several the one that faces d most.
const Polytope::Face& faceAcross(const Polytope& hull, int vertex, const Vec3& d) {
  const std::span<const int> edges_here = hull.edgesAt(vertex);
  const double length = d.norm();
  const auto score = [&](int face) {
    double sum = d.dot(hull.faces()[static_cast<std::size_t>(face)].n) / length;
    for (const int e : edges_here) {
      const Polytope::Edge& edge = hull.edges()[static_cast<std::size_t>(e)];
      if ((edge.left == face || edge.right == face) && isAcross(hull, d, e)) sum += 2;
    }
    return sum;
  };
  int best = -1;
  double most = 0;
  for (const int e : edges_here) {
    const int i = faceBeside(hull.edges()[static_cast<std::size_t>(e)], vertex);
    const double s = score(i);
    if (best < 0 || s > most) most = s, best = i;
  }
  return hull.faces()[static_cast<std::size_t>(best)];
}

// The face around the extreme vertex that faces d most; but where d is across an edge and isn't the face's normal, one
// of the two that the edge joins.
void facet(const Convex& c, const Vec3& d, Facet& f) {
  constexpr double kAlong = 1 - 1e-13;  // cosine: round-off; then d is across all of the face's edges
  const Polytope& hull = *c.hull;
  const int vertex = hull.extremeVertex(d);
  const Polytope::Face& towards = faceTowards(hull, vertex, d);
  const auto is_across = [&](int e) { return isAcross(hull, d, e); };
  const bool is_face = d.dot(towards.n) >= kAlong * d.norm() || std::ranges::none_of(hull.edgesAt(vertex), is_across);
  addFace(hull, is_face ? towards : faceAcross(hull, vertex, d), f);
}

// Faces and edges around the extreme vertex.
void strata(const Convex& c, const Vec3& d, Strata& s) {
  const Polytope& hull = *c.hull;
  const int vertex = hull.extremeVertex(d);
  for (const int e : hull.edgesAt(vertex)) {
    const Polytope::Edge& edge = hull.edges()[static_cast<std::size_t>(e)];
    if (s.with_edges) s.addEdge((vertexOf(hull, edge.to) - vertexOf(hull, edge.from)).normalized());
    s.addNormal(hull.faces()[static_cast<std::size_t>(faceBeside(edge, vertex))].n);
  }
}

template <class Solid>
constexpr bool kConvex =
    // The rest has features.
    !std::is_same_v<Solid, HalfSpace> && !std::is_same_v<Solid, Dish> && !std::is_same_v<Solid, Mesh>;

// Calls f on the solid that `shape` is; a default result where that isn't convex.
template <class F>
auto onConvex(const Shape& shape, F f) {
  using Result = decltype(f(std::declval<const Box&>()));
  PINCER_ASSERT(isConvex(shape));  // the others have no features
  return std::visit(
      [&](const auto& solid) -> Result {
        if constexpr (kConvex<std::decay_t<decltype(solid)>>)
          return f(solid);
        else if constexpr (std::is_void_v<Result>)
          return;
        else
          return Result();
      },
      shape);
}

}  // namespace

bool isConvex(const Shape& shape) {
  return std::visit([](const auto& solid) { return kConvex<std::decay_t<decltype(solid)>>; }, shape);
}
double roundingOf(const Shape& shape) {
  return onConvex(shape, [](const auto& s) -> double { return rounding(s); });
}
Vec3 supportOf(const Shape& shape, const Vec3& d) {
  return onConvex(shape, [&](const auto& s) -> Vec3 { return support(s, d); });
}
Vec3 insetOf(const Shape& shape, const Vec3& d) {
  return onConvex(shape, [&](const auto& s) -> Vec3 { return inset(s, d); });
}
void facetOf(const Shape& shape, const Vec3& d, Facet& f) {
  f.count = 0;
  f.line_radius = f.rim_radius = 0;
  onConvex(shape, [&](const auto& s) -> void { facet(s, d, f); });
}

// A point of the circle lies outside of one side of a polygon in it, the one that spans it. The flat's side spans none.
void addRimCorner(const Vec2& towards, Facet& f) {
  const double length = towards.norm();
  if (!(length > 0) || f.count + 1 > Facet::kMost) return;
  PINCER_ASSERT(f.rim_radius > 0);
  const Vec2 rim = f.rim_radius / length * towards;
  const double up = f.n.z();
  for (int i = 0; i < f.count; ++i) {
    const FacetCorner& from = f.corners[static_cast<std::size_t>(i)];
    const FacetCorner& next = f.corners[static_cast<std::size_t>((i + 1) % f.count)];
    const Vec2 p = from.p.head<2>(), q = next.p.head<2>(), side = q - p;
    if (!(up * cross(side, rim - p) < 0)) continue;
    const bool is_there = (rim - p).norm() < kNoAngle * f.rim_radius || (rim - q).norm() < kNoAngle * f.rim_radius;
    if (f.isStraight(i) || is_there || !(up * cross(side, towards - p) < 0)) return;
    const auto at = f.corners.begin() + i + 1;
    std::copy_backward(at, f.corners.begin() + f.count, f.corners.begin() + f.count + 1);
    const auto name = static_cast<std::uint16_t>((from.vertex & 32) + 18 + f.count % 8);
    *at = {{rim.x(), rim.y(), from.p.z()}, name, name};
    ++f.count;
    return;
  }
}

void strataOf(const Shape& shape, const Vec3& d, Strata& found) {
  found.normal_count = found.edge_count = 0;
  onConvex(shape, [&](const auto& s) -> void { strata(s, d, found); });
}
Mat3 bendOf(const Shape& shape, const Vec3& d) {
  PINCER_ASSERT(isUnitIfFinite(d));
  return onConvex(shape, [&](const auto& s) -> Mat3 { return bend(s, d); });
}
bool isRound(const Shape& shape) {
  return std::holds_alternative<Cylinder>(shape) || std::holds_alternative<CylinderWithFlat>(shape);
}

}  // namespace pincer::contact
