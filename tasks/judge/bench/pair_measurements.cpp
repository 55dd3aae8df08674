// Pairs of bodies: error of the contact direction and gap over random placements, judged by trying every direction
// (tasks/judge/exact/convex_gap.h); cost begun anew and from the last tick's normal, names and normals along a slide.
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/exact/convex_gap.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

using contact::PairPoints;
using contact::Shape;

struct PairBody {
  const char* name;
  Shape shape;    // as it is felt
  Shape solid;    // as it is judged: of a mesh the solid that it was made from
  Quat resting;   // how it lies on a table
  double height;  // of its origin then [m]
  bool is_mesh = false;
};

constexpr double kPairSize = 0.03;  // of the bodies [m]

std::vector<PairBody> pairBodies() {
  const Quat lying = quatFromRotationVector({M_PI / 2, 0, 0});
  const contact::Box box{{0.031, 0.017, 0.023}};
  const contact::Capsule capsule{0.013, 0.029};
  const contact::Cylinder cylinder{0.024, 0.019};
  std::vector<Vec3> points;  // a frustum of six sides
  for (int i = 0; i < 12; ++i) {
    const double r = i < 6 ? 0.027 : 0.019, t = i * M_PI / 3;
    points.emplace_back(r * math::cos(t), r * math::sin(t), i < 6 ? -0.016 : 0.02);
  }
  const contact::Convex hull{contact::Polytope::hullOf(points, "frustum")};
  const contact::Mesh mesh{contact::SmoothMesh::build(contact::box(box.half))};
  return {{"sphere", contact::Sphere{0.021}, contact::Sphere{0.021}, Quat::Identity(), 0.021},
          {"box", box, box, Quat::Identity(), box.half.z()},
          {"capsule", capsule, capsule, lying, capsule.radius},
          {"cylinder", cylinder, cylinder, Quat::Identity(), cylinder.half_length},
          {"hull", hull, hull, Quat::Identity(), 0.016},
          {"mesh", mesh, box, Quat::Identity(), box.half.z(), true},
          {"half-space", contact::HalfSpace{}, contact::HalfSpace{}, Quat::Identity(), 0}};
}

// Draws that every standard library makes alike.
class Draws {
 public:
  double uniform(double from, double to) { return from + (to - from) * 0x1p-64 * static_cast<double>(bits_()); }
  Vec3 direction() {
    const double z = uniform(-1, 1), t = uniform(0, 2 * M_PI), s = std::sqrt(1 - z * z);
    return {s * math::cos(t), s * math::sin(t), z};
  }
  Quat rotation() {
    const double angle = uniform(0, M_PI);
    return quatFromRotationVector(angle * direction());
  }

 private:
  std::mt19937_64 bits_{1998};
};

struct PairQuery {
  const contact::PatchCacheHandle cache = contact::makePatchCache();
  PairPoints found;

  const PairPoints& of(const Shape& a, const Pose& X_WA, const Shape& b, const Vec3& last_n_W, double margin) {
    contact::collideShapes(a, X_WA, b, Pose{}, margin, *cache, found, {last_n_W});
    return found;
  }
};

double leastGap(const PairPoints& p) {
  double least = kInfinity;
  for (int i = 0; i < p.count; ++i) least = std::min(least, p.points[static_cast<std::size_t>(i)].phi);
  return least;
}

// Of half-spaces the normal is known.
bool isHalfSpace(const Shape& shape) { return std::holds_alternative<contact::HalfSpace>(shape); }
ConvexGap bestGap(const Shape& a, const Pose& X_WA, const Shape& b) {
  if (!isHalfSpace(b)) return convexGap(a, X_WA, b, Pose{});
  const PlainSolid solid = plainSolid(a, X_WA);
  return {Vec3::UnitZ(), solid.furthest(-Vec3::UnitZ()).z() - solid.rounding};
}
double gapAlong(const Shape& a, const Pose& X_WA, const Shape& b, const Vec3& n) {
  if (!isHalfSpace(b)) return convexGapAlong(a, X_WA, b, Pose{}, n);
  return angleBetween(n, Vec3::UnitZ()) > 1e-12 ? -kInfinity : bestGap(a, X_WA, b).gap;
}

// a around b, `gap` from it, b at the origin.
Pose placed(Draws& draws, const Shape& a, const Shape& b, double gap) {
  Pose X_WA{draws.rotation(), 0.1 * draws.direction()};
  for (int i = 0; i < 6; ++i) {
    const ConvexGap g = bestGap(a, X_WA, b);
    X_WA.p += (gap - g.gap) * g.n;
  }
  return X_WA;
}

struct PlacedErrors {
  double direction = 0;  // by which the best direction's gap is greater than that of the normal [of the size]
  double gap = 0;        // of the points' least gap, from that along their normal [m]
  int missed = 0;        // without a point
};

// A mesh's contacts in overlap are local, each with its own normal: there only whether it is touched is asked.
PlacedErrors errorsOver(const PairBody& a, const PairBody& b, double from, double to, int count,
                        MeasureContext& context) {
  Draws draws;
  PairQuery query;
  PlacedErrors e;
  for (int i = 0; i < count && !context.interrupted(); ++i) {
    const Pose X_WA = placed(draws, a.solid, b.solid, draws.uniform(from, to));
    const PairPoints& p = query.of(a.shape, X_WA, b.shape, Vec3::Zero(), 0.02);
    if (p.count == 0) {
      ++e.missed;
      continue;
    }
    const ConvexGap best = bestGap(a.solid, X_WA, b.solid);
    if (a.is_mesh || b.is_mesh) {
      if (from >= 0) e.gap = std::max(e.gap, std::abs(leastGap(p) - best.gap));
      continue;
    }
    const double mine = gapAlong(a.solid, X_WA, b.solid, p.points[0].n_W);
    e.direction = std::max(e.direction, (best.gap - mine) / kPairSize);
    e.gap = std::max(e.gap, std::abs(leastGap(p) - mine));
  }
  return e;
}

