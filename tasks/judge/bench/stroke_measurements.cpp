// Iterations, failures and continuity of a finger that strokes an object.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "pincer/tasks/judge/bench/contact_bench.h"
#include "pincer/tasks/judge/bench/objects.h"
#include "pincer/tasks/judge/bench/path_figures.h"

namespace pincer::tasks {
namespace {

// The turn of a contact at an edge, 5 % more than it should; in a hollow the finger's centre
// runs on a smaller circle than its contact.
double turnLimit(const BenchObject& object) {
  constexpr double kSlack = 1.05;  // [-]: the 5 % above; chosen
  if (object.kind == ObjectKind::tight) return std::numeric_limits<double>::infinity();
  return kSlack * std::max(1.0, kBenchFinger / (object.concave_radius - kBenchFinger));
}

void addContinuity(const BenchObject& object, const PathFigures& f, std::vector<Record>& records) {
  const double limit = turnLimit(object);
  records.push_back(atMost("largest turn, of a sharp edge's", f.largest_turn, "-", limit));
  if (object.kind != ObjectKind::tight) records.push_back(exactly("jumps", static_cast<double>(f.jumps), "-", 0));
  // Of three contacts, each deepened by 1 um per um; eased contacts as much again.
  records.push_back(atMost("largest change of force, of a spring's", f.largest_push, "-",
                           object.kind == ObjectKind::tight ? 6 : 2.2));
  records.push_back(unbounded("largest step on the finger per um of centre step", f.largest_place, "um"));
  records.push_back(unbounded("largest turn per um of centre step", f.largest_degrees, "deg"));
}

std::vector<Record> recordsOf(const BenchObject& object, const PathFigures& f) {
  const bool smooth = object.kind == ObjectKind::smooth;
  const double inf = std::numeric_limits<double>::infinity();
  const auto share = [&](std::int64_t n) { return static_cast<double>(n) / static_cast<double>(f.queries); };
  std::vector<Record> records = {
      unbounded("warm queries", static_cast<double>(f.queries), "-"),
      atMost("iterations, mean", f.meanIterations(), "-", smooth ? 1.2 : inf),
      atMost("iterations, p99.9", f.iterationsQuantile(0.999), "-", smooth ? 4 : inf),
      atMost("iterations of one contact, most", f.longest_walk, "-", smooth ? 12 : 20),
      atMost("walks that failed, so that the tree was asked", share(f.reseeded), "-",
             object.kind == ObjectKind::tight ? 1e-3 : 0),
      exactly("queries left without an answer", static_cast<double>(f.held), "-", 0),
      exactly("answers that aren't finite", static_cast<double>(f.not_finite), "-", 0),
  };
  addContinuity(object, f, records);
  return records;
}

std::vector<Record> strokeRecords(const BenchObject& object, std::int64_t queries, MeasureContext& context) {
  const auto mesh = contact::SmoothMesh::build(object.mesh);
  Stroke stroke;
  stroke.ticks = queries;
  if (object.kind == ObjectKind::tight) stroke.depth = 0.001;
  const FingerPath path = strokeOver(*mesh, stroke, context);
  return recordsOf(object, walkPath(*mesh, path, turnLimit(object), context));
}

}  // namespace

std::vector<Measurement> strokeMeasurements(const ContactBenchOptions& options) {
  std::vector<Measurement> measurements;
  for (BenchObject& object : generatedObjects()) {
    const std::string name = fmt::format("stroke/{}/{}", nameOf(object.kind), object.name);
    const auto shared = std::make_shared<const BenchObject>(std::move(object));
    measurements.push_back(
        {name, [=](MeasureContext& context) { return strokeRecords(*shared, options.queries, context); }});
  }
  if (options.meshes.empty()) return measurements;
  for (const MeshFile& file : meshFilesIn(options.meshes)) {
    const auto run = [file, queries = options.queries](MeasureContext& context) {
      return measureFile(file, [&](const BenchObject& object) { return strokeRecords(object, queries, context); });
    };
    measurements.push_back({"stroke/file/" + file.name, run});
  }
  return measurements;
}

}  // namespace pincer::tasks
