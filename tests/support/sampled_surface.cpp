#include "pincer/tests/support/sampled_surface.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace pincer::tests {
namespace {

using contact::Box;
using contact::Capsule;
using contact::Convex;
using contact::Cylinder;
using contact::CylinderWithFlat;
using contact::Dish;
using contact::HalfSpace;
using contact::Mesh;
using contact::Shape;
using contact::Sphere;

constexpr double kPi = std::numbers::pi;

double lerp(double a, double b, double t) { return a + t * (b - a); }

// The square [-1, 1]^2 to polar coordinates of the unit disc, without the usual crowding at the pole,
// where the zoom would lose its way. Source: P. Shirley, K. Chiu, "A low distortion map between disk
// and square", J. Graphics Tools 2(3), 1997.
struct Polar {
  double rho, angle;  // [-], [rad]
};
Polar polarFromSquare(double s, double t) {
  if (s == 0 && t == 0) return {0, 0};
  if (std::abs(s) >= std::abs(t)) return {std::abs(s), (s < 0 ? kPi : 0) + kPi / 4 * t / s};
  return {std::abs(t), (t < 0 ? -1 : 1) * kPi / 2 - kPi / 4 * s / t};
}

// The unit disc, a quarter of its square per patch, carried onto a surface by `point(rho, angle)`.
void addDisc(std::vector<Patch>& patches, const std::function<Vec3(double rho, double angle)>& point) {
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-1.0, 1.0}) {
      patches.push_back({[=](double u, double v) {
        const Polar p = polarFromSquare(s * u, t * v);
        return point(p.rho, p.angle);
      }});
    }
  }
}

// Half of a sphere about (0, 0, centre), above it (up = 1) or below (up = -1).
void addHemisphere(std::vector<Patch>& patches, double r, double centre, double up) {
  addDisc(patches, [=](double rho, double angle) {
    const double polar = rho * kPi / 2;
    return Vec3(r * std::sin(polar) * std::cos(angle), r * std::sin(polar) * std::sin(angle),
                centre + up * r * std::cos(polar));
  });
}

// All that lies within `border(angle)` of the z axis at height z.
void addEnd(std::vector<Patch>& patches, double z, const std::function<double(double angle)>& border) {
  addDisc(patches, [=](double rho, double angle) {
    const double r = rho * border(angle);
    return Vec3(r * std::cos(angle), r * std::sin(angle), z);
  });
}

// The round wall |z| <= h between two angles.
void addWall(std::vector<Patch>& patches, double r, double h, double from = 0, double to = 2 * kPi) {
  for (int part = 0; part < 4; ++part) {
    patches.push_back({[=](double u, double v) {
      const double a = lerp(from, to, (part + u) / 4);
      return Vec3(r * std::cos(a), r * std::sin(a), lerp(-h, h, v));
    }});
  }
}

void addRectangle(std::vector<Patch>& patches, const Vec3& corner, const Vec3& a, const Vec3& b) {
  patches.push_back({[=](double u, double v) { return Vec3(corner + u * a + v * b); }});
}

std::vector<Patch> sphereAbout(double r, double centre) {
  std::vector<Patch> patches;
  addHemisphere(patches, r, centre, 1);
  addHemisphere(patches, r, centre, -1);
  return patches;
}

std::vector<Patch> patchesOf(const Sphere& s) { return sphereAbout(s.radius, 0); }
std::vector<Patch> patchesOf(const Dish& d) { return sphereAbout(d.radius, d.radius); }

std::vector<Patch> patchesOf(const Capsule& c) {
  std::vector<Patch> patches;
  addHemisphere(patches, c.radius, c.half_length, 1);
  addHemisphere(patches, c.radius, -c.half_length, -1);
  addWall(patches, c.radius, c.half_length);
  return patches;
}

