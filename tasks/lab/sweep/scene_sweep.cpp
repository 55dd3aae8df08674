#include "pincer/tasks/lab/sweep/scene_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>

#include "pincer/contact/io/counted.h"
#include "pincer/tasks/lab/sweep/sweep_parts.h"
#include "pincer/tasks/run/files/fingerprint.h"
#include "pincer/tasks/run/scene/json_change.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {
namespace {

enum class Over { kEnd, kLeast, kLargest };

struct SweptMeasure {
  Quantity quantity;
  Over over = Over::kEnd;

  double start() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();  // that every value is less, or more, than
    return over == Over::kLeast ? kInfinity : -kInfinity;
  }
  double next(double sofar, double value) const {
    return over == Over::kEnd ? value : over == Over::kLeast ? std::min(sofar, value) : std::max(sofar, value);
  }
};

SweptMeasure measureOf(const std::string& text, const Scene& scene) {
  const std::size_t colon = text.find(':');
  const std::string word = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (colon != std::string::npos && word != "min" && word != "max") {
    throw InputError(fmt::format("--measure {}: \":{}\" isn't known. Nothing (the end), :min or :max.", text, word));
  }
  const Over over = word == "min" ? Over::kLeast : word == "max" ? Over::kLargest : Over::kEnd;
  return {quantityOf(text.substr(0, colon), scene), over};
}

std::vector<SweptMeasure> measuresOf(const SceneSweep& sweep, const Scene& scene) {
  std::vector<SweptMeasure> measures;
  for (const std::string& text : sweep.measures) measures.push_back(measureOf(text, scene));
  if (sweep.measures.empty()) {
    for (const Quantity& quantity : scene.record.quantities) measures.push_back({quantity});
  }
  if (measures.empty() && scene.expectations.empty()) {
    throw InputError(fmt::format(
        "{}: the scene records and expects nothing. Say what you want to know: --measure sphere.p_z", scene.file));
  }
  return measures;
}

std::string labelOf(const SweptMeasure& measure) {
  const char* over = measure.over == Over::kEnd ? "" : measure.over == Over::kLeast ? " (least)" : " (largest)";
  return fmt::format("{}{} [{}]", measure.quantity.name, over, measure.quantity.kind->unit);
}

Scene sceneAt(const NamedJson& scene, const SweepGrid& grid, std::size_t point) {
  JsonValue json = scene.json;
  for (std::size_t i = 0; i < grid.paths.size(); ++i)
    setNumber(json, scenePath(json, grid.paths[i]), grid.points[point][i]);
  return sceneOf(json, scene.name);
}

// Results of every measure, and then how many expectations failed. Up to where it was interrupted.
CaseResult measured(Scene scene, const SceneSweep& sweep, const std::atomic<bool>& interrupted) {
  Simulation simulation(std::move(scene));
  const std::vector<SweptMeasure> measures = measuresOf(sweep, simulation.scene());
  ExpectationLog log(simulation.scene().expectations);
  std::vector<double> values;
  for (const SweptMeasure& measure : measures) values.push_back(measure.start());
  const auto observe = [&] {
    log.observe(simulation.ticks(), simulation.time(), simulation.moment());
    for (std::size_t i = 0; i < measures.size(); ++i)
      values[i] = measures[i].next(values[i], measures[i].quantity.measure(simulation.moment()));
  };
  observe();
  for (bool finite = true; finite && simulation.ticks() < simulation.scene().ticks() && !interrupted;) {
    finite = (simulation.tick().status & engine::kStateNotFinite) == 0;
    observe();
  }
  if (!log.expectations().empty()) {
    const auto failed =
        std::count_if(log.outcomes().begin(), log.outcomes().end(), [](const Outcome& o) { return !o.holds(); });
    values.push_back(static_cast<double>(failed));
  }
  return {true, std::move(values), hashText(simulation.state().world), ""};
}

// The first case that can be read says what is measured; the others are read when their turn comes.
Scene firstReadable(const NamedJson& scene, const SceneSweep& sweep) {
  std::exception_ptr first;
  for (std::size_t i = 0; i < sweep.grid.points.size(); ++i) {
    try {
      return sceneAt(scene, sweep.grid, i);
    } catch (const InputError&) {
      if (!first) first = std::current_exception();
    }
  }
  std::rethrow_exception(first);
}

std::string definitionOf(const SweepTable& table, const NamedJson& scene, std::string_view text,
                         const SceneSweep& sweep) {
  JsonWriter json;
  json.beginObject().key("scene").value(scene.name).key("text").value(fingerprint(text)).key("measures").beginArray();
  for (const std::string& measure : sweep.measures) json.value(measure);
  json.endArray();
  writeGrid(table, json);
  return json.endObject().text();
}

}  // namespace

SweepJob sceneSweep(const NamedJson& scene, std::string_view text, const SceneSweep& sweep) {
  SweepJob job;
  job.table = tableOf(scene.name, sweep.grid);
  const Scene read = firstReadable(scene, sweep);
  for (const SweptMeasure& measure : measuresOf(sweep, read)) addMeasure(job.table, labelOf(measure), true);
  if (!read.expectations.empty()) {
    const auto count = static_cast<std::int64_t>(read.expectations.size());
    addMeasure(job.table, fmt::format("failed of {}", counted(count, "expectation")), job.table.plotted.empty());
  }
  job.definition = definitionOf(job.table, scene, text, sweep);
  job.measure = [scene, sweep](std::size_t i, const std::atomic<bool>& interrupted) {
    return measured(sceneAt(scene, sweep.grid, i), sweep, interrupted);
  };
  return job;
}

}  // namespace pincer::tasks
