// The smooth surface against the one that the mesh was made from, and against itself across edges.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/surface/surface_net.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/objects.h"
#include "pincer/tasks/judge/bench/sweep.h"

namespace pincer::tasks {
namespace {

using contact::SmoothMesh;
using contact::SurfaceNet;
using contact::SurfaceVariant;

std::vector<Record> sphereErrors(int level, double position_bound) {
  constexpr double kR = 0.02, kDepth = 0.002;
  const auto mesh = SmoothMesh::build(contact::icosphere(kR, level));
  Random random(1);
  double position = 0, direction = 0;
  for (int i = 0; i < 20000; ++i) {
    BenchFinger finger;
    const Vec3 d = randomDirection(random);
    const contact::SurfaceContact c = finger.on(*mesh, (kR + kBenchFinger - kDepth) * d).main();
    position = std::max(position, std::abs(c.p_BS.norm() - kR));
    direction = std::max(direction, angleBetween(c.n_B, d));
  }
  return {atMost("position error", 1e6 * position, "um", position_bound), unbounded("direction error", direction / kDegree, "deg")};
}

// R 25 mm, 24 facets, once around at constant depth, away from the rims.
std::vector<Record> cylinderErrors() {
  constexpr double kR = 0.025, kDepth = 0.0015;
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
  return {atMost("position error", 1e6 * position, "um", 0.5), atMost("direction error", direction / kDegree, "deg", 0.02),
          atMost("depth ripple", 1e6 * ripple, "um", 0.5)};
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
  constexpr int kSamples = 8;
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
        if (!cell.sharp[i] && other.triangle > t) widenBy(cell, i, net.build(other.triangle), static_cast<std::size_t>(other.edge), gaps);
      }
    }
    context.progress(static_cast<double>(o) / static_cast<double>(objects.size()));
  }
  return {atMost("place", 1e3 * gaps.place, "mm", 1e-9), atMost("direction", gaps.direction / kDegree, "deg", 1e-9)};
}

// What the published iteration takes on spheres of 80 to 320 triangles, with its best constants (gain 1, G_k = r, G_d = 0).
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
  return {{"accuracy/sphere-80", [](MeasureContext&) { return sphereErrors(1, 15); }},
          {"accuracy/sphere-320", [](MeasureContext&) { return sphereErrors(2, 1); }},
          {"accuracy/cylinder-15deg", [](MeasureContext&) { return cylinderErrors(); }},
          {"accuracy/gaps-across-smooth-edges", gapsAcrossEdges},
          {"accuracy/published-iteration", publishedIterations}};
}

}  // namespace pincer::tasks