std::vector<Patch> patchesOf(const Box& b) {
  std::vector<Patch> patches;
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = 2 * b.half[(i + 1) % 3] * Vec3::Unit((i + 1) % 3);
    const Vec3 c = 2 * b.half[(i + 2) % 3] * Vec3::Unit((i + 2) % 3);
    addRectangle(patches, -b.half, a, c);
    addRectangle(patches, b.half, -a, -c);
  }
  return patches;
}

std::vector<Patch> patchesOf(const Cylinder& c) {
  std::vector<Patch> patches;
  addWall(patches, c.radius, c.half_length);
  for (const double z : {-c.half_length, c.half_length}) addEnd(patches, z, [=](double) { return c.radius; });
  return patches;
}

std::vector<Patch> patchesOf(const CylinderWithFlat& c) {
  const double R = c.radius, d = c.flat_distance, h = c.half_length;
  const double open = std::acos(d / R);  // half the angle that the flat takes from the round
  const double w = R * std::sin(open);
  std::vector<Patch> patches;
  addWall(patches, R, h, open, 2 * kPi - open);
  addRectangle(patches, {d, -w, -h}, {0, 2 * w, 0}, {0, 0, 2 * h});
  const auto border = [=](double angle) { return std::cos(angle) * R > d ? d / std::cos(angle) : R; };
  for (const double z : {-h, h}) addEnd(patches, z, border);
  return patches;
}

std::vector<Patch> patchesOf(const HalfSpace&) {
  std::vector<Patch> patches;
  addRectangle(patches, {-0.5, -0.5, 0}, Vec3::UnitX(), Vec3::UnitY());
  return patches;
}

// A triangle as three quadrilaterals that meet in its middle: none has a side of no
// length, near which the zoom would lose its way.
void addTriangle(std::vector<Patch>& patches, const std::array<Vec3, 3>& p) {
  const Vec3 middle = (p[0] + p[1] + p[2]) / 3;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 corner = p[i], next = (p[i] + p[(i + 1) % 3]) / 2, before = (p[i] + p[(i + 2) % 3]) / 2;
    patches.push_back({[=](double u, double v) {
      return Vec3((1 - u) * (1 - v) * corner + u * (1 - v) * next + u * v * middle + (1 - u) * v * before);
    }});
  }
}

// Each face as a fan of triangles.
std::vector<Patch> patchesOf(const Convex& c) {
  std::vector<Patch> patches;
  const auto corner = [&](int vertex) { return c.hull->vertices()[static_cast<std::size_t>(vertex)]; };
  for (const contact::Polytope::Face& face : c.hull->faces()) {
    const std::span<const int> loop = c.hull->cornersOf(face);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k)
      addTriangle(patches, {corner(loop[0]), corner(loop[k]), corner(loop[k + 1])});
  }
  return patches;
}

std::vector<Patch> patchesOf(const Mesh&) { throw std::invalid_argument("a mesh has no exact patches"); }

bool holds(const Sphere& s, const Vec3& q) { return q.squaredNorm() <= s.radius * s.radius; }
bool holds(const Dish& d, const Vec3& q) { return (q - d.radius * Vec3::UnitZ()).squaredNorm() >= d.radius * d.radius; }
bool holds(const HalfSpace&, const Vec3& q) { return q.z() <= 0; }
bool holds(const Box& b, const Vec3& q) {
  return std::abs(q.x()) <= b.half.x() && std::abs(q.y()) <= b.half.y() && std::abs(q.z()) <= b.half.z();
}
bool holds(const Cylinder& c, const Vec3& q) {
  return q.x() * q.x() + q.y() * q.y() <= c.radius * c.radius && std::abs(q.z()) <= c.half_length;
}
bool holds(const CylinderWithFlat& c, const Vec3& q) {
  return q.x() <= c.flat_distance && holds(Cylinder{c.radius, c.half_length}, q);
}
bool holds(const Capsule& c, const Vec3& q) {
  const Sphere end{c.radius};
  return holds(Cylinder{c.radius, c.half_length}, q) || holds(end, q - c.half_length * Vec3::UnitZ()) ||
         holds(end, q + c.half_length * Vec3::UnitZ());
}
bool holds(const Convex& c, const Vec3& q) {
  return std::all_of(c.hull->faces().begin(), c.hull->faces().end(),
                     [&](const auto& face) { return face.n.dot(q) <= face.d; });
}
bool holds(const Mesh&, const Vec3&) { throw std::invalid_argument("a mesh has no exact inside"); }

