// M and C of robots from files, where PINCER_ROBOT_DYNAMICS names those that MuJoCo has in
// random poses (tests/robots/dynamics.mjs).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "pincer/engine/tree/sparse_ldl.h"
#include "pincer/engine/tree/tree_bias.h"
#include "pincer/engine/tree/tree_inertia.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using engine::TreeModel;

// A pose as MuJoCo has it: joint by joint.
struct MujocoPose {
  std::map<std::string, std::size_t> joints;
  const JsonValue& json;

  double at(const char* key, const std::string& joint) const { return json.at(key).array()[joints.at(joint)].number(); }
  double M(const std::string& a, const std::string& b) const {
    return json.at("M").array()[joints.at(a)].array()[joints.at(b)].number();
  }
};

// One tree of the world that the robot becomes, in that pose.
class TreeInPose {
 public:
  TreeInPose(const engine::WorldModel& world, const TreeModel& tree, const engine::TreeBase& base,
             const MujocoPose& pose)
      : world_(world),
        tree_(tree),
        pose_(pose),
        place_(tree),
        entries_(static_cast<std::size_t>(tree.entries)),
        C_(tree.before.size()) {
    std::vector<double> q(static_cast<std::size_t>(tree.q_count)), v(tree.coordinates.size()), u(tree.before.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
      q[static_cast<std::size_t>(tree.coordinates[i].q)] = pose.at("q", nameOf(i));
      v[i] = pose.at("v", nameOf(i));
    }
    placeLinks(tree, base, q, place_);
    ratesOfColumns(tree, v, u);
    moveLinks(tree, base, q, u, place_);
    std::vector<engine::CompositeInertia> composite(tree.links.size());
    fillInertia(tree, place_, composite, entries_);
    std::vector<engine::LinkBias> biases(tree.links.size());
    fillBias(tree, place_, base, world.options.gravity_W, {}, u, biases, C_);
  }

  // The largest difference of M over the roots of both diagonals.
  double worstOfM() const {
    double worst = 0;
    for (int a = 0; a < tree_.columnCount(); ++a) {
      for (int b = a; b >= 0; b = tree_.before[static_cast<std::size_t>(b)]) {
        const double scale = std::sqrt(theirM(a, a) * theirM(b, b));
        worst = std::max(worst, std::abs(entries_[entryOf(tree_, a, b)] - theirM(a, b)) / scale);
      }
    }
    return worst;
  }
  double worstOfC() const {
    double worst = 0;
    for (int c = 0; c < tree_.columnCount(); ++c)
      worst = std::max(worst, std::abs(C_[static_cast<std::size_t>(c)] - theirC(c)));
    return worst;
  }
  double largestC() const {
    double most = 0;
    for (int c = 0; c < tree_.columnCount(); ++c) most = std::max(most, std::abs(theirC(c)));
    return most;
  }

 private:
  const std::string& nameOf(std::size_t i) const {
    return world_.joints[static_cast<std::size_t>(tree_.coordinates[i].joint)].name;
  }
  // Theirs, of the coordinates that follow a column.
  template <class F>
  double overColumn(int column, F f) const {
    double sum = 0;
    for (std::size_t i = 0; i < tree_.coordinates.size(); ++i) {
      if (tree_.coordinates[i].column == column) sum += place_.coordinates[i].share * f(nameOf(i));
    }
    return sum;
  }
  double theirM(int a, int b) const {
    return overColumn(
        a, [&](const std::string& x) { return overColumn(b, [&](const std::string& y) { return pose_.M(x, y); }); });
  }
  double theirC(int c) const {
    return overColumn(c, [&](const std::string& x) { return pose_.at("C", x); });
  }

  const engine::WorldModel& world_;
  const TreeModel& tree_;
  const MujocoPose& pose_;
  engine::TreePlace place_;
  std::vector<double> entries_, C_;
};

int countOf(const std::string& word, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(RobotDynamics, MassesAndForcesOfMotionAreMujocos) {
  const char* path = std::getenv("PINCER_ROBOT_DYNAMICS");
  if (!path) GTEST_SKIP() << "tests/run --robots=DIR";
  const JsonValue theirs = readJson(path, kSceneFile);
  RobotImport import = readMjcf(theirs.at("file").text());
  const Scene scene = parseScene(sceneOfRobot(import.robot, {}, import.notes), theirs.at("file").text());
  const grasp::GraspModel model = buildWorld(scene);
  const grasp::GraspState state = startState(scene, model);
  std::map<std::string, std::size_t> joints;
  for (const JsonValue& name : theirs.at("joints").array()) joints.emplace(name.text(), joints.size());
  ASSERT_FALSE(model.world.trees.empty());
  double worst_M = 0, worst_C = 0, largest_C = 0;
  for (const JsonValue& json : theirs.at("poses").array()) {
    const MujocoPose pose{joints, json};
    for (const TreeModel& tree : model.world.trees) {
      engine::TreeBase base;
      if (tree.base >= 0) base.X_WB = state.world.bodies[static_cast<std::size_t>(tree.base)].X_WI;
      const TreeInPose ours(model.world, tree, base, pose);
      worst_M = std::max(worst_M, ours.worstOfM());
      worst_C = std::max(worst_C, ours.worstOfC());
      largest_C = std::max(largest_C, ours.largestC());
    }
  }
  std::printf("%s: M %.1e, C %.1e of %.2g N m\n", theirs.at("file").text().c_str(), worst_M, worst_C / largest_C,
              largest_C);
  // MuJoCo turns the inertias of bodies that it sums up of geoms into principal
  // axes to 1e-7 only (tests/robots/masses.py).
  const std::string text = tests::readFile(theirs.at("file").text());
  const double bound = countOf("<inertial", text) == countOf("<body ", text) ? 1e-9 : 2e-8;
  EXPECT_LE(worst_M, bound);
  EXPECT_LE(worst_C, bound * std::max(largest_C, 1e-6));
}

}  // namespace
}  // namespace pincer::tasks
