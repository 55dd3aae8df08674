// Pages of scenes: their data says where things were, by a second simulation and a decoder of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/share/packed_text.h"
#include "pincer/tasks/share/share_scene.h"
#include "pincer/tasks/share/web_page.h"
#include "pincer/tests/unit/share/page_reader.h"

namespace pincer::tasks {
namespace {

using tests::PageReader;
const std::atomic<bool> kNever{false};

Simulation simulationOf(const char* scene, double duration) {
  Scene read = readBuiltinScene(scene);
  read.duration = duration;
  return Simulation(std::move(read));
}

struct SharedScene {
  MeshTable meshes;
  WebPage page;
  SharedScene(const char* scene, double duration) {
    Simulation simulation = simulationOf(scene, duration);
    page.title = scene;
    page.recordings.push_back(recordScene(simulation, scene, meshes, kNever));
  }
};

// Everything of a page with one recording, in its order.
struct ReadPage {
  nlohmann::json index;
  std::vector<std::vector<std::vector<std::vector<double>>>> groups;  // group, item, number of the matrix, picture
  std::vector<std::vector<double>> charts;

  explicit ReadPage(const PageData& data) : index(nlohmann::json::parse(data.index)) {
    PageReader reader(data.bytes);
    for (const auto& mesh : index["meshes"]) {
      for (int i = 0; i < 6; ++i) reader.column(mesh["vertices"]);
      for (const std::uint32_t corner : reader.indices(mesh["indices"]))
        EXPECT_LT(corner, mesh["vertices"].get<std::uint32_t>());
    }
    const auto& recording = index["recordings"][0];
    const std::size_t pictures = recording["times"].size();
    for (const auto& group : recording["groups"]) {
      auto& items = groups.emplace_back();
      for (int i = 0; i < group["items"]; ++i) {
        auto& item = items.emplace_back();
        for (int k = 0; k < 12; ++k) item.push_back(reader.column(pictures));
      }
    }
    for (std::size_t i = 0; i < recording["charts"].size(); ++i) charts.push_back(reader.column(pictures));
    for (std::size_t i = 0; i < 5 * recording["pads"].size(); ++i) reader.column(pictures);
    EXPECT_TRUE(reader.atEnd());
  }
};

double range(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

class PageOfScene : public testing::TestWithParam<const char*> {};

// The bodies' shapes are drawn first, in the model's order; their matrices are X_WB
// X_BS, the picture's times those of ticks.
TEST_P(PageOfScene, HasBodiesWhereTheyWereToHalfAStep) {
  constexpr double kSeconds = 0.3;
  SharedScene shared(GetParam(), kSeconds);
  const ReadPage read(dataOf(shared.page, shared.meshes));
  const std::vector<double> times = read.index["recordings"][0]["times"];
  ASSERT_GE(times.size(), 100u);
  Simulation again = simulationOf(GetParam(), kSeconds);
  std::vector<std::size_t> seen_of_group(read.groups.size());
  for (std::size_t picture = 0; picture < times.size(); ++picture) {
    while (again.time() < times[picture] - 1e-9) again.tick();
    std::fill(seen_of_group.begin(), seen_of_group.end(), 0);
    for (const engine::BodyModel& body : again.model().world.bodies) {
      for (const engine::ColliderModel& collider : engine::collidersOf(again.model().world, body)) {
        const Pose X_WS = again.bodyPose(collider.body) * collider.X_BS;
        // In which group it is isn't known here: some item is where it was, in place and turn.
        double closest = INFINITY, allowed = 0;
        for (const auto& items : read.groups) {
          for (const auto& item : items) {
            const Mat3 R = X_WS.q.toRotationMatrix();
            double error = 0, step = 1e-6;  // floats of metres and of numbers up to 1
            for (int k = 0; k < 12; ++k) {
              const auto& column = item[static_cast<std::size_t>(k)];
              error = std::max(error, std::abs(column[picture] - (k < 9 ? R(k % 3, k / 3) : X_WS.p[k % 3])));
              step = std::max(step, range(column) / 65534);
            }
            if (error < closest) {
              closest = error;
              allowed = step;
            }
          }
        }
        EXPECT_LE(closest, allowed) << body.name << " at " << times[picture] << " s";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PageOfScene,
                         testing::Values("s1_tumbling_box", "s4_pinch", "s6_stack", "pickup", "two_jaw_gripper"));

TEST(Page, ChartsWhatTheSceneRecords) {
  constexpr double kSeconds = 1.5;
  SharedScene shared("pickup", kSeconds);
  const ReadPage read(dataOf(shared.page, shared.meshes));
  const auto& recording = read.index["recordings"][0];
  Simulation again = simulationOf("pickup", kSeconds);
  while (again.ticks() < again.scene().ticks()) again.tick();
  std::size_t compared = 0;
  for (std::size_t i = 0; i < read.charts.size(); ++i) {
    for (const Quantity& quantity : again.scene().record.quantities) {
      if (recording["charts"][i]["name"] != quantity.name) continue;
      EXPECT_NEAR(read.charts[i].back(), quantity.measure(again.moment()), 1e-6 + range(read.charts[i]) / 65534)
          << quantity.name;
      ++compared;
    }
  }
  EXPECT_EQ(compared, again.scene().record.quantities.size());
  EXPECT_GT(read.charts[0].back(), 0.5) << "the first finger is felt";
}

TEST(Page, WithoutSpaceHasFewerPicturesOfTheSameRun) {
  SharedScene shared("pickup", 4);
  const std::vector<double> before = shared.page.recordings[0].times();
  const std::vector<double> force = shared.page.recordings[0].charts()[0].values;
  shared.page.recordings[0].halve();
  const PageRecording& after = shared.page.recordings[0];
  ASSERT_EQ(after.times().size(), before.size() / 2 + 1);
  EXPECT_EQ(after.times().back(), before.back());
  for (std::size_t i = 0; 2 * i < before.size(); ++i) {
    EXPECT_EQ(after.times()[i], before[2 * i]);
    EXPECT_EQ(after.charts()[0].values[i], force[2 * i]);
  }
  const ReadPage read(
      // all columns are as long as the times, else the data doesn't end where it should
      dataOf(shared.page, shared.meshes));
}

TEST(Page, SaysNothingThatEndsItsScript) {
  if (kPageShell.missing) GTEST_SKIP() << kPageShell.missing;
  SharedScene shared("s4_pinch", 0.05);
  shared.page.title = "</script><b>&";
  const std::string html = htmlOf(shared.page, shared.meshes);
  EXPECT_EQ(html.find("</script><b>"), std::string::npos);
  EXPECT_NE(html.find("<title>&lt;/script&gt;&lt;b&gt;&amp;</title>"), std::string::npos);
  EXPECT_EQ(html.find("{{pincer"), html.npos) << "a mark of the shell was left";
}

TEST(Page, LoadsNothingFromElsewhere) {
  if (kPageShell.missing) GTEST_SKIP() << kPageShell.missing;
  SharedScene shared("s4_pinch", 0.05);
  const std::string html = htmlOf(shared.page, shared.meshes);
  for (const char* loading :
       {"<script src", "<link rel=\"stylesheet", "<img src=\"http", "@import", "importScripts("}) {
    EXPECT_EQ(html.find(loading), html.npos) << loading;
  }
  EXPECT_NE(html.find("three.js authors"), html.npos) << "the licence goes with the page";
  EXPECT_LT(html.size(), kLargestPage);
}

// RFC 4648, section 10.
TEST(PackedText, IsTheBase64OfItsStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace pincer::tasks
