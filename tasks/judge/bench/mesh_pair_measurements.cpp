// Bodies on meshes: what solids feel of the facets of a ball's mesh, judged by the ball; how straight a prism slides on
// a finely cut plane; what two finely cut meshes that lie on each other cost.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/step.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

using contact::PairPoint;
using contact::PairPoints;
using contact::Shape;
using contact::SmoothMesh;

constexpr double kBallRadius = 0.02;  // radius [m]
constexpr double kPressedBy = 1e-5;   // of the flat slide [m]
constexpr double kSlideStep = 5e-7;   // [m]

// A solid over the ball's top, touching it with the feature that the name says; `q` turns it so, `reach` is from its
// origin to that feature.
struct OverBall {
  const char* name;
  Shape solid;
  Quat q;
  double reach;
};

std::vector<OverBall> solidsOverBall() {
  const Quat lying = quatFromRotationVector({M_PI / 2, 0, 0}), edge = quatFromRotationVector({M_PI / 4, 0, 0});
  std::vector<Vec3> corners;
  for (int i = 0; i < 6; ++i) {
    const double t = i * M_PI / 3;
    corners.emplace_back(0.03 * math::cos(t), 0.03 * math::sin(t), -0.01);
    corners.emplace_back(0.02 * math::cos(t), 0.02 * math::sin(t), 0.01);
  }
  return {{"box's face", contact::Box{{0.05, 0.05, 0.01}}, Quat::Identity(), 0.01},
          {"box's edge", contact::Box{{0.05, 0.01, 0.01}}, edge, 0.01 * std::sqrt(2.0)},
          {"capsule", contact::Capsule{0.01, 0.03}, lying, 0.01},
          {"cylinder's wall", contact::Cylinder{0.01, 0.03}, lying, 0.01},
          {"cylinder's end", contact::Cylinder{0.03, 0.01}, Quat::Identity(), 0.01},
          {"hull's face", contact::Convex{contact::Polytope::hullOf(corners, "frustum")}, Quat::Identity(), 0.01}};
}

struct MeshFelt {
  double gap = 0;   // largest difference from what the ball itself answers [m]
  double step = 0;  // largest change of that difference from one place to the next [m]
  double turn = 0;  // largest turn of the normal beyond the ball's own, per place [rad]
  double cost = 0;  // median [ns]
};

const PairPoint& deepestPoint(const PairPoints& p) {
  return *std::min_element(p.points.begin(), p.points.begin() + p.count,
                           [](const auto& a, const auto& b) { return a.phi < b.phi; });
}

MeshFelt slideOver(const Shape& mesh, const OverBall& over, MeasureContext& context) {
  constexpr int kPlaces = 20000;  // of kSlideStep each; chosen
  const contact::PatchCacheHandle cache = contact::makePatchCache();
  PairPoints found;
  const auto ask = [&](const Shape& ball, int i) {
    const Pose X{over.q,
                 Vec3(-0.005 + kSlideStep * i, -0.002 + 0.35 * kSlideStep * i, kBallRadius + over.reach - kPressedBy)};
    contact::collideShapes(ball, Pose{}, over.solid, X, 1e-3, *cache, found);
    return found.count > 0 ? deepestPoint(found) : PairPoint{};
  };
  MeshFelt felt;
  Vec3 lean_before = Vec3::Zero();
  double gap_before = 0;
  for (int i = 0; i < kPlaces && !context.interrupted(); ++i) {
    const PairPoint exact = ask(contact::Sphere{kBallRadius}, i), s = ask(mesh, i);
    const double gap = s.phi - exact.phi;
    const Vec3 lean = s.n_W - exact.n_W;
    felt.gap = std::max(felt.gap, std::abs(gap));
    if (i > 0)
      felt.step = std::max(felt.step, std::abs(gap - gap_before)),
      felt.turn = std::max(felt.turn, (lean - lean_before).norm());
    gap_before = gap;
    lean_before = lean;
  }
  felt.cost = costOfCalls([&](std::int64_t i) { ask(mesh, static_cast<int>(i % kPlaces)); },
                          {.warm_up = 100, .batches = 11, .calls_per_batch = 200, .single_calls = 0})
                  .median;
  return felt;
}

Measurement facetsFelt(const OverBall& over) {
  return {fmt::format("pair/facets/{}", over.name), [over](MeasureContext& context) {
            const Shape mesh = contact::Mesh{SmoothMesh::build(contact::geodesicSphere(kBallRadius, 7))};
            const MeshFelt felt = slideOver(mesh, over, context);
            return std::vector<Record>{
                atMost("980 triangles: gap, from the ball's", 1e6 * felt.gap, "um", 1),
                atMost("step of that from place to place, 0.5 um apart", 1e6 * felt.step, "um", 0.01),
                atMost("turn beyond the ball's from place to place", felt.turn / kDegree, "deg", 0.001),
                unbounded("median", felt.cost, "ns")};
          }};
}

