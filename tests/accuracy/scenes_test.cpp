// Every scene of tasks/scenes keeps what it expects, over its whole duration.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <filesystem>

#include "pincer/tasks/run/scene/sim_run.h"

namespace pincer::tasks {
namespace {

namespace fs = std::filesystem;
const fs::path kScenesFolder = PINCER_SOURCE_DIR "/tasks/scenes";

std::vector<std::string> sceneFiles() {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(kScenesFolder)) {
    if (entry.path().extension() == ".json") files.push_back(fs::relative(entry.path(), kScenesFolder).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class SceneFiles : public testing::TestWithParam<std::string> {};

TEST_P(SceneFiles, KeepWhatTheyExpect) {
  Simulation simulation(readScene((kScenesFolder / GetParam()).string()));
  const Scene& scene = simulation.scene();
  const std::atomic<bool> interrupted = false;
  const SimResult result = runScene(simulation, {}, interrupted, [](std::int64_t) {});
  for (std::size_t i = 0; i < scene.expectations.size(); ++i) {
    const Outcome& outcome = result.log.outcomes()[i];
    EXPECT_TRUE(outcome.holds()) << scene.expectations[i].because << ": measured " << outcome.measured << ", worst at "
                                 << outcome.worst_time << " s, beyond its tolerance by " << outcome.worst_excess;
  }
  EXPECT_FALSE(scene.expectations.empty());
}

std::string sceneTestName(const testing::TestParamInfo<std::string>& info) {
  std::string name = fs::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, SceneFiles, testing::ValuesIn(sceneFiles()), sceneTestName);

}  // namespace
}  // namespace pincer::tasks
