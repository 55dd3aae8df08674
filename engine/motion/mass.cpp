#include "pincer/engine/motion/mass.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::engine {
namespace {

// A solid by its moments: volume [m^3], centre [m], and the means of (x - c)(x - c)^T over the volume [m^2].
struct Moments {
  double volume;
  Vec3 centre;
  Mat3 spread;
};

Moments symmetric(double volume, const Vec3& spread) { return {volume, Vec3::Zero(), spread.asDiagonal()}; }

Moments momentsOf(const contact::Sphere& s) {
  return symmetric(4.0 / 3.0 * M_PI * s.radius * s.radius * s.radius, Vec3::Constant(s.radius * s.radius / 5));
}

Moments momentsOf(const contact::Box& b) { return symmetric(8 * b.half.prod(), b.half.cwiseAbs2() / 3); }

Moments momentsOf(const contact::Cylinder& c) {
  const double rr = c.radius * c.radius;
  return symmetric(2 * M_PI * rr * c.half_length, {rr / 4, rr / 4, c.half_length * c.half_length / 3});
}

// A cylinder and two half balls, whose means of t and t^2 along the axis, from the equator, are 3 r / 8 and r^2 / 5.
Moments momentsOf(const contact::Capsule& c) {
  const double r = c.radius, h = c.half_length;
  const double tube = 2 * M_PI * r * r * h;
  const double caps = 4.0 / 3.0 * M_PI * r * r * r;
  const double volume = tube + caps;
  const double across = (tube * r * r / 4 + caps * r * r / 5) / volume;
  const double along = (tube * h * h / 3 + caps * (h * h + 0.75 * h * r + r * r / 5)) / volume;
  return symmetric(volume, {across, across, along});
}

// The cross-section is the circular segment of half angle alpha = acos(-d / r) about -x. With
// its distance from the centre, x = r cos t:
//   A = r^2 (alpha - sin cos),   integral of |x| = (2/3) r^3 sin^3,   of x^2 = (r^4/4)(alpha - sin cos + 2 sin^3 cos),
//   of y^2 = (r^4/12)(3 alpha - 3 sin cos - 2 sin^3 cos),            sin and cos of alpha
Moments momentsOf(const contact::CylinderWithFlat& c) {
  const double r = c.radius, d = c.flat_distance;
  PINCER_ASSERT(0 < d && d < r);
  const double cosine = -d / r;
  const double sine = std::sqrt((r - d) * (r + d)) / r;
  const double alpha = math::acos(cosine);
  const double sc = sine * cosine, sssc = sine * sine * sc;
  const double area = r * r * (alpha - sc);
  const double x = -2.0 / 3.0 * r * r * r * sine * sine * sine / area;
  const double r4 = r * r * r * r;
  const double xx = r4 / 4 * (alpha - sc + 2 * sssc) / area - x * x;
  const double yy = r4 / 12 * (3 * alpha - 3 * sc - 2 * sssc) / area;
  return {2 * area * c.half_length, {x, 0, 0}, Vec3(xx, yy, c.half_length * c.half_length / 3).asDiagonal()};
}

Moments momentsOf(const contact::HalfSpace&) {
  throw InputError("A half-space has no end, so it has neither volume nor mass. Make its body static.");
}

Moments momentsOf(const contact::Dish&) {
  throw InputError(
      "A dish is all that lies outside its sphere, so it has neither volume nor mass. Make its body static.");
}

// Sums over the tetrahedra between the triangles and the mean vertex, signed. With
// edges a, b, c from there and s = a + b + c:
//   6 V = det,   24 (first moment) = det s,   120 (second moment) = det (a a^T + b b^T + c c^T + s s^T)
Moments momentsOf(const contact::TriangleMesh& mesh) {
  Vec3 origin = Vec3::Zero();
  for (const Vec3& p : mesh.vertices) origin += p / static_cast<double>(mesh.vertices.size());
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& triangle : mesh.triangles) {
    PINCER_ASSERT(
        std::all_of(triangle.begin(), triangle.end(), [&](auto v) { return isIndex(v, mesh.vertices.size()); }));
    const auto corner = [&](std::size_t k) -> Vec3 {
      return mesh.vertices[static_cast<std::size_t>(triangle[k])] - origin;
    };
    const Vec3 a = corner(0), b = corner(1), c = corner(2), s = a + b + c;
    const double det = a.dot(b.cross(c));
    volume += det / 6;
    first += det / 24 * s;
    second += det / 120 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  if (!(volume > 0))
    throw InputError(fmt::format(
        "{}: the mesh encloses a volume of {:g} m^3, which must be positive. Its triangles must bound a solid without "
        "gaps and turn counter-clockwise seen from outside.",
        mesh.source, volume));
  const Vec3 centre = first / volume;
  return {volume, origin + centre, second / volume - centre * centre.transpose()};
}

Moments momentsOf(const contact::Mesh& mesh) { return momentsOf(mesh.surface->triangles()); }

// The hull's faces as triangles.
Moments momentsOf(const contact::Convex& convex) {
  contact::TriangleMesh mesh;
  mesh.vertices = convex.hull->vertices();
  for (const contact::Polytope::Face& face : convex.hull->faces()) {
    const std::span<const int> loop = convex.hull->cornersOf(face);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) mesh.triangles.push_back({loop[0], loop[k], loop[k + 1]});
  }
  return momentsOf(mesh);
}

Moments momentsOf(const contact::Shape& shape) {
  return std::visit([](const auto& s) { return momentsOf(s); }, shape);
}

MassProperties massProperties(const Moments& moments, double mass) {
  if (!(mass > 0) || !std::isfinite(mass))
    throw InputError(
        fmt::format("mass = {} kg is out of range (0, inf). Give the body a positive mass, or make it static.", mass));
  return {mass, moments.centre, mass * (moments.spread.trace() * Mat3::Identity() - moments.spread)};
}

}  // namespace

double volumeOf(const contact::Shape& shape) { return momentsOf(shape).volume; }
double volumeOf(const contact::TriangleMesh& mesh) { return momentsOf(mesh).volume; }

MassProperties massPropertiesOf(const contact::Shape& shape, double mass) {
  return massProperties(momentsOf(shape), mass);
}
MassProperties massPropertiesOf(const contact::TriangleMesh& mesh, double mass) {
  return massProperties(momentsOf(mesh), mass);
}

MassProperties movedBy(const Pose& X_BS, const MassProperties& properties) {
  const Mat3 R = X_BS.q.toRotationMatrix(), I = R * properties.I_BBcm * R.transpose();
  return {properties.mass, X_BS * properties.p_BBcm, 0.5 * (I + I.transpose())};
}

MassProperties sumOf(std::span<const MassProperties> parts) {
  MassProperties sum;
  for (const MassProperties& part : parts) {
    sum.mass += part.mass;
    sum.p_BBcm += part.mass * part.p_BBcm;
  }
  sum.p_BBcm /= sum.mass;
  for (const MassProperties& part : parts) {
    const Vec3 arm = part.p_BBcm - sum.p_BBcm;
    sum.I_BBcm += part.I_BBcm + part.mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return sum;
}

}  // namespace pincer::engine
