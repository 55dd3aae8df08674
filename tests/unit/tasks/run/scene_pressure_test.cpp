// Pressure maps of a scene's fingers: read, recorded and refused.
#include <gtest/gtest.h>

#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/error_of.h"

namespace pincer::tasks {
namespace {

std::string sceneOfPad(const std::string& finger, const std::string& record) {
  return R"({"version": 1, "duration": 0.05, "bodies": [{"name": "plate", "shape": {"type": "half_space"}, "static": true, "material": {"mu_s": 0.5}}],
             "fingers": [{"name": "index", "position": [0, 0, 0.007], "modulus": 1e5)" +
         finger + R"(}], "record": {"quantities": [)" + record + "]}}";
}

TEST(ScenePressure, IsRecordedAsOneColumnPerTaxel) {
  const Scene scene = parseScene(
      sceneOfPad(R"(, "taxels": {"rows": 4, "columns": 3})", R"("index.normal_force", "index.pressure")"), "pad.json");
  ASSERT_EQ(scene.record.quantities.size(), 13u);
  EXPECT_EQ(scene.record.quantities[1].name, "index.pressure_0_0");
  EXPECT_EQ(scene.record.quantities[12].name, "index.pressure_3_2");
  EXPECT_EQ(scene.fingers[0].model.taxels.pitch, 2e-3);
  Simulation simulation(scene);
  for (int i = 0; i < 20; ++i) simulation.tick();
  double sum = 0;
  for (std::size_t k = 1; k < 13; ++k) sum += scene.record.quantities[k].measure(simulation.moment());
  EXPECT_GT(sum, 0.5);
  EXPECT_NEAR(sum, scene.record.quantities[0].measure(simulation.moment()), 1e-12);
  EXPECT_EQ(quantityOf("index.pressure", scene).measure(simulation.moment()), sum);
}

TEST(ScenePressure, RefusesWhatIsNoTaxel) {
  const auto message = [](const std::string& finger, const std::string& record) {
    return tests::errorOf([&] { parseScene(sceneOfPad(finger, record), "pad.json"); });
  };
  const std::string taxels = R"(, "taxels": {"rows": 4, "columns": 3})";
  EXPECT_NE(message("", R"("index.pressure")").find("needs the finger's key \"taxels\""), std::string::npos);
  for (const char* name : {"index.pressure_4_0", "index.pressure_0_3", "index.pressure_1", "index.pressure_-1_0",
                           "index.pressure_1_1x", "index.pressure_"}) {
    EXPECT_NE(message(taxels, '"' + std::string(name) + '"').find("4 rows and 3 columns"), std::string::npos) << name;
  }
  EXPECT_NE(message(R"(, "taxels": {"rows": 1, "columns": 3})", "").find("rows"), std::string::npos);
  EXPECT_NE(message(R"(, "taxels": {"rows": 4})", "").find("columns"), std::string::npos);
  EXPECT_NE(message(R"(, "taxels": {"rows": 4, "columns": 3, "pitch": 0})", "").find("pitch"), std::string::npos);
}

}  // namespace
}  // namespace pincer::tasks
