#include <gtest/gtest.h>

#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/view/contact_drawing.h"
#include "pincer/tasks/view/sim_view.h"

namespace pincer::tasks {
namespace {

struct MeshSizes final : MeshSink {
  int add(const ViewMesh& mesh) override {
    Eigen::AlignedBox3f box;
    for (const ViewVertex& vertex : mesh.vertices) box.extend(vertex.p);
    sizes.push_back(box.sizes().cast<double>());
    return static_cast<int>(sizes.size()) - 1;
  }
  std::vector<Vec3> sizes;
};

Snapshot afterTicks(const std::string& scene, int ticks) {
  Simulation simulation(readBuiltinScene(scene));
  for (int i = 0; i < ticks; ++i) simulation.tick();
  return snapshotOf(simulation);
}

// Flat jaws touch at several places: each is drawn, their shares are of the jaw's whole force, and the border of the
// patch is closed.
TEST(ContactDrawing, AFlatJawHasSeveralPlacesWhoseSharesAreTheWhole) {
  const Snapshot snapshot = afterTicks("two_jaw_gripper", 1500);
  std::vector<double> shares(snapshot.fingers.size());
  std::vector<int> places(snapshot.fingers.size());
  for (int i = 0; i < snapshot.contact_count; ++i) {
    const ContactSnapshot& contact = snapshot.contacts[static_cast<std::size_t>(i)];
    if (contact.finger < 0) continue;
    shares[static_cast<std::size_t>(contact.finger)] += shareOfFinger(snapshot, contact);
    ++places[static_cast<std::size_t>(contact.finger)];
  }
  ASSERT_FALSE(shares.empty());
  const ContactLook look{.marks = {.ball = 1, .rod = 2, .head = 3, .size = 0.01}, .cone = 4, .metres_per_newton = 1e-3};
  DrawList list;
  ViewChoice only_places;
  only_places.forces = only_places.cones = false;
  addContacts(snapshot, only_places, look, list);
  int balls = 0;
  for (const DrawItem& item : list) balls += item.mesh == look.marks.ball && item.paint.alpha >= 1;
  EXPECT_EQ(balls, snapshot.contact_count);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    EXPECT_GE(places[i], 3);
    EXPECT_NEAR(shares[i], 1, 1e-12);
  }
  // Eight labels covered the gripper: a jaw's force is written once, and one by one of the body that is selected.
  EXPECT_EQ(contactLabels(snapshot, look).size(), shares.size());
  for (const ViewLabel& label : contactLabels(snapshot, look))
    EXPECT_NE(label.text.find(" N, 4 places"), std::string::npos) << label.text;
  const int selected = snapshot.contacts[0].body;
  EXPECT_EQ(contactLabels(snapshot, look, selected).size(), static_cast<std::size_t>(snapshot.contact_count));
  for (const ViewLabel& label : contactLabels(snapshot, look, selected))
    EXPECT_NE(label.text.find(" %"), std::string::npos) << label.text;
}

// The disc on a soft pad has the radius that the contact model computes.
TEST(ContactDrawing, ASoftPadsPatchHasItsRadius) {
  Snapshot snapshot;
  snapshot.X_WB.resize(1);
  snapshot.fingers.resize(1);
  snapshot.fingers[0].patch_radius = 3e-3;
  snapshot.contacts = {{.finger = 0, .body = 0, .n_W = Vec3::UnitZ(), .f_W = Vec3(0, 0, 2)}};
  snapshot.contact_count = 1;
  const ContactLook look{.marks = {.ball = 1, .rod = 2, .head = 3, .size = 0.01}};
  DrawList list;
  addContacts(snapshot, {}, look, list);
  int discs = 0;
  for (const DrawItem& item : list) {
    if (item.paint.alpha < 1 && item.mesh == 1) {
      ++discs;
      EXPECT_NEAR(item.X_WM.col(0).norm(), 3e-3, 1e-9);
    }
  }
  EXPECT_EQ(discs, 1);
  EXPECT_EQ(contactLabels(snapshot, look).at(0).text, "2.00 N");
}

// A jaw is drawn as the pad of 8 x 20 x 20 mm that touches, not as a person's finger.
TEST(SceneDrawing, AJawIsDrawnAsItsOwnGeometry) {
  Simulation simulation(readBuiltinScene("two_jaw_gripper"));
  MeshSizes meshes;
  const Snapshot snapshot = snapshotOf(simulation);
  const SceneDrawing drawing(simulation.model(), snapshot, meshes);
  const int last_body = SceneDrawing::thingOfBody(simulation.model().world.bodies.size() - 1);
  int jaws = 0;
  for (const DrawItem& item : drawing.compose(snapshot, {})) {
    if (item.thing <= last_body) continue;
    ++jaws;
    EXPECT_LT((meshes.sizes[static_cast<std::size_t>(item.mesh)] - Vec3(0.008, 0.02, 0.02)).norm(), 1e-4);
  }
  EXPECT_EQ(jaws, 2);
}

}  // namespace
}  // namespace pincer::tasks
