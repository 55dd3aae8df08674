#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

const std::string kPictures = PINCER_SOURCE_DIR "/tests/unit/view/pictures";
constexpr devices::SurfaceSize kSmall{640, 360};

// Another driver draws borders a little differently and rounds colours its own way; what is lost or in the wrong place
// changes a block of 8 x 8 pixels by far more.
constexpr int kBlock = 8;
constexpr double kMeanDifference = 1.5, kWorstDifference = 40;  // of 255

// PINCER_NEW_PICTURES=1 makes the pictures anew; look at them before they are committed.
void expectPicture(const Image& image, const std::string& name) {
  const std::string wanted = kPictures + "/" + name + ".png";
  if (std::getenv("PINCER_NEW_PICTURES")) {
    std::filesystem::create_directories(kPictures);
    writePng(image, wanted);
  }
  const ImageDifference difference = compare(image, readPng(wanted), kBlock);
  if (difference.mean < kMeanDifference && difference.worst < kWorstDifference) return;
  const std::string seen = PINCER_BINARY_DIR "/" + name + "-seen.png";
  writePng(image, seen);
  ADD_FAILURE() << "mean " << difference.mean << ", worst block " << difference.worst << ": " << seen
                << " differs from " << wanted;
}

// A block with a V-shaped groove, and one finger pressed into it; or a ball between two.
struct Stage {
  grasp::GraspModel model;
  grasp::GraspState state;
  grasp::GraspScratch scratch;
  Snapshot snapshot;

  Stage(grasp::GraspModel built, const std::vector<engine::BodyStart>& starts, const std::vector<Vec3>& fingers)
      : model(std::move(built)),
        state(grasp::makeState(model, starts, fingers)),
        scratch(model),
        snapshot(Snapshot::sizedFor(model)) {}

  // Fingers go from where they start to `ends` in `ticks`, and rest there for as many.
  void press(const std::vector<Vec3>& starts, const std::vector<Vec3>& ends, int ticks) {
    std::vector<grasp::FingerInput> inputs(ends.size());
    engine::StepReport report;
    for (int tick = 1; tick <= 2 * ticks; ++tick) {
      const double share = std::min(1.0, static_cast<double>(tick) / ticks);
      for (std::size_t i = 0; i < ends.size(); ++i) inputs[i].p_WF = (1 - share) * starts[i] + share * ends[i];
      report = grasp::step(model, state, scratch, inputs);
    }
    captureGrasp(model, state, scratch, report, snapshot);
  }
};

Stage grooveStage() {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  const auto mesh = contact::SmoothMesh::build(contact::grooveBlock(45 * kDegree, 0.012, 0.03, 0.03));
  builder.addBody(
      {.name = "groove", .shape = contact::Mesh{mesh}, .dynamic = false, .material = {.mu_s = 0.4, .mu_d = 0.3}});
  std::vector<grasp::FingerModel> fingers(1);
  fingers[0].coupling.stiffness.setConstant(500);
  const std::vector<Vec3> start = {Vec3(0, 0, 0.03)};
  Stage stage(grasp::buildGrasp(std::move(builder), fingers), {{}}, start);
  stage.press(start, {Vec3(0.0005, 0, 0.0075)}, 300);
  return stage;
}

Stage pinchStage() {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({.name = "dish", .shape = contact::Dish{0.15}, .dynamic = false, .material = {}});
  builder.addBody({.name = "ball",
                   .shape = contact::Sphere{0.02},
                   .mass = 0.075,
                   .material = {.mu_s = 0.6, .mu_d = 0.5, .torsion_radius = 3e-3}});
  std::vector<grasp::FingerModel> fingers(2);
  fingers[0].name = "index";
  fingers[1].name = "thumb";
  for (auto& finger : fingers) finger.coupling.stiffness.setConstant(400);
  const std::vector<Vec3> start = {Vec3(-0.04, 0, 0.02), Vec3(0.04, 0, 0.02)};
  Stage stage(grasp::buildGrasp(std::move(builder), fingers), {{}, {.X_WB = {Quat::Identity(), Vec3(0, 0, 0.02)}}},
              start);
  stage.press(start, {Vec3(-0.024, 0, 0.02), Vec3(0.024, 0, 0.02)}, 300);
  return stage;
}

// The pixel's colour, and how much more green or red it is than blue.
struct Pixel {
  int red, green, blue;
};
Pixel pixelAt(const Image& image, const Vec2& at) {
  const auto i = static_cast<std::size_t>(3 * (std::lround(at.y()) * image.width + std::lround(at.x())));
  return {image.bytes[i], image.bytes[i + 1], image.bytes[i + 2]};
}

TEST(Pictures, AGrooveHoldsAFingerByTwoContacts) {
  const auto surface = devices::openOffscreen(kSmall);
  const Stage stage = grooveStage();
  ASSERT_EQ(stage.snapshot.contact_count, 2);
  Painter painter(*surface, stage.model, stage.snapshot);
  painter.camera().yaw = 0.6;
  painter.draw(stage.snapshot, {});
  expectPicture(painter.picture(), "groove");
}

