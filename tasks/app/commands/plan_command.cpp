#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "pincer/contact/io/printable.h"
#include "pincer/engine/world/stage_clock.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/plan_text.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/experiments/cylinder_alignment.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/scene/tick_times.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {
namespace {

constexpr const char* kPlanExample = R"(
What runs in a tick of a scene and in which specialised form, what is left out, and what each stage costs on
this machine, measured over a run of the scene (begun again where it ends before the wanted number of ticks).

Of the manipulation tasks, sphere-pickup and cylinder-alignment, what runs is named; times are those of a
scene.

Examples:
  pincer plan tasks/scenes/pickup.json --ticks 20000
  pincer plan sphere-pickup)";

struct PlanArguments {
  std::string scene;
  std::int64_t ticks = 20000;
  bool json = false;
};

struct PlanTimes {
  explicit PlanTimes(std::int64_t ticks) : whole(ticks), stages(engine::kStageCount, TickTimes(ticks)) {}
  TickTimes whole;  // without the stage clock
  std::vector<TickTimes> stages;
  double clock_cost = 0;  // of one mark of the stage clock, included in each stage [s]
  bool interrupted = false;
};

// Ticks through the scene, begun again as often as needed. `work` is called once per tick and steps the simulation.
template <typename Work>
void repeatScene(const Scene& scene, std::int64_t ticks, PlanTimes& times, Progress& progress, std::int64_t done_before,
                 const Work& work) {
  std::optional<Simulation> simulation;
  for (std::int64_t i = 0; i < ticks && !times.interrupted; ++i) {
    if (!simulation || simulation->ticks() == scene.ticks()) simulation.emplace(scene);
    work(*simulation);
    progress.update(done_before + i);
    times.interrupted = interruptFlag().load(std::memory_order_relaxed);
  }
}

// The median of batches, so that a batch in which another process ran doesn't count.
double costOfMark() {
  // Batches, odd for their median; marks in one, since a single mark is too short to time; chosen.
  constexpr int kBatches = 101, kMarks = 100;
  TickTimes batches(kBatches);
  engine::StageClock clock;
  for (int i = 0; i < kBatches; ++i) {
    batches.time([&] {
      for (int k = 0; k < kMarks; ++k) clock.mark(engine::Stage::kPredict);
    });
  }
  return batches.quantile(0.5) / kMarks;
}

PlanTimes measureStages(const Scene& scene, std::int64_t ticks) {
  PlanTimes times(ticks);
  Progress progress("plan", 2 * ticks);
  repeatScene(scene, ticks, times, progress, 0, [&](Simulation& s) { times.whole.time([&] { s.tick(); }); });
  engine::StageClock clock;
  repeatScene(scene, ticks, times, progress, ticks, [&](Simulation& s) {
    clock.seconds = {};
    engine::timeStages(&clock, grasp::worldOf(s.scratch()));
    s.tick();
    for (std::size_t i = 0; i < times.stages.size(); ++i) times.stages[i].add(clock.seconds[i]);
  });
  times.clock_cost = costOfMark();
  return times;
}

// The scene of a manipulation task.
std::optional<grasp::GraspModel> taskModel(const std::string& name) {
  const SpherePickupOptions pickup;
  if (name == "sphere-pickup") return makePickupScene(pickup, makePickupObject(pickup), {}).model.grasp;
  if (name == "cylinder-alignment") return makeCylinderScene({}, {}).model.grasp;
  return std::nullopt;
}

std::string linesText(const std::vector<PlanLine>& plan) {
  std::size_t width = 0;
  for (const PlanLine& line : plan) width = std::max(width, line.name.size());
  std::string out;
  for (const PlanLine& line : plan) out += fmt::format("  {:<8} {:<{}}  {}\n", line.part, line.name, width, line.form);
  return out;
}

void writeLines(const std::vector<PlanLine>& plan, JsonWriter& json) {
  json.key("plan").beginArray();
  for (const PlanLine& line : plan)
    json.beginObject()
        .key("part")
        .value(line.part)
        .key("name")
        .value(line.name)
        .key("form")
        .value(line.form)
        .endObject();
  json.endArray();
}

std::string timesRow(const char* name, const TickTimes& times) {
  return fmt::format("  {:<18} {:>9.3f} {:>9.3f}\n", name, 1e6 * times.quantile(0.5), 1e6 * times.quantile(0.999));
}

std::string planText(const Scene& scene, const std::vector<PlanLine>& plan, const PlanTimes& times) {
  std::string out = fmt::format("{}\n{}\n\n", printable(scene.file), printable(scene.description, kLongestMessage));
  out += linesText(plan);
  out += fmt::format("\n  {:<18} {:>9} {:>9}   [us], {} ticks\n", "stage", "median", "p99.9", times.whole.count());
  for (std::size_t i = 0; i < times.stages.size(); ++i) out += timesRow(engine::kStageNames[i], times.stages[i]);
  out += timesRow("whole tick", times.whole);
  return out +
         fmt::format("  Each stage's time holds {:.3f} us of the clock itself; the whole tick was timed without it.\n",
                     1e6 * times.clock_cost);
}

void writeTimes(const char* name, const TickTimes& times, JsonWriter& json) {
  json.beginObject().key("stage").value(name).key("median_us").value(1e6 * times.quantile(0.5));
  json.key("p999_us").value(1e6 * times.quantile(0.999)).endObject();
}

std::string planJson(const Scene& scene, const std::vector<PlanLine>& plan, const PlanTimes& times) {
  JsonWriter json;
  json.beginObject().key("scene").value(scene.file);
  writeLines(plan, json);
  json.key("ticks").value(times.whole.count()).key("clock_us").value(1e6 * times.clock_cost).key("stages").beginArray();
  for (std::size_t i = 0; i < times.stages.size(); ++i) writeTimes(engine::kStageNames[i], times.stages[i], json);
  writeTimes("whole tick", times.whole, json);
  return json.endArray().endObject().text();
}

int showTaskPlan(const std::string& task, const grasp::GraspModel& model, bool as_json) {
  const std::vector<PlanLine> plan = describePlan(model, std::vector<grasp::FingerMethod>(model.fingers.size()));
  JsonWriter json;
  json.beginObject().key("task").value(task);
  writeLines(plan, json);
  print("{}", as_json ? json.endObject().text() : task + "\n\n" + linesText(plan));
  return kExitOk;
}

int runPlan(const PlanArguments& arguments) {
  if (const auto task = taskModel(arguments.scene)) return showTaskPlan(arguments.scene, *task, arguments.json);
  const Scene scene = readSceneOrBuiltin(arguments.scene);
  const std::vector<PlanLine> plan = describePlan(buildWorld(scene), methodsOf(scene));
  const PlanTimes times = measureStages(scene, arguments.ticks);
  print("{}", arguments.json ? planJson(scene, plan, times) : planText(scene, plan, times));
  if (!times.interrupted) return kExitOk;
  print(stderr, "pincer: interrupted; the times are those of the ticks that were done.\n");
  return kExitInterrupted;
}

}  // namespace

void addPlanCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = app.add_subcommand("plan", "What runs in a tick of a scene, and what it costs");
  command
      ->add_option("scene", arguments->scene,
                   "Scene file (JSON), the name of a built-in scene, sphere-pickup or cylinder-alignment")
      ->required();
  command->add_option("--ticks", arguments->ticks, "Ticks to measure")
      ->check(wholeWithin(1, 10'000'000))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print the plan as JSON");
  command->footer(kPlanExample);
  command->callback([arguments, &exit_code] { exit_code = runPlan(*arguments); });
}

}  // namespace pincer::tasks