// Tick i of a slide over b's top at 20 mm/s to and fro, turning at 0.2 rad/s, a micrometre above it.
Pose sliding(const PairBody& a, const PairBody& b, std::int64_t i) {
  const double t = 1e-3 * static_cast<double>(i % 1000);
  const double top = b.name == std::string_view("hull") ? 0.02 : b.height;
  return {quatFromRotationVector({0, 0, 0.2 * t}) * a.resting,
          {0.02 * (t < 0.5 ? t : 1 - t), 0.001, top + a.height + 1e-6}};
}

struct SlideFigures {
  double cold = 0, warm = 0;  // median cost [ns]
  double kept = 1;            // share of the points whose name was there a tick before
  double turn = 0;            // of the normal, largest per tick [rad]
};

bool wasThere(const PairPoints& before, std::uint32_t feature) {
  return std::any_of(before.points.begin(), before.points.begin() + before.count,
                     [&](const auto& p) { return p.feature == feature; });
}

SlideFigures slideOf(const PairBody& a, const PairBody& b) {
  constexpr double kMargin = 1e-3;  // [m]
  // Calls; 11 batches, odd for a median; chosen.
  constexpr TimingBudget kBudget{.warm_up = 100, .batches = 11, .calls_per_batch = 200, .single_calls = 0};
  SlideFigures f;
  PairQuery query;
  const Shape& under = b.shape;
  const Quat lies = b.resting;
  const Pose X_WB{lies, Vec3::Zero()};
  Vec3 last = Vec3::Zero();
  const auto ask = [&](std::int64_t i, const Vec3& last_n_W) {
    const Pose X_BA = X_WB.inverse() * sliding(a, b, i);
    query.of(a.shape, X_BA, under, last_n_W, kMargin);
  };
  f.cold = costOfCalls([&](std::int64_t i) { ask(i, Vec3::Zero()); }, kBudget).median;
  const auto goOn = [&](std::int64_t i) {
    ask(i, last);
    last = query.found.count > 0 ? query.found.points[0].n_W : Vec3(Vec3::Zero());
  };
  f.warm = costOfCalls(goOn, kBudget).median;
  PairPoints before;
  int points = 0, kept = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 n = last;
    goOn(i);
    for (int k = 0; i > 0 && k < query.found.count; ++k, ++points)
      kept += wasThere(before, query.found.points[static_cast<std::size_t>(k)].feature);
    if (i > 0 && query.found.count > 0) f.turn = std::max(f.turn, angleBetween(n, last));
    before = query.found;
  }
  f.kept = points > 0 ? static_cast<double>(kept) / points : 0;
  return f;
}

std::vector<Record> measurePair(const PairBody& a, const PairBody& b, MeasureContext& context) {
  constexpr int kPlaced = 60;  // placements per range; chosen: the exact gap is searched for each
  // Ranges of gaps [m]: one near, one of contacts to round-off, one up to a millimetre deep.
  struct {
    const char* name;
    double from, to;
  } constexpr kRanges[] = {{"near", 1e-6, 5e-3}, {"touching", -1e-9, 1e-9}, {"overlapping", -1e-3, -1e-7}};
  std::vector<Record> records;
  const bool boxes = a.name == std::string_view("box") && b.name == std::string_view("box");
  for (const auto& [name, from, to] : kRanges) {
    const PlacedErrors e = errorsOver(a, b, from, to, kPlaced, context);
    if (context.interrupted()) return records;
    records.push_back(exactly(fmt::format("{}: placements without a point", name), e.missed, "-", 0));
    if (a.is_mesh || b.is_mesh) {
      if (from >= 0) records.push_back(atMost(fmt::format("{}: gap", name), 1e6 * e.gap, "um", 1));
      continue;
    }
    records.push_back(
        atMost(fmt::format("{}: gap lost by the direction, of the size", name), e.direction, "-", boxes ? 1e-6 : 1e-9));
    records.push_back(
        atMost(fmt::format("{}: least gap of the points, from that along the normal", name), 1e6 * e.gap, "um", 1));
  }
  const SlideFigures f = slideOf(a, b);
  records.push_back(unbounded("sliding, begun anew, median", f.cold, "ns"));
  records.push_back(unbounded("sliding, from the last normal, median", f.warm, "ns"));
  records.push_back(atLeast("sliding: points whose name was there a tick before", 100 * f.kept, "%", 95));
  records.push_back(unbounded("sliding: largest turn of the normal per tick", f.turn / kDegree, "deg"));
  return records;
}

}  // namespace

std::vector<Measurement> pairMeasurements() {
  std::vector<Measurement> measurements;
  const std::vector<PairBody> bodies = pairBodies();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i; j < bodies.size(); ++j) {
      const PairBody a = bodies[i], b = bodies[j];
      if (isHalfSpace(a.shape)) continue;
      measurements.push_back({fmt::format("pair/{}-{}", a.name, b.name),
                              [a, b](MeasureContext& context) { return measurePair(a, b, context); }});
    }
  }
  return measurements;
}

}  // namespace pincer::tasks
