#include "pincer/tasks/view/view_bench.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/servo/servo.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

constexpr devices::SurfaceSize kBenchSize{1280, 720};  // [pixels]: a usual window
constexpr int kBenchParts = 32;                        // of an icosahedron's edge: 20480 triangles
constexpr double kLeastPictures = 5;                   // a second, in software on two cores
constexpr double kMostSnapshotCost = 2000;             // [ns]

// The pick-up, its sphere replaced by a mesh of 20480 triangles when wanted, in the middle of the lift.
Simulation liftedScene(bool mesh) {
  Scene scene = readBuiltinScene("pickup");
  if (mesh)
    scene.bodies[1].shape = contact::Mesh{contact::SmoothMesh::build(contact::geodesicSphere(0.02, kBenchParts))};
  Simulation simulation(std::move(scene));
  for (int i = 0; i < 1800; ++i) simulation.tick();
  return simulation;
}

// Publishes every tick of a scene, begun again at its end, when `channel` is there.
class PublishingCycle final : public ServoCycle {
 public:
  PublishingCycle(double seconds, SnapshotChannel* channel)
      : simulation_(readBuiltinScene("pickup")), channel_(channel), ticks_(static_cast<long>(1000 * seconds)) {}
  bool tick(double) override {
    if (simulation_.ticks() == simulation_.scene().ticks()) return false;
    const auto report = simulation_.tick();
    if (channel_) {
      captureGrasp(simulation_.model(), simulation_.state(), simulation_.scratch(), report, channel_->writable());
      channel_->publish();
    }
    return --ticks_ > 0;
  }
  void cutForces() noexcept override {}
  const Simulation& simulation() const { return simulation_; }

 private:
  Simulation simulation_;
  SnapshotChannel* channel_;
  long ticks_;
};

std::vector<Record> picturesPerSecond(const ViewBenchOptions& options) {
  const Simulation simulation = liftedScene(true);
  const auto surface = devices::openOffscreen(kBenchSize);
  Snapshot snapshot = Snapshot::sizedFor(simulation.model());
  captureGrasp(simulation.model(), simulation.state(), simulation.scratch(), {}, snapshot);
  SnapshotChannel channel(snapshot);
  PaceControl pace;
  Viewer viewer(*surface, simulation.model(), snapshot, channel, pace, nullptr, {});
  std::vector<double> times;
  for (int i = 0; i < options.pictures + 2; ++i) {
    viewer.painter().camera().turn(0.02, 0);
    const double begin = steadySeconds();
    viewer.update();
    viewer.painter().picture();  // waits until it is drawn
    if (i >= 2) times.push_back(steadySeconds() - begin);
  }
  const double best = 1 / *std::min_element(times.begin(), times.end());
  return {atLeast("1280x720, 20480 triangles, best, " + viewer.painter().renderer().graphics(), best, "1/s",
                  kLeastPictures),
          unbounded("1280x720, 20480 triangles, median", 1 / quantileOf(times, 0.5), "1/s")};
}

std::vector<Record> snapshotCost() {
  Simulation simulation = liftedScene(false);
  SnapshotChannel channel(Snapshot::sizedFor(simulation.model()));
  const CallCost cost = costOfCalls([&](std::int64_t) {
    captureGrasp(simulation.model(), simulation.state(), simulation.scratch(), {}, channel.writable());
    channel.publish();
  });
  return {atMost("per tick, watched", cost.median, "ns", kMostSnapshotCost)};
}

ServoReport servedFor(double seconds, bool watched) {
  const Simulation look = liftedScene(false);
  Snapshot snapshot = Snapshot::sizedFor(look.model());
  captureGrasp(look.model(), look.state(), look.scratch(), {}, snapshot);
  SnapshotChannel channel(snapshot);
  PublishingCycle cycle(seconds, watched ? &channel : nullptr);
  std::atomic<bool> interrupted{false}, done{false};
  ServoReport report;
  std::thread servo([&] {
    ServoOptions options;
    options.clock = ServoClock::kPaced;
    report = runServo(options, cycle, interrupted);
    done = true;
  });
  if (watched) {
    const auto surface = devices::openOffscreen(kBenchSize);
    PaceControl pace;
    Viewer viewer(*surface, look.model(), snapshot, channel, pace, nullptr, {});
    while (!done) viewer.update();
  }
  servo.join();
  return report;
}

std::vector<Record> lateness(const ViewBenchOptions& options) {
  std::vector<Record> records;
  for (const bool watched : {false, true}) {
    const ServoReport report = servedFor(options.seconds, watched);
    const std::string who = watched ? "watched" : "unwatched";
    for (const auto& [name, q] : {std::pair{"median", 0.5}, std::pair{"99 %", 0.99}}) {
      records.push_back(unbounded("ticks late, " + who + ", " + name, 1e6 * report.lateness.quantile(q), "us"));
    }
    records.push_back(unbounded("ticks missed, " + who, static_cast<double>(report.missed), "-"));
  }
  return records;
}

}  // namespace

std::vector<Measurement> viewMeasurements(const ViewBenchOptions& options) {
  return {{"view/pictures", [options](MeasureContext&) { return picturesPerSecond(options); }},
          {"view/snapshot", [](MeasureContext&) { return snapshotCost(); }},
          {"view/lateness", [options](MeasureContext&) { return lateness(options); }}};
}

}  // namespace pincer::tasks
