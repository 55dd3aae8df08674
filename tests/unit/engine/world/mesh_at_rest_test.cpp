// Meshes dropped on a plane and into a dish come to rest: kinetic energy falls to round-off, and they stop creeping.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/motion/mass.h"
#include "pincer/engine/state.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {
namespace {

constexpr double kMeshMass = 0.075;
constexpr double kSize = 0.07;  // largest dimension [m]

contact::TriangleMesh atHandSize(contact::TriangleMesh mesh) {
  const contact::MeshReport report = contact::inspect(mesh);
  const double scale = kSize / (report.box_max - report.box_min).maxCoeff();
  for (Vec3& v : mesh.vertices) v *= scale;
  const Vec3 p_BBcm = massPropertiesOf(mesh, kMeshMass).p_BBcm;
  for (Vec3& v : mesh.vertices) v -= p_BBcm;
  return mesh;
}

struct Motion1s {
  double largest_energy = 0;  // kinetic [J]
  double moved = 0;           // [m]
  double turned = 0;          // [rad]
  int changes = 0;            // ticks whose contacts weren't the last one's
};

class Drop {
 public:
  Drop(const contact::TriangleMesh& mesh, const contact::Shape& support)
      : model_(world(mesh, support)), scratch_(model_) {
    const contact::MeshReport report = contact::inspect(mesh);
    state_ = makeState(
        model_, {{}, {{Quat::Identity(), Vec3(0, 0, -report.box_min.z() + 0.012)}, Vec3::Zero(), Vec3::Zero()}}, {});
  }

  Motion1s oneSecond() {
    Motion1s motion;
    const Pose start = bodyPose(model_, state_, 1);
    for (int tick = 0; tick < 1000; ++tick) {
      step(model_, state_, scratch_);
      motion.largest_energy = std::max(motion.largest_energy, kineticEnergy(model_, state_));
      motion.changes += contactsChanged();
    }
    const Pose end = bodyPose(model_, state_, 1);
    motion.moved = (end.p - start.p).norm();
    motion.turned = start.q.angularDistance(end.q);
    return motion;
  }

 private:
  static WorldModel world(const contact::TriangleMesh& mesh, const contact::Shape& support) {
    WorldBuilder builder{WorldOptions{}};
    builder.addBody({"support", support, false, 0, {0.5, 0.5, 0, 0}});
    builder.addBody({"object", contact::Mesh{contact::SmoothMesh::build(mesh)}, true, kMeshMass, {0.6, 0.51, 0, 0}});
    return builder.build();
  }

  int contactsChanged() {
    std::vector<std::uint64_t> ids;
    for (const Contact& c : scratch_.contacts) ids.push_back(c.id);
    const bool changed = ids != last_;
    last_ = ids;
    return changed;
  }

  WorldModel model_;
  WorldScratch scratch_;
  WorldState state_;
  std::vector<std::uint64_t> last_;
};

void expectRest(const contact::TriangleMesh& mesh, const std::string& name) {
  const contact::TriangleMesh object = atHandSize(mesh);
  for (const contact::Shape& support : {contact::Shape(contact::HalfSpace{}), contact::Shape(contact::Dish{0.15})}) {
    Drop drop(object, support);
    drop.oneSecond();  // what lands on an edge rocks for less than that
    const Motion1s motion = drop.oneSecond();
    const std::string where =
        name + (std::holds_alternative<contact::HalfSpace>(support) ? " on a plane" : " in a dish");
    // 0.2 um/s: what a solver content with 1e-8 of g h leaves, squared, and to spare
    EXPECT_LE(motion.largest_energy, 1e-15) << where;
    EXPECT_LE(motion.moved, 1e-8) << where;   // [m/s] of creep
    EXPECT_LE(motion.turned, 1e-6) << where;  // [rad/s]
    EXPECT_EQ(motion.changes, 0) << where;
  }
}

TEST(MeshAtRest, GeneratedSolidsStopMoving) {
  expectRest(contact::box({0.035, 0.02, 0.015}), "box");
  expectRest(contact::roundedCube(0.03, 0.004, 3), "rounded cube");
  expectRest(contact::cylinderWithFlat(0.02, 0.02, 0.012, 24, 3), "cylinder with flat");
  expectRest(contact::torus(0.025, 0.01, 24, 12), "torus");
}

// Scanned and CAD models as people have them, where they lie beside the checkout.
TEST(MeshAtRest, RealModelsStopMoving) {
  const std::filesystem::path folder = std::filesystem::path(PINCER_SOURCE_DIR) / "../shared/data/meshes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no meshes beside the checkout";
  for (const char* name : {"spot", "fandisk", "rocker-arm"}) {
    expectRest(contact::readMesh(folder / (std::string(name) + ".obj")), name);
  }
}

}  // namespace
}  // namespace pincer::engine
