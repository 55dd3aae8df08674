// The variants of shading side by side on the same sweep: what shading buys over facets
// and over force shading, and what it costs.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

#include "pincer/contact/generated_meshes.h"
#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/objects.h"
#include "pincer/tasks/judge/bench/sweep.h"
#include "pincer/tasks/judge/bench/sweep_plot.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

using contact::SmoothMesh;
using contact::SurfaceVariant;

constexpr double kDepth = 0.002;  // [m]

struct NamedVariant {
  SurfaceVariant variant;
  const char* name;
};
// Variants of a surface that are compared, and their names in the record.
constexpr std::array<NamedVariant, 4> kVariants = {{{SurfaceVariant::smooth, "smooth"},
                                                    {SurfaceVariant::smooth_published, "smooth as published"},
                                                    {SurfaceVariant::force, "force"},
                                                    {SurfaceVariant::facet, "facet"}}};

// An object and a sweep around it. On round ones the ideal contact turns evenly with the path and stays equally deep.
struct Sweep {
  std::string name;
  contact::TriangleMesh mesh;
  SweepPlane plane;
  double circle = 0;  // radius of the finger's circle [m]; 0: not round, follow the smooth surface
  // what a facet's edge throws the contact by, r times the angle between facets [m]; 0: not promised
  double facet_jump = 0;
};

FingerPath pathOf(const Sweep& sweep) {
  if (sweep.circle > 0) return circleAround(sweep.plane, sweep.circle);
  const auto mesh = SmoothMesh::build(sweep.mesh);
  return sweepAround(*mesh, sweep.plane, frameFromNormal(sweep.plane.axis).col(0), 2.5 * mesh->boundingRadius(),
                     kDepth);
}

double costOf(const SmoothMesh& mesh, const FingerPath& path) {
  BenchFinger finger;
  double sum = 0;
  const auto n = static_cast<std::int64_t>(path.centres.size());
  const auto query = [&](std::int64_t i) {
    if (i % n == 0) finger.tracker = {};
    sum += finger.on(mesh, path.centres[static_cast<std::size_t>(i % n)]).main().phi;
  };
  return costOfCalls(query, {.warm_up = 500, .batches = 11, .calls_per_batch = 500, .single_calls = 0}).median;
}

double largestTurn(const std::vector<Vec3>& n) {
  double largest = 0;
  for (std::size_t i = 1; i < n.size(); ++i)
    largest = std::max(largest, math::atan2(n[i - 1].cross(n[i]).norm(), n[i - 1].dot(n[i])));
  return largest;
}

void addRow(const Sweep& sweep, const NamedVariant& variant, const SweepTrace& trace, double cost,
            std::vector<Record>& records) {
  const std::string of = std::string(variant.name) + ": ";
  const double step = 1e3 * largestStep(trace.place);
  const bool facet = variant.variant == SurfaceVariant::facet;
  // the baseline must be what the literature says of it, or the comparison means nothing
  if (facet && sweep.facet_jump > 0) {
    records.push_back(
        atMost(of + "largest step on the finger, off r theta by", std::abs(step - 1e3 * sweep.facet_jump), "mm", 0.06));
  }
  const bool smooth = variant.variant == SurfaceVariant::smooth;
  const auto held = static_cast<double>(trace.held);
  records.push_back(smooth ? exactly(of + "ticks without an answer", held, "-", 0)
                           : unbounded(of + "ticks without an answer", held, "-"));
  records.push_back(unbounded(of + "largest step on the finger per tick", step, "mm"));
  records.push_back(unbounded(of + "largest turn of the force per tick", largestTurn(trace.n) * 180 / M_PI, "deg"));
  if (sweep.circle > 0) {
    const auto [low, high] = std::minmax_element(trace.phi.begin(), trace.phi.end());
    records.push_back(unbounded(of + "ripple of the place on the finger", 1e3 * rippleAboutLine(trace.place), "mm"));
    records.push_back(unbounded(of + "ripple of the force, of its mean", 100 * (*high - *low) / kDepth, "%"));
  }
  records.push_back(unbounded(of + "cost per query", cost, "ns"));
}

std::vector<Record> compare(const Sweep& sweep, const std::string& out, MeasureContext& context) {
  const FingerPath path = pathOf(sweep);
  std::vector<Record> records;
  std::vector<NamedTrace> traces;
  for (const NamedVariant& variant : kVariants) {
    const auto mesh = SmoothMesh::build(sweep.mesh, {.variant = variant.variant});
    traces.push_back({variant.name, traceAlong(*mesh, path, sweep.plane)});
    addRow(sweep, variant, traces.back().trace, costOf(*mesh, path), records);
    context.progress(static_cast<double>(traces.size()) / kVariants.size());
    if (context.interrupted()) return records;
  }
  if (!out.empty()) writeSweep(out, sweep.name, traces);
  return records;
}

std::vector<Sweep> generatedSweeps() {
  constexpr double r = kBenchFinger;
  const SweepPlane tilted{Vec3(0.3, -0.2, 1).normalized(), 0}, beside{Vec3::UnitZ(), 0.003};
  std::vector<Sweep> sweeps;
  sweeps.push_back(
      {"cylinder-15deg", contact::cylinder(0.025, 0.03, 24, 6), beside, 0.025 + r - kDepth, r * M_PI / 12});
  sweeps.push_back({"cylinder-30deg", contact::cylinder(0.025, 0.03, 12, 6), beside, 0.025 + r - kDepth, r * M_PI / 6});
  sweeps.push_back({"sphere-320", contact::icosphere(0.02, 2), tilted, 0.02 + r - kDepth, 0});
  sweeps.push_back({"cylinder-with-flat", contact::cylinderWithFlat(0.025, 0.03, 0.018, 18, 6), beside, 0, 0});
  sweeps.push_back({"torus", contact::torus(0.03, 0.012, 24, 12), {Vec3::UnitY(), 0}, 0, 0});
  sweeps.push_back({"rounded-cube", contact::roundedCube(0.02, 0.004, 2), beside, 0, 0});
  return sweeps;
}

}  // namespace

std::vector<Measurement> shadingMeasurements(const ContactBenchOptions& options) {
  std::vector<Measurement> measurements;
  const std::string out = options.out;
  for (Sweep& sweep : generatedSweeps()) {
    const auto shared = std::make_shared<const Sweep>(std::move(sweep));
    measurements.push_back(
        {"shading/" + shared->name, [=](MeasureContext& context) { return compare(*shared, out, context); }});
  }
  if (options.meshes.empty()) return measurements;
  for (const MeshFile& file : meshFilesIn(options.meshes)) {
    const auto run = [=](MeasureContext& context) {
      return measureFile(file, [&](BenchObject object) {
        return compare({object.name, std::move(object.mesh), {}, 0, 0}, out, context);
      });
    };
    measurements.push_back({"shading/file/" + file.name, run});
  }
  return measurements;
}

}  // namespace pincer::tasks
