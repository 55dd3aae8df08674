// The smooth surface against the one that the mesh was made from, and against itself across edges.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/lathe.h"
#include "pincer/contact/surface/surface_net.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/objects.h"
#include "pincer/tasks/judge/bench/sweep.h"

namespace pincer::tasks {
namespace {

using contact::SmoothMesh;
using contact::SurfaceNet;
using contact::SurfaceVariant;

constexpr double kBenchBall = 0.02;  // radius of spheres [m]
constexpr double kDepthOff = 0.05;   // promised of depth on walls and rims [um]

std::vector<Record> sphereErrors(const contact::TriangleMesh& sphere, double position_bound) {
  constexpr double kDepth = 0.002;  // [m]
  const auto mesh = SmoothMesh::build(sphere);
  Random random(1);
  double position = 0, direction = 0;
  for (int i = 0; i < 20000; ++i) {
    BenchFinger finger;
    const Vec3 d = randomDirection(random);
    const contact::SurfaceContact c = finger.on(*mesh, (kBenchBall + kBenchFinger - kDepth) * d).main();
    position = std::max(position, std::abs(c.p_BS.norm() - kBenchBall));
    direction = std::max(direction, angleBetween(c.n_B, d));
  }
  return {atMost("position error", 1e6 * position, "um", position_bound),
          unbounded("direction error", direction / kDegree, "deg")};
}

// R 25 mm, 24 facets, once around at constant depth, away from the rims.
std::vector<Record> cylinderErrors() {
  constexpr double kR = 0.025, kDepth = 0.0015;  // [m]
  const auto mesh = SmoothMesh::build(contact::cylinder(kR, 0.03, 24, 6));
  const SweepPlane plane{Vec3::UnitZ(), 0.003};
  const FingerPath path = circleAround(plane, kR + kBenchFinger - kDepth);
  BenchFinger finger;
  double position = 0, direction = 0, ripple = 0;
  for (const Vec3& C : path.centres) {
    const contact::SurfaceContact c = finger.on(*mesh, C).main();
    position = std::max(position, std::abs(c.p_BS.head<2>().norm() - kR));
    direction = std::max(direction, angleBetween(c.n_B, Vec3(C.x(), C.y(), 0)));
    ripple = std::max(ripple, std::abs(c.phi + kDepth));
  }
  return {atMost("position error", 1e6 * position, "um", 0.5),
          atMost("direction error", direction / kDegree, "deg", 0.02), atMost("depth ripple", 1e6 * ripple, "um", 0.5)};
}

// Round about the z axis: the radius at height z, and the latitude of its normal.
struct RoundPlace {
  double radius, z, latitude;  // [m], [m], [rad]
};

// The slowest and the fastest of the contact on its way around, over the true speed (a maximum alone would pass a
// contact that halts), and how much the depth is off.
std::vector<Record> speedsAround(const contact::TriangleMesh& mesh, const std::vector<RoundPlace>& places, double from,
                                 double slowest_bound, double fastest_bound, double depth_bound) {
  constexpr double kDepth = 0.0015;  // [m]
  constexpr int kSteps = 5000;       // samples on the way around: 1.3 mrad apart or less; chosen
  const auto surface = SmoothMesh::build(mesh);
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0, off = 0;
  for (const RoundPlace& at : places) {
    BenchFinger finger;
    const double h = kBenchFinger - kDepth, reach = at.radius + h * math::cos(at.latitude), way = 2 * (M_PI - from);
    Vec3 last = Vec3::Zero();
    for (int i = 0; i <= kSteps; ++i) {
      const double angle = from + way * i / kSteps;
      const Vec3 C(reach * math::cos(angle), reach * math::sin(angle), at.z + h * math::sin(at.latitude));
      const contact::SurfaceContact c = finger.on(*surface, C).main();
      const Vec3 p = c.p_BS;
      off = std::max(off, std::abs(c.phi + kDepth));
      const double speed = (p - last).norm() * kSteps / (at.radius * way);
      if (i > 0) slowest = std::min(slowest, speed);
      if (i > 0) fastest = std::max(fastest, speed);
      last = p;
    }
  }
  return {atLeast("slowest", slowest, "-", slowest_bound), atMost("fastest", fastest, "-", fastest_bound),
          atMost("depth, off by", 1e6 * off, "um", depth_bound)};
}

// Rows of quads between the rims: CAD programs and lathes write one.
std::vector<Record> cylinderSpeeds(int rows) {
  return speedsAround(contact::cylinder(0.025, 0.03, 50, rows), {{0.025, 0, 0}, {0.025, 0.02, 0}, {0.025, 0.029, 0}}, 0,
                      0.999, 1.001, kDepthOff);
}
std::vector<Record> flatSpeeds(int rows) {
  const double crease = std::acos(0.015 / 0.025) + 1e-3;
  return speedsAround(contact::cylinderWithFlat(0.025, 0.03, 0.015, 48, rows),
                      {{0.025, 0, 0}, {0.025, 0.02, 0}, {0.025, 0.029, 0}}, crease, 0.999, 1.001, kDepthOff);
}
// On the rim itself, at three angles over it, and on the end beside it.
std::vector<RoundPlace> aboutRim() {
  return {{0.025, 0.03, 0.2}, {0.025, 0.03, 0.8}, {0.025, 0.03, 1.3}, {0.024, 0.03, M_PI / 2}};
}
std::vector<Record> rimSpeeds(int rows) {
  return speedsAround(contact::cylinder(0.025, 0.03, 50, rows), aboutRim(), 0, 0.999, 1.001, kDepthOff);
}
std::vector<Record> rimBesideCornerSpeeds(int rows) {
  const double crease = std::acos(0.015 / 0.025) + 1e-3;
  return speedsAround(contact::cylinderWithFlat(0.025, 0.03, 0.015, 48, rows), aboutRim(), crease, 0.999, 1.001,
                      kDepthOff);
}

// Straight ways of the finger's centre past a corner of a convex solid: the contact never moves faster than the
// centre, and its normal never turns faster than about the corner.
std::vector<Record> cornerSpeeds(const contact::TriangleMesh& mesh, const Vec3& corner, const Vec3& outwards) {
  constexpr double kHeight = 0.0065, kAbout = 0.004, kStep = 1e-5;  // [m]
  constexpr int kWays = 2000, kSteps = 100;
  const auto surface = SmoothMesh::build(mesh);
  Random random(1);
  double fastest = 0, fastest_turn = 0;
  for (int i = 0; i < kWays; ++i) {
    BenchFinger finger;
    Vec3 C = corner + kHeight * outwards.normalized() + kAbout * random.uniform(-1, 1) * randomDirection(random);
    const Vec3 step = kStep * randomDirection(random);
    contact::SurfaceContact last = finger.on(*surface, C).main();
    for (int k = 0; k < kSteps; ++k) {
      const contact::SurfaceContact c = finger.on(*surface, C += step).main();
      const double h = std::min(c.phi, last.phi) + kBenchFinger;
      fastest = std::max(fastest, (c.p_BS - last.p_BS).norm() / kStep);
      fastest_turn = std::max(fastest_turn, h * (c.n_B - last.n_B).norm() / kStep);
      last = c;
    }
  }
  return {atMost("fastest", fastest, "-", 1.01), atMost("fastest turn, of a corner's", fastest_turn, "-", 1.05)};
}
std::vector<Record> flatCornerSpeeds(int rows) {
  return cornerSpeeds(contact::cylinderWithFlat(0.025, 0.03, 0.015, 48, rows), {0.015, 0.02, 0.03}, {1, 0.6, 1});
}

// From 30 mm at the foot to `top` [m]; to a tip if that is 0. Bounds: of speeds from 1 [-], of depth [um].
std::vector<Record> coneSpeeds(int rows, double top, double off, double depth_bound) {
  constexpr double kBottom = 0.03, kHeight = 0.04;  // [m]
  std::vector<Vec2> profile = {{0, -kHeight / 2}};
  for (int k = 0; k <= rows - (top == 0); ++k)
    profile.push_back({kBottom + (top - kBottom) * k / rows, kHeight * (static_cast<double>(k) / rows - 0.5)});
  profile.push_back({0, kHeight / 2});
  std::vector<RoundPlace> places;
  for (const double z : {-0.012, 0.0, 0.012})
    places.push_back({kBottom + (top - kBottom) * (z / kHeight + 0.5), z, math::atan((kBottom - top) / kHeight)});
  return speedsAround(contact::lathe(profile, 48), places, 0, 1 - off, 1 + off, depth_bound);
}
std::vector<Record> uvSphereSpeeds() {
  std::vector<RoundPlace> places;
  for (const double latitude : {0.1, 0.3, 0.6, 0.9, 1.2})
    places.push_back({0.02 * math::cos(latitude), 0.02 * math::sin(latitude), latitude});
  return speedsAround(contact::uvSphere(0.02, 12, 24), places, 0, 0.998, 1.002, 1);
}

// Barycentric coordinates 1 and 2 of the place at `s` along edge `i`.
Vec2 onEdge(std::size_t i, double s) {
  std::array<double, 3> b{};
  b[i] = 1 - s;
  b[(i + 1) % 3] = s;
  return {b[1], b[2]};
}

struct Gaps {
  double place = 0, direction = 0;  // [m], [rad]
};

void widenBy(const contact::SurfaceCell& a, std::size_t i, const contact::SurfaceCell& b, std::size_t k, Gaps& gaps) {
  constexpr int kSamples = 8;  // along a shared edge, its ends too; chosen
  for (int j = 0; j <= kSamples; ++j) {
    const double s = static_cast<double>(j) / kSamples;
    const Vec2 here = onEdge(i, s), there = onEdge(k, 1 - s);
    const contact::PatchPoint x = evaluate(a.patch, here.x(), here.y()), y = evaluate(b.patch, there.x(), there.y());
    gaps.place = std::max(gaps.place, (x.S - y.S).norm());
    gaps.direction = std::max(gaps.direction, angleBetween(x.N, y.N));
  }
}

std::vector<Record> gapsAcrossEdges(MeasureContext& context) {
  Gaps gaps;
  const std::vector<BenchObject> objects = generatedObjects();
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const SurfaceNet net(objects[o].mesh, contact::SurfaceOptions{}.crease_angle, true);
    for (std::int32_t t = 0; t < net.size(); ++t) {
      const contact::SurfaceCell cell = net.build(t);
      for (std::size_t i = 0; i < 3; ++i) {
        const contact::Neighbour other = cell.neighbours[i];
        if (!cell.sharp[i] && other.triangle > t)
          widenBy(cell, i, net.build(other.triangle), static_cast<std::size_t>(other.edge), gaps);
      }
    }
    context.progress(static_cast<double>(o) / static_cast<double>(objects.size()));
  }
  return {atMost("place", 1e3 * gaps.place, "mm", 1e-9), atMost("direction", gaps.direction / kDegree, "deg", 1e-9)};
}

// Steps that the published iteration takes on spheres of 80 to 320 triangles, with its
// best constants (gain 1, G_k = r, G_d = 0).
std::vector<Record> publishedIterations(MeasureContext& context) {
  std::vector<Record> records;
  for (const int level : {1, 2}) {
    const auto mesh = SmoothMesh::build(contact::icosphere(0.02, level), {.variant = SurfaceVariant::smooth_published});
    Stroke stroke;
    stroke.ticks = 20000;
    const FingerPath path = strokeOver(*mesh, stroke, context);
    BenchFinger finger;
    double iterations = 0, queries = 0;
    for (std::size_t i = 0; i < path.centres.size(); ++i) {
      const bool fresh = i % static_cast<std::size_t>(path.restart_every) == 0;
      if (fresh) finger.tracker = {};
      const contact::SurfaceContacts contacts = finger.on(*mesh, path.centres[i]);
      iterations += fresh ? 0 : contacts.cost.iterations;
      queries += fresh ? 0 : 1;
    }
    const std::string where = fmt::format("iterations, mean, {} triangles", 20 << 2 * level);
    records.push_back(atMost(where, iterations / queries, "-", 2.3));
  }
  return records;
}

}  // namespace

