// Runs a scene file and writes what it records as a table: run_scene_file SCENE.json TABLE.csv
#include <pincer/pincer.h>

#include <cstdio>
#include <fstream>

using namespace pincer;

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "run_scene_file SCENE.json TABLE.csv\n"), 2;
  try {
    tasks::Simulation simulation(tasks::readScene(argv[1]));
    const tasks::Scene& scene = simulation.scene();
    tasks::CsvTable table;
    table.add("time");
    for (const tasks::Quantity& quantity : scene.record.quantities) table.add(quantity.name);
    table.endRow();
    while (simulation.ticks() < scene.ticks()) {
      if (simulation.tick().status & engine::kStateNotFinite) return 1;
      if (simulation.ticks() % scene.record.every != 0) continue;
      table.add(simulation.time());
      for (const tasks::Quantity& quantity : scene.record.quantities) table.add(quantity.measure(simulation.moment()));
      table.endRow();
    }
    std::ofstream(argv[2]) << table.text();
    std::printf("%s: %.3g s in %lld ticks\n", argv[1], simulation.time(), static_cast<long long>(simulation.ticks()));
  } catch (const InputError& error) {  // a sentence: file, line, value, range, remedy
    return std::fprintf(stderr, "%s\n", error.what()), 3;
  }
}