// Two plates face to face, each of 12 cells^2 triangles.
double costOfPlates(int cells) {
  const Shape plate = contact::Mesh{SmoothMesh::build(contact::gridBox({0.04, 0.04, 0.01}, cells))};
  contact::preparePair(plate, plate);
  const contact::PatchCacheHandle cache = contact::makePatchCache();
  PairPoints found;
  const auto ask = [&](std::int64_t i) {
    const Pose X{quatFromRotationVector({0, 0, 0.001 * static_cast<double>(i % 700)}),
                 Vec3(0.001, 0.002, 0.02 - kPressedBy)};
    contact::collideShapes(plate, X, plate, Pose{}, 1e-4, *cache, found);
  };
  return costOfCalls(ask, {.warm_up = 20, .batches = 11, .calls_per_batch = 50, .single_calls = 0}).median;
}

std::vector<Record> measurePlates(MeasureContext&) {
  constexpr double kMost = 300;  // [us], of a tick's 1000
  const double coarse = costOfPlates(10), fine = costOfPlates(29), finest = costOfPlates(58);
  return {unbounded("plates face to face, 1200 triangles each", 1e-3 * coarse, "us"),
          atMost("10092 triangles each", 1e-3 * fine, "us", kMost),
          atMost("40368 triangles each, of 10092", finest / fine, "-", 4)};
}

// The way of a prism of three sides on a plane of `cells` squares a side, along its heading and across it [m]: at first
// with `speed` [m/s], and pushed on with the share `push` of the friction that it bears.
Vec2 wayOfPrism(int cells, double heading, double speed, double push, double seconds) {
  constexpr double kG = 9.81, kMu = 0.4, kHalfHeight = 0.006, kThick = 0.01;
  const Vec3 along(math::cos(heading), math::sin(heading), 0);
  std::vector<Vec3> corners;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * 2 * M_PI / 3;
    corners.emplace_back(0.02 * math::cos(angle), 0.02 * math::sin(angle), i < 3 ? -kHalfHeight : kHalfHeight);
  }
  engine::WorldOptions options;
  options.gravity_W = Vec3(0, 0, -kG) + push * kMu * kG * along;
  engine::WorldBuilder builder{options};
  const contact::Mesh plane{SmoothMesh::build(contact::gridBox({0.3, 0.3, kThick}, cells))};
  builder.addBody({"plane", plane, false, 0, {kMu, kMu, 0, 0}});
  builder.addBody({"prism", contact::Convex{contact::Polytope::hullOf(corners, "prism")}, true, 0.1, {kMu, kMu, 0, 0}});
  const engine::WorldModel model = builder.build();
  const Vec3 from(-0.051, -0.037, kThick + kHalfHeight);
  engine::WorldState state =
      engine::makeState(model, {engine::BodyStart{}, {{Quat::Identity(), from}, speed * along, Vec3::Zero()}}, {});
  const engine::ScratchHandle scratch = engine::makeScratch(model);
  for (int tick = 0; tick < static_cast<int>(1e3 * seconds); ++tick) engine::step(model, state, *scratch);
  const Vec3 way = engine::bodyPose(model, state, 1).p - from;
  return {way.dot(along), way.dot(Vec3::UnitZ().cross(along))};
}

std::vector<Record> measurePrism(MeasureContext& context) {
  constexpr double kSpeed = 0.5, kStop = kSpeed * kSpeed / (2 * 0.4 * 9.81);  // [m/s], [m]
  double along = 0, across = 0, creep = 0;
  for (const int cells : {1, 9, 20, 40}) {
    for (const double heading : {0.0, 0.31, 0.7}) {
      if (context.interrupted()) return {};
      const Vec2 way = wayOfPrism(cells, heading, kSpeed, 0, 0.3);
      along = std::max(along, std::abs(way[0] - kStop));
      across = std::max(across, std::abs(way[1]));
    }
    creep = std::max(creep, wayOfPrism(cells, 0.31, 0, 0.9, 6).norm());
  }
  return {atMost("way to a stop from 0.5 m/s, off by", 1e6 * along, "um", 10),
          atMost("sideways meanwhile", 1e6 * across, "um", 1),
          atMost("creep in 6 s under 0.9 of the friction", 1e6 * creep, "um", 1)};
}

}  // namespace

std::vector<Measurement> meshPairMeasurements() {
  std::vector<Measurement> measurements;
  for (const OverBall& over : solidsOverBall()) measurements.push_back(facetsFelt(over));
  measurements.push_back({"pair/prism-on-a-plane", measurePrism});
  measurements.push_back({"pair/plates-of-many-triangles", measurePlates});
  return measurements;
}

}  // namespace pincer::tasks