struct Cell {
  double u = 0.5, v = 0.5, half = 0.5;  // centre and half width
};

using Field = std::function<double(const Vec3&)>;

// The best of n x n samples of the cell; the samples include its border, cut to [0, 1].
double bestSample(const Patch& patch, const Field& f, int n, Cell& cell) {
  double best = std::numeric_limits<double>::infinity();
  Cell next;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = std::clamp(cell.u + cell.half * (2.0 * i / (n - 1) - 1), 0.0, 1.0);
      const double v = std::clamp(cell.v + cell.half * (2.0 * j / (n - 1) - 1), 0.0, 1.0);
      const double value = f(patch.point(u, v));
      if (value < best) best = value, next.u = u, next.v = v;
    }
  }
  next.half = cell.half * 4 / (n - 1);  // two samples to either side
  cell = next;
  return best;
}

double minimumOn(const Patch& patch, const Field& f) {
  Cell cell;
  double best = bestSample(patch, f, 17, cell);
  while (cell.half > 1e-9) best = std::min(best, bestSample(patch, f, 9, cell));
  return best;
}

}  // namespace

SampledSurface::SampledSurface(const Shape& shape)
    : patches_(std::visit([](const auto& s) { return patchesOf(s); }, shape)),
      contains_([shape](const Vec3& q) { return std::visit([&](const auto& s) { return holds(s, q); }, shape); }) {}

double SampledSurface::minimum(const Field& f) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Patch& patch : patches_) best = std::min(best, minimumOn(patch, f));
  return best;
}

double SampledSurface::signedDistance(const Vec3& q) const {
  const double distance = std::sqrt(minimum([&](const Vec3& p) { return (p - q).squaredNorm(); }));
  return contains(q) ? -distance : distance;
}

std::shared_ptr<const contact::Polytope> voussoir() {
  const std::vector<Vec3> points = {{-0.02, -0.015, -0.018}, {0.02, -0.015, -0.018}, {0.026, -0.015, 0.016},
                                    {-0.026, -0.015, 0.016}, {-0.02, 0.015, -0.018}, {0.02, 0.015, -0.018},
                                    {0.026, 0.015, 0.016},   {-0.026, 0.015, 0.016}};
  return contact::Polytope::hullOf(points, "voussoir");
}

const std::vector<NamedShape>& sampleConvexSolids() {
  static const std::vector<NamedShape> shapes = {{"sphere", Sphere{0.021}},
                                                 {"box", Box{{0.031, 0.017, 0.023}}},
                                                 {"capsule", Capsule{0.013, 0.029}},
                                                 {"cylinder", Cylinder{0.024, 0.019}},
                                                 {"slim cylinder", Cylinder{0.011, 0.037}},
                                                 {"cylinder with a flat", CylinderWithFlat{0.025, 0.027, 0.014}},
                                                 {"cylinder with a wide flat", CylinderWithFlat{0.025, 0.012, 0.004}},
                                                 {"convex hull", Convex{voussoir()}}};
  return shapes;
}

const std::vector<NamedShape>& samplePrimitives() {
  static const std::vector<NamedShape> shapes = [] {
    std::vector<NamedShape> all = sampleConvexSolids();
    all.push_back({"half-space", HalfSpace{}});
    all.push_back({"dish", Dish{0.15}});
    return all;
  }();
  return shapes;
}

}  // namespace pincer::tests
