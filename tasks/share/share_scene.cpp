#include "pincer/tasks/share/share_scene.h"

#include <algorithm>

#include "pincer/tasks/run/process/interrupted.h"

namespace pincer::tasks {
namespace {

Snapshot snapshotNow(const Simulation& simulation, const engine::StepReport& report) {
  Snapshot snapshot = Snapshot::sizedFor(simulation.model());
  captureGrasp(simulation.model(), simulation.state(), simulation.scratch(), report, snapshot);
  return snapshot;
}

}  // namespace

std::int64_t ticksPerPicture(std::int64_t ticks, double h) {
  const double by_rate = 1 / (kPicturesPerSecond * h), by_count = static_cast<double>(ticks) / kPicturesAtLeast;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(by_rate, by_count) + 1e-9));
}

PageRecording recordScene(Simulation& simulation, const std::string& title, MeshTable& meshes,
                          const std::atomic<bool>& interrupted,
                          const std::function<void(std::int64_t done)>& progress) {
  const Scene& scene = simulation.scene();
  const Snapshot start = snapshotNow(simulation, {});
  PageRecording recording(title, simulation.model(), start, meshes, simulation.scene().camera);
  const std::size_t first_chart = recording.charts().size();
  for (const Quantity& quantity : scene.record.quantities)
    recording.chart(quantity.name, std::string(quantity.kind->unit));
  const auto addPicture = [&](const Snapshot& snapshot) {
    recording.add(snapshot);
    for (std::size_t i = 0; i < scene.record.quantities.size(); ++i) {
      recording.charts()[first_chart + i].values.push_back(scene.record.quantities[i].measure(simulation.moment()));
    }
  };
  addPicture(start);
  const std::int64_t ticks = scene.ticks(), stride = ticksPerPicture(ticks, scene.options.h);
  while (simulation.ticks() < ticks) {
    throwIf(interrupted);
    const engine::StepReport report = simulation.tick();
    if (report.status & engine::kStateNotFinite) break;
    if (simulation.ticks() % stride == 0 || simulation.ticks() == ticks) addPicture(snapshotNow(simulation, report));
    if (progress) progress(simulation.ticks());
  }
  return recording;
}

}  // namespace pincer::tasks
