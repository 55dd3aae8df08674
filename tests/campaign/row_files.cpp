// Files that people write or export, harmed: scenes, studies, trajectories, meshes, recordings, calibrations.
#include <fmt/format.h>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/mutation.h"
#include "pincer/tests/campaign/rows.h"

namespace pincer::campaign {
namespace {

// [s] for what takes milliseconds if the file is sound; then it is asked to stop, and must
constexpr double kPatience = 5;

// Behind a NUL no reader may stop and be content.
std::set<int> codesFor(const std::string& text) {
  return text.find('\0') == text.npos ? std::set{0, 1, 2, 3, 4, 5} : std::set{3};
}

Launch shortly(Launch launch) {
  launch.limit = kPatience;
  return launch;
}

}  // namespace

void harmScene(Case& c) {
  const fs::path sound = c.anyOf(sceneFiles(c.ground));
  fs::create_directory_symlink(c.ground.inputs() / "scenes/files", c.folder / "files");
  const std::string text = mutatedJson(c.random, readFile(sound));
  c.write("scene.json", text);
  const bool plan = c.chance(0.2);
  c.run(shortly(c.pincer(plan ? std::vector<std::string>{"plan", "scene.json", "--ticks", "50"}
                              : std::vector<std::string>{"sim", "scene.json", "--duration", "0.05"})),
        {.name = "scene.json", .codes = codesFor(text)});
}

void harmStudy(Case& c) {
  const fs::path sound = c.anyOf(studyFiles(c.ground));
  const std::string task = sound.stem();
  const std::string text = mutatedJson(c.random, readFile(sound));
  c.write("study.json", text);
  std::vector<std::string> arguments = {"run", task, "--study", "study.json"};
  if (task == "manipulation") {
    arguments.insert(arguments.end(), {"--write-study", "written.json"});
  } else {
    arguments.push_back("--print-study");
  }
  c.run(shortly(c.pincer(arguments)), {.name = "study.json", .codes = codesFor(text)});
}

void harmTrajectory(Case& c) {
  fs::copy_file(trajectoryScene(c.ground), c.folder / "scene.json");
  const std::string text = mutatedText(c.random, readFile(trajectoryTable(c.ground)));
  c.write("trajectory.csv", text);
  c.run(shortly(c.pincer({"sim", "scene.json", "--duration", "0.05"})),
        {.name = "trajectory.csv", .codes = codesFor(text)});
}

void harmMesh(Case& c) {
  const fs::path sound = c.anyOf(meshFiles(c.ground));
  const std::string name = "mesh" + sound.extension().string(), bytes = readFile(sound);
  const bool text = bytes.find('\0') == bytes.npos;
  c.write(name, text ? mutatedText(c.random, bytes) : mutatedBytes(c.random, bytes));
  const std::vector<std::vector<std::string>> ways = {
      {"mesh", "info", name, "--units", "cm"},
      {"mesh", "check", name, "--units", "cm"},
      {"mesh", "convert", name, "out" + c.anyOf(std::vector<std::string>{".obj", ".stl", ".ply", ".off"}), "--units",
       "cm"},
      {"mesh", "convert", name, "out.obj", "--units", "cm", "--repair", "--weld", "0.01", "--fill-holes", "1000"},
      {"mesh", "round-edges", name, "out.ply", "--units", "cm"},
      {"mesh", "simplify", name, "out.ply", "--units", "cm"},
      {"mesh", "subdivide", name, "out.obj", "--units", "cm"},
      {"run", "sphere-pickup", "--object", name, "--units", "cm", "--repetitions", "1", "--friction", "0.9",
       "--no-report", "--out", "out"}};
  Launch launch =
      shortly(c.pincer(c.chance(0.05) ? ways.back() : ways[static_cast<std::size_t>(c.below(ways.size() - 1))]));
  c.run(launch, {.name = name});
}

void harmDeviceFile(Case& c) {
  if (c.number % 2 == 0) {
    c.write("arm.json", mutatedJson(c.random, readFile(calibrationFile(c.ground))));
    c.run(shortly(c.pincer({"devices", "calibrate", "NONE", "--load", "arm.json"})), {.name = "", .codes = {3, 4}});
    return;
  }
  c.write("recording.csv", mutatedText(c.random, readFile(recordingFile(c.ground))));
  // An accepted recording runs by the wall clock: half a second of it is enough.
  Launch launch =
      c.pincer({"run", "sphere-pickup", "--devices", "replay", "--recording", "recording.csv", "--yes", "--repetitions",
                "1", "--friction", "0.9", "--condition", "force", "--no-report", "--out", "out"});
  launch.limit = 0.2;
  c.run(launch, {.name = ""});
}

}  // namespace pincer::campaign