std::vector<Measurement> accuracyMeasurements() {
  return {
      {"accuracy/sphere-80", [](MeasureContext&) { return sphereErrors(contact::icosphere(kBenchBall, 1), 15); }},
      {"accuracy/sphere-320", [](MeasureContext&) { return sphereErrors(contact::icosphere(kBenchBall, 2), 1); }},
      {"accuracy/uv-sphere", [](MeasureContext&) { return sphereErrors(contact::uvSphere(kBenchBall, 12, 24), 1.5); }},
      {"accuracy/cylinder-15deg", [](MeasureContext&) { return cylinderErrors(); }},
      {"accuracy/speed-cylinder-1-row", [](MeasureContext&) { return cylinderSpeeds(1); }},
      {"accuracy/speed-cylinder-2-rows", [](MeasureContext&) { return cylinderSpeeds(2); }},
      {"accuracy/speed-cylinder-8-rows", [](MeasureContext&) { return cylinderSpeeds(8); }},
      {"accuracy/speed-beside-crease-1-row", [](MeasureContext&) { return flatSpeeds(1); }},
      {"accuracy/speed-beside-crease-2-rows", [](MeasureContext&) { return flatSpeeds(2); }},
      {"accuracy/speed-beside-crease-8-rows", [](MeasureContext&) { return flatSpeeds(8); }},
      {"accuracy/speed-rim-1-row", [](MeasureContext&) { return rimSpeeds(1); }},
      {"accuracy/speed-rim-2-rows", [](MeasureContext&) { return rimSpeeds(2); }},
      {"accuracy/speed-rim-8-rows", [](MeasureContext&) { return rimSpeeds(8); }},
      {"accuracy/speed-rim-beside-corner-1-row", [](MeasureContext&) { return rimBesideCornerSpeeds(1); }},
      {"accuracy/speed-rim-beside-corner-2-rows", [](MeasureContext&) { return rimBesideCornerSpeeds(2); }},
      {"accuracy/speed-rim-beside-corner-8-rows", [](MeasureContext&) { return rimBesideCornerSpeeds(8); }},
      {"accuracy/speed-crease-meets-rim-1-row", [](MeasureContext&) { return flatCornerSpeeds(1); }},
      {"accuracy/speed-crease-meets-rim-2-rows", [](MeasureContext&) { return flatCornerSpeeds(2); }},
      {"accuracy/speed-crease-meets-rim-8-rows", [](MeasureContext&) { return flatCornerSpeeds(8); }},
      {"accuracy/speed-box-corner",
       [](MeasureContext&) {
         return cornerSpeeds(contact::box({0.02, 0.02, 0.02}), {0.02, 0.02, 0.02}, {1, 1, 1});
       }},
      {"accuracy/speed-cone-1-row", [](MeasureContext&) { return coneSpeeds(1, 0.015, 0.002, 3); }},
      {"accuracy/speed-cone-2-rows", [](MeasureContext&) { return coneSpeeds(2, 0.015, 0.002, 3); }},
      {"accuracy/speed-cone-8-rows", [](MeasureContext&) { return coneSpeeds(8, 0.015, 0.004, 3); }},
      {"accuracy/speed-narrow-cone-1-row", [](MeasureContext&) { return coneSpeeds(1, 0.003, 0.005, 6); }},
      {"accuracy/speed-pointed-cone-1-row", [](MeasureContext&) { return coneSpeeds(1, 0, 0.003, 6); }},
      {"accuracy/speed-pointed-cone-8-rows", [](MeasureContext&) { return coneSpeeds(8, 0, 0.008, 6); }},
      {"accuracy/speed-uv-sphere", [](MeasureContext&) { return uvSphereSpeeds(); }},
      {"accuracy/gaps-across-smooth-edges", gapsAcrossEdges},
      {"accuracy/published-iteration", publishedIterations}};
}

}  // namespace pincer::tasks
