// The scenes on contact in which CHAI3D was measured (docs/benchmarks.md), built the same way: k 1000
// N/m, 1 kHz, r 8 mm, pressed 2 mm, 100 mm/s.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "pincer/contact/generated_meshes.h"
#include "pincer/grasp/pressure_map.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/finger_scene.h"
#include "pincer/tasks/judge/bench/objects.h"
#include "pincer/tasks/judge/bench/path_figures.h"
#include "pincer/tasks/judge/bench/sweep.h"

namespace pincer::tasks {
namespace {

using contact::Mesh;
using contact::SmoothMesh;
using contact::TriangleMesh;

constexpr double kPressDepth = 0.002;       // [m]
constexpr double kStep = 0.1 * kBenchTick;  // [m] per tick at 100 mm/s

Mesh meshOf(const TriangleMesh& mesh) { return {SmoothMesh::build(mesh)}; }

// Ticks after which a device that set out from rest moves evenly. A massless tip without damping rings at half the tick
// rate until then: its direction alternates, by as much as it turns at first, and 4 % less with every tick.
constexpr std::size_t kStarting = 100;

// A sphere of 40 mm: the device runs around it 2 mm under the surface, the force should turn evenly.
struct Round {
  double setting_out = 0;   // largest turn of the force per tick in the first kStarting ticks [rad]
  double largest_turn = 0;  // and after them
  double ripple = 0;        // of the contact's place on the finger [m]
};
Round runAround(int n) {
  const SweepPlane plane{Vec3(0.3, -0.2, 1).normalized(), 0};
  const FingerPath path = circleAround(plane, 0.04 + kBenchFinger - kPressDepth);
  FingerScene scene(meshOf(contact::geodesicSphere(0.04, n)), {0, 0}, 1.1 * path.centres.front());
  scene.leadTo(path.centres.front());
  const Mat3 frame = frameFromNormal(plane.axis);
  Round round;
  std::vector<double> place;
  Vec3 last = Vec3::Zero();
  double turned = 0, last_angle = 0;
  for (std::size_t i = 0; i < path.centres.size(); ++i) {
    const Vec3 n_W = scene.tick(path.centres[i]).n_W;
    const double angle = math::atan2(n_W.dot(frame.col(1)), n_W.dot(frame.col(0)));
    if (i > 0 && i <= kStarting) round.setting_out = std::max(round.setting_out, angleBetween(last, n_W));
    if (i > kStarting) {
      round.largest_turn = std::max(round.largest_turn, angleBetween(last, n_W));
      turned += std::remainder(angle - last_angle, 2 * M_PI);
      place.push_back(kBenchFinger * turned);
    }
    last = n_W;
    last_angle = angle;
  }
  round.ripple = rippleAboutLine(place);
  return round;
}

std::vector<Record> sphereRows(MeasureContext&) {
  const Round fine = runAround(22), coarse = runAround(7);
  return {atMost("force turns per tick, 9680 triangles (true: 0.12)", fine.largest_turn / kDegree, "deg", 0.13),
          unbounded("the same while setting out from rest", fine.setting_out / kDegree, "deg"),
          atMost("ripple of the place on the finger, 980 triangles", 1e3 * coarse.ripple, "mm", 0.003)};
}

// 12 facets of 30 degrees, shaded: around at 2 mm under the surface.
std::vector<Record> facetedCylinder(MeasureContext&) {
  const SweepPlane plane{Vec3::UnitZ(), 0.003};
  const FingerPath path = circleAround(plane, 0.025 + kBenchFinger - kPressDepth);
  FingerScene scene(meshOf(contact::cylinder(0.025, 0.03, 12, 6)), {0, 0}, path.centres.front() + Vec3(0.005, 0, 0));
  scene.leadTo(path.centres.front());
  double sum = 0, sum2 = 0, low = std::numeric_limits<double>::infinity(), high = 0, n = 0;
  for (std::size_t i = 0; i < path.centres.size(); ++i) {
    const Vec3 f = scene.tick(path.centres[i]).f_user_W;
    if (i <= kStarting) continue;
    // about the axis
    const double off = math::atan2(path.centres[i].cross(f).z(), path.centres[i].head<2>().dot(f.head<2>()));
    sum += off;
    sum2 += off * off;
    n += 1;
    low = std::min(low, f.norm());
    high = std::max(high, f.norm());
  }
  const double mean = sum / n;  // half a tick's way behind the device, at any facet
  return {
      atMost("direction, standard deviation", std::sqrt(std::max(0.0, sum2 / n - mean * mean)) / kDegree, "deg", 0.05),
      atMost("force, peak to peak of its mean", 100 * (high - low) / (0.5 * (high + low)), "%", 1)};
}

// A box whose faces share their vertices, and thereby, in a file that has them,
// their normals: the finger runs over an edge.
std::vector<Record> edgeWithSharedVertices(MeasureContext&) {
  const Vec3 half(0.03, 0.03, 0.03);
  const auto mesh = SmoothMesh::build(contact::box(half));
  BenchFinger finger;
  const double h = kBenchFinger - kPressDepth;
  double direction = 0, depth = 0;
  for (double s = -0.01; s < 0.01 + h * M_PI / 2; s += kStep) {  // along the top, around the edge, down the side
    const double a = std::clamp(s / h, 0.0, M_PI / 2);
    const Vec3 n(math::sin(a), 0, math::cos(a));
    const Vec3 S(half.x() + std::min(s, 0.0), 0.004, half.z() - std::max(s - h * M_PI / 2, 0.0));
    const contact::SurfaceContact c = finger.on(*mesh, S + h * n).main();
    direction = std::max(direction, angleBetween(c.n_B, n));
    depth = std::max(depth, std::abs(c.phi + kPressDepth));
  }
  return {atMost("direction error", direction / kDegree, "deg", 1e-4),
          atMost("force error, of its mean", 100 * depth / kPressDepth, "%", 1e-4)};
}

// A plate of small triangles: press for 50 ms, then drag along x.
struct Dragged {
  double share = 0, share_error = 0;  // tangential over normal force: largest, and its largest difference from mu_d
};
Dragged dragOverPlate(double mu) {
  FingerScene scene(meshOf(contact::gridBox({0.06, 0.03, 0.005}, 24)), {mu, mu}, {-0.04, 0.001, 0.02});
  Dragged dragged;
  const Vec3 down(-0.04, 0.001, 0.005 + kBenchFinger - kPressDepth);
  scene.leadTo(down);
  for (int i = 0; i < 700; ++i) {
    const grasp::FingerReport& felt = scene.tick(down + Vec3(i * kStep, 0, 0));
    const double share = felt.tangential_force / felt.normal_force;
    dragged.share = std::max(dragged.share, share);
    if (i > 50) dragged.share_error = std::max(dragged.share_error, std::abs(share - mu));  // sliding by then
  }
  return dragged;
}

std::vector<Record> frictionRows(MeasureContext&) {
  return {atMost("mu .5, 100 mm/s: friction over normal force, off .5 by", dragOverPlate(0.5).share_error, "-", 5e-4),
          atMost("no friction: false tangential share", dragOverPlate(0).share, "-", 1e-9)};
}

// A hand leads a finger without friction around a closed part, always 2 mm under where that finger's tip is, and with
// it a second finger with friction .5, which feels sqrt(1 + mu^2) as much where nothing holds it. A snag is a force
// above twice that, but in a groove that locks: rigid walls hold there what is pulled along them or out, by any force.
std::vector<Record> dragOverPart(const TriangleMesh& triangles, MeasureContext& context) {
  constexpr double kMu = 0.5;    // [-]
  constexpr int kTicks = 20000;  // 20 s at 1 kHz; chosen
  const Mesh part = meshOf(triangles);
  const Vec3 above(0, 0, 1.2 * part.surface->boundingRadius());
  FingerScene slippery(part, {0, 0}, above), rough(part, {kMu, kMu}, above);
  Random random(3);
  Vec3 device = above, n = Vec3::UnitZ(), heading = Vec3::UnitX();
  double largest = 0;
  int snagged = 0, longest = 0, locked = 0, touching = 0;
  for (int i = 0; i < kTicks && !context.interrupted(); ++i) {
    const double with = rough.tick(device).f_user_W.norm();
    const grasp::FingerReport& felt = slippery.tick(device);
    touching += felt.touching;
    n = felt.touching ? felt.n_W : Vec3(slippery.proxy().normalized());  // off the part: back towards its middle
    heading += 0.03 * randomDirection(random);
    heading = (heading - heading.dot(n) * n).normalized();
    const Vec3 wanted = slippery.proxy() - kPressDepth * n + kStep * heading;
    device += std::min(1.0, 2 * kStep / (wanted - device).norm()) * (wanted - device);
    const bool is_held = with > 2 * std::sqrt(1 + kMu * kMu) * 1000 * kPressDepth;
    locked += is_held && rough.isLocked();
    snagged = is_held && !rough.isLocked() ? snagged + 1 : 0;
    longest = std::max(longest, snagged);
    largest = std::max(largest, with);
    context.progress(static_cast<double>(i) / kTicks);
  }
  return {atLeast("share of time in contact", static_cast<double>(touching) / kTicks, "-", 0.8),
          atMost("longest snag", 1e3 * longest * kBenchTick, "ms", 20),
          unbounded("as much, held by a groove that locks, in all", 1e3 * locked * kBenchTick, "ms"),
          unbounded("largest force (2.2 N where nothing holds it)", largest, "N"),
          exactly("ticks that the step complained of", rough.flagged() + slippery.flagged(), "-", 0)};
}

// The same object, finger and path in every scale: what changes is the scale of
// the answer. Triangles down to micrometres.
std::vector<Record> anyScale(MeasureContext& context) {
  const TriangleMesh triangles = contact::cylinderWithFlat(0.025, 0.03, 0.018, 40, 12);
  const auto mesh = SmoothMesh::build(triangles);
  Stroke stroke;
  stroke.ticks = 2000;
  const FingerPath path = strokeOver(*mesh, stroke, context);
  std::vector<Record> records;
  for (const double scale : {1e-3, 1e-2, 10.0, 1e3}) {
    const auto scaled = SmoothMesh::build(contact::transformed(triangles, Pose{}, scale));
    BenchFinger a, b;
    double place = 0, direction = 0;
    for (std::size_t i = 0; i < path.centres.size(); ++i) {
      if (i % static_cast<std::size_t>(path.restart_every) == 0) a.tracker = b.tracker = {};
      const contact::SurfaceContact x = a.on(*mesh, path.centres[i]).main();
      const contact::SurfaceContact y =
          scaled->querySphere(scale * path.centres[i], scale * kBenchFinger, scale * kBenchMargin, b.tracker, *b.cache)
              .main();
      place = std::max(place, (x.p_BS - y.p_BS / scale).norm());
      direction = std::max(direction, angleBetween(x.n_B, y.n_B));
    }
    records.push_back(atMost(fmt::format("place, scale {:g}", scale), 1e6 * place, "um", 0.01));
    records.push_back(atMost(fmt::format("direction, scale {:g}", scale), direction / kDegree, "deg", 1e-4));
  }
  return records;
}

struct Pushes {
  std::int64_t count = 0, through = 0, ticks = 0;
};

// One push from `side` (+-1) of the plate towards a random place on or beyond
// it, up to 5 mm past the far side, and back.
void push(FingerScene& scene, double side, Random& random, Pushes& pushes) {
  const double speed = random.uniform(0.1, 1);  // [m/s]
  const Vec3 from(random.uniform(-0.02, 0.02), random.uniform(-0.015, 0.015), side * (0.0005 + kBenchFinger + 0.003));
  const Vec3 to(from.x() + random.uniform(-0.005, 0.005), from.y() + random.uniform(-0.005, 0.005),
                -side * random.uniform(0.0, 0.0055));
  const int ticks = std::max(2, static_cast<int>((to - from).norm() / (speed * kBenchTick)));
  bool through = false;
  for (int i = 0; i <= 2 * ticks; ++i) {
    const double s = static_cast<double>(i <= ticks ? i : 2 * ticks - i) / ticks;
    const grasp::FingerReport& felt = scene.tick(from + s * (to - from));
    const bool inside = side * (from + s * (to - from)).z() < 0.0005 + kBenchFinger - 1e-4;
    through = through || (inside && side * felt.f_user_W.z() <= 0);
  }
  ++pushes.count;
  pushes.through += through;
  pushes.ticks += 2 * ticks;
}

// A plate of 1 mm with fingers of 8 mm: the device goes up to 14 mm past its surface.
// Never may the force turn to the other side.
std::vector<Record> thinWalls(MeasureContext& context) {
  constexpr int kPushes = 16000;  // half of them from each side; chosen
  const Mesh plate = meshOf(contact::gridBox({0.04, 0.03, 0.0005}, 16));
  Random random(5);
  Pushes pushes;
  for (const double side : {1.0, -1.0}) {
    FingerScene scene(plate, {0.5, 0.5}, Vec3(0, 0, side * 0.03));
    for (int i = 0; i < kPushes / 2 && !context.interrupted(); ++i) {
      push(scene, side, random, pushes);
      context.progress(static_cast<double>(pushes.count) / kPushes);
    }
  }
  return {unbounded("pushes at up to 1 m/s", static_cast<double>(pushes.count), "-"),
          exactly("pushes that came through", static_cast<double>(pushes.through), "-", 0)};
}

// Forces of random contacts, spread over 12 x 10 taxels of 2 mm: their sums and moments are the contacts'.
std::vector<Record> pressureMaps(MeasureContext&) {
  constexpr grasp::PressureGrid kGrid{.rows = 12, .columns = 10, .pitch = 2e-3};
  Random random(1);
  double force = 0, moment = 0;
  for (int i = 0; i < 1000; ++i) {
    grasp::PadForce c;
    c.place = {random.uniform(-5e-3, 5e-3), random.uniform(-4e-3, 4e-3)};
    c.force = {random.uniform(1, 3), {random.uniform(-1, 1), random.uniform(-1, 1)}};
    c.radius = random.uniform(1e-4, 3e-3);
    c.torsion = random.uniform(-1e-3, 1e-3);
    c.hertz = i % 2 == 0;
    std::vector<grasp::Taxel> map(static_cast<std::size_t>(kGrid.rows * kGrid.columns));
    grasp::spread(kGrid, c, map);
    double normal = 0, around = 0;
    Vec2 tangential = Vec2::Zero(), first = Vec2::Zero();
    for (std::size_t k = 0; k < map.size(); ++k) {
      const Vec2 x = grasp::taxelPlace(kGrid, static_cast<int>(k) / kGrid.columns, static_cast<int>(k) % kGrid.columns);
      normal += map[k].normal;
      tangential += map[k].tangential;
      first += map[k].normal * x;
      around += x.x() * map[k].tangential.y() - x.y() * map[k].tangential.x();
    }
    const double about_place = c.place.x() * c.force.tangential.y() - c.place.y() * c.force.tangential.x();
    force = std::max({force, std::abs(normal - c.force.normal), (tangential - c.force.tangential).norm()});
    moment = std::max({moment, (first - c.force.normal * c.place).norm(), std::abs(around - c.torsion - about_place)});
  }
  return {atMost("sums of 120 taxels, off by", force, "N", 1e-14), atMost("moments, off by", moment, "N m", 1e-16)};
}

}  // namespace

std::vector<Measurement> fingerSceneMeasurements(const ContactBenchOptions& options) {
  std::vector<Measurement> measurements = {
      {"scene/sphere", sphereRows},
      {"scene/faceted-cylinder-30deg", facetedCylinder},
      {"scene/edge-with-shared-vertices", edgeWithSharedVertices},
      {"scene/friction-on-a-plate", frictionRows},
      {"scene/any-scale", anyScale},
      {"scene/thin-wall", thinWalls},
      {"scene/pressure-map", pressureMaps},
      {"scene/drag/rounded-cube",
       [](MeasureContext& c) { return dragOverPart(contact::roundedCube(0.02, 0.004, 3), c); }},
  };
  if (options.meshes.empty()) return measurements;
  for (const MeshFile& file : meshFilesIn(options.meshes)) {
    const auto run = [file](MeasureContext& context) {
      return measureFile(file, [&](const BenchObject& object) { return dragOverPart(object.mesh, context); });
    };
    measurements.push_back({"scene/drag/" + file.name, run});
  }
  return measurements;
}

}  // namespace pincer::tasks