// Truth, not taste: what is drawn is where the camera says that it is, in the colour of what it stands for.
TEST(Pictures, TheBallIsWhereItIsAndForcesPointFromTheContactsInTheColourOfTheirState) {
  const auto surface = devices::openOffscreen(kSmall);
  Stage stage = pinchStage();
  ASSERT_GE(stage.snapshot.contact_count, 2);
  Painter painter(*surface, stage.model, stage.snapshot);
  ViewChoice choice;
  choice.cones = choice.devices = false;
  for (const bool slips : {false, true}) {
    for (auto& contact : stage.snapshot.contacts) contact.sliding = slips;
    painter.draw(stage.snapshot, choice);
    const Image image = painter.picture();
    const Vec2 ball =
        *painter.camera().toPixel(stage.snapshot.X_WB[1].p + Vec3(0, 0, 0.012), kSmall.width, kSmall.height);
    const Pixel orange = pixelAt(image, ball);
    EXPECT_GT(orange.red, orange.blue + 60);
    int arrows = 0;
    for (int i = 0; i < stage.snapshot.contact_count; ++i) {
      const ContactSnapshot& contact = stage.snapshot.contacts[static_cast<std::size_t>(i)];
      if (contact.finger < 0) continue;
      ++arrows;
      const Vec3 tip = contact.p_W + 0.97 * painter.scene().metresPerNewton(stage.snapshot) * contact.f_W;
      const Pixel arrow = pixelAt(image, *painter.camera().toPixel(tip, kSmall.width, kSmall.height));
      EXPECT_GT(slips ? arrow.red : arrow.green, (slips ? arrow.green : arrow.red) + 25)
          << "finger " << contact.finger << " slips " << slips;
    }
    EXPECT_EQ(arrows, 2);
  }
}

TEST(Pictures, ABlindTrialShowsNeitherObjectNorFingersNorForces) {
  const auto surface = devices::openOffscreen(kSmall);
  Stage stage = pinchStage();
  Painter painter(*surface, stage.model, stage.snapshot);
  stage.snapshot.trial.blind = true;
  EXPECT_EQ(painter.scene().compose(stage.snapshot, {}).size(), 1u);  // the dish
  EXPECT_TRUE(painter.scene().labels(stage.snapshot, {}).empty());
  painter.draw(stage.snapshot, {});
  const Image blind = painter.picture();
  for (std::size_t i = 0; i < blind.bytes.size(); i += 3)
    ASSERT_LT(blind.bytes[i], blind.bytes[i + 2] + 40) << "something orange or skin-coloured";
}

TEST(Pictures, OverlayShowsPadsChartsTrialAndHelp) {
  const auto surface = devices::openOffscreen({1280, 720});
  Stage stage = pinchStage();
  SnapshotChannel channel(stage.snapshot);
  PaceControl pace;
  Viewer viewer(*surface, stage.model, stage.snapshot, channel, pace, nullptr, {"sphere-pickup"});
  for (int i = 0; i < 200; ++i) {
    Snapshot& s = channel.writable() = stage.snapshot;
    s.tick = i;
    s.time = 0.02 * i;
    s.tick_seconds = 1e-6 * (2 + (i % 10) / 20.0);
    s.X_WB[1].p.z() += 2.5e-4 * std::max(i - 50, 0);
    for (FingerSnapshot& finger : s.fingers) {
      finger.q_WF = Quat::Identity();
      finger.normal_force *= std::min(1.0, i / 60.0);
      finger.has_device = finger.has_display = finger.armed = true;
      finger.device = devices::DeviceState::kReady;
      finger.tactor_wanted_L = Vec2(0.004, -0.003);
      finger.tactor_L = Vec2(0.002, -0.001);
    }
    s.trial.instruction = "Lift the sphere by 50 mm and hold it";
    s.trial.stage = "run";
    s.trial.condition = "cld+force";
    s.trial.trial = 3;
    s.trial.trials = 40;
    channel.publish();
    if (i + 1 < 200) viewer.look();
  }
  viewer.update();
  viewer.update();  // panels that fit their text need a frame to know how large they are
  expectPicture(viewer.picture(), "overlay");
  viewer.choice().help = true;
  viewer.update();
  viewer.update();
  expectPicture(viewer.picture(), "help");
}

// The smooth surface of a coarse ball is round where its facets are not: along
// its outline it covers more of the picture.
TEST(Pictures, SmoothSurfaceIsRounderThanTheFacets) {
  const auto surface = devices::openOffscreen(kSmall);
  engine::WorldBuilder builder{engine::WorldOptions{}};
  // its edges turn by 41.8 degrees
  const auto mesh = contact::SmoothMesh::build(contact::icosphere(0.02, 0), {.crease_angle = 1, .progress = {}});
  builder.addBody({.name = "icosahedron", .shape = contact::Mesh{mesh}, .mass = 0.1, .material = {}});
  Stage stage(grasp::buildGrasp(std::move(builder), {}), {{}}, {});
  stage.press({}, {}, 0);
  stage.snapshot.X_WB[0] = Pose();
  Painter painter(*surface, stage.model, stage.snapshot);
  std::array<int, 2> covered{};
  for (const bool facets : {false, true}) {
    ViewChoice choice;
    choice.facets = facets;
    choice.edges = false;
    painter.draw(stage.snapshot, choice);
    const Image image = painter.picture();
    for (std::size_t i = 0; i < image.bytes.size(); i += 3) covered[facets] += image.bytes[i] > image.bytes[i + 2] + 40;
    expectPicture(image, facets ? "facets" : "smooth");
  }
  // Projected area of an icosahedron over its circumscribed disc's: its mean is
  // surface / 4 = 0.762 (Cauchy); a sphere's is 1.
  EXPECT_NEAR(static_cast<double>(covered[1]) / covered[0], 0.78, 0.05);
}

TEST(Pictures, APngComesBackAsItWas) {
  const std::string path = PINCER_BINARY_DIR "/round_trip.png";
  Image image{3, 2, {}};
  for (std::uint8_t i = 0; i < 18; ++i) image.bytes.push_back(static_cast<std::uint8_t>(13 * i));
  writePng(image, path);
  EXPECT_EQ(readPng(path), image);
  EXPECT_THROW(readPng(PINCER_SOURCE_DIR "/README.md"), InputError);
  EXPECT_THROW(writePng(image, "/no/such/folder/x.png"), InputError);
}

}  // namespace
}  // namespace pincer::tasks
