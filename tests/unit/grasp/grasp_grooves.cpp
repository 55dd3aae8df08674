// A finger that touches one body at several places: grooves and corners of a mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "contact/mesh/generated_meshes.h"
#include "contact/surface/smooth_mesh.h"
#include "grasp/step.h"
#include "tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr double kStiffness = 1000;  // [N/m]
constexpr double kStep = 1e-6;       // the device moves this far per tick [m]: 1 mm/s

// A fixed mesh without friction and one finger with a massless tip on a spring, at rest at `start`.
struct Pressed {
  Pressed(const contact::TriangleMesh& mesh, const Vec3& start) : device(start) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"block", contact::Mesh{contact::SmoothMesh::build(mesh)}, false, 0, {0, 0, 0, 0}});
    model = buildGrasp(builder, {testing::softFinger("finger", kStiffness, 0)});
    state = makeState(model, {testing::startAt(Vec3::Zero())}, {start});
    scratch = std::make_unique<GraspScratch>(model);
  }
  const FingerReport& moveTo(const Vec3& p_WF) {
    FingerInput input;
    input.v_WF = (p_WF - device) / model.world.options.h;
    input.p_WF = device = p_WF;
    step(model, state, *scratch, std::span(&input, 1));
    return scratch->fingers[0];
  }
  int activeContacts() const {
    int n = 0;
    for (const engine::Contact& c : scratch->world.contacts) n += c.active();
    return n;
  }

  GraspModel model;
  GraspState state;
  std::unique_ptr<GraspScratch> scratch;
  Vec3 device;
};

// What may change in a tick in which the device moves by kStep.
struct Steadiness {
  double place = 0, force = 0;  // largest change of the place on the pad [m] and of the force [N]
  int fewest = 99, most = 0;    // contacts that push

  void see(const FingerReport& now, int contacts) {
    if (seen_) {
      place = std::max(place, (now.place_L - place_).norm());
      force = std::max(force, (now.f_contact_W - force_).norm());
    }
    place_ = now.place_L;
    force_ = now.f_contact_W;
    seen_ = true;
    fewest = std::min(fewest, contacts);
    most = std::max(most, contacts);
  }

 private:
  bool seen_ = false;
  Vec2 place_ = Vec2::Zero();
  Vec3 force_ = Vec3::Zero();
};

// Without friction the force is the spring's, so the place turns by d x / depth for a device that moves across by d x: with the device about
// 4 mm below where the finger rests, 8 mm / 4 mm = 2 um per um. On one wall alone it stands still, and where the second comes or goes it
// carries nothing. A single contact would jump by a quarter of the finger's circumference, 12.6 mm.
TEST(GraspGrooves, AcrossAGrooveForceAndPlaceAreContinuous) {
  const double r = 0.008, rest = r * std::sqrt(2.0), depth = 0.004;
  Pressed finger(contact::grooveBlock(M_PI / 4, 0.02, 0.04, 0.04), Vec3(-0.006, 0.001, rest + 0.006));
  for (int i = 0; i < 1000; ++i) finger.moveTo(Vec3(-0.006, 0.001, rest + 0.006 - (0.006 + depth) * i / 999));
  Steadiness felt;
  const int ticks = static_cast<int>(0.012 / kStep);
  for (int i = 0; i < ticks; ++i) felt.see(finger.moveTo(Vec3(-0.006 + kStep * i, 0.001, rest - depth)), finger.activeContacts());
  EXPECT_EQ(felt.fewest, 1);
  EXPECT_EQ(felt.most, 2);
  EXPECT_LT(felt.place, 2.5 * kStep);
  EXPECT_LT(felt.force, 1.1 * kStiffness * kStep);
}

TEST(GraspGrooves, IntoACornerForceAndPlaceAreContinuous) {
  contact::TriangleMesh room = contact::gridBox({0.02, 0.02, 0.02}, 4);
  for (auto& t : room.triangles) std::swap(t[1], t[2]);
  Pressed finger(room, Vec3::Zero());
  for (int i = 0; i < 1000; ++i) finger.moveTo(1.5e-5 * i * Vec3(1, 0, 0));
  Steadiness felt;
  const auto path = [](int i) -> Vec3 {
    const double s = std::min(1.0, 1e-4 * i);  // first along the wall into the corner, then around in it
    return Vec3(0.015, 0.015 * s, 0.0155 * s) + 1e-3 * Vec3(std::sin(1e-3 * i) * s, std::cos(8e-4 * i) * s, 0);
  };
  for (int i = 0; i < 15000; ++i) felt.see(finger.moveTo(path(i)), finger.activeContacts());
  EXPECT_EQ(felt.most, 3);
  EXPECT_LT(felt.place, 8e-3 / 2e-3 * 3.5e-6) << "the device moves by up to 3.5 um per tick, at least 2 mm beyond the walls";
  EXPECT_LT(felt.force, 1.1 * kStiffness * 3.5e-6);
}

}  // namespace
}  // namespace pincer::grasp
