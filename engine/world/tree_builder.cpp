#include "pincer/engine/world/tree_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/tree/tree_pattern.h"
#include "pincer/engine/world/joint_groups.h"

namespace pincer::engine {
namespace {

bool isPlain(const JointModel& joint) {
  JointTraits traits = joint.traits;
  traits.start = 0;
  return traits == JointTraits{};
}

// Groups of joints, those that drives and couplings tie together as one.
class Ties {
 public:
  explicit Ties(const WorldModel& model) : model_(model), parent_(model.joint_groups.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int groupOf(int joint) const { return model_.bodies[model_.joints[joint].a].joint_group; }
  int rootOf(int group) const {
    while (parent_[group] != group) group = parent_[group];
    return group;
  }
  void tie(int joint, int other) {
    const int x = rootOf(groupOf(joint)), y = rootOf(groupOf(other));
    parent_[std::max(x, y)] = std::min(x, y);
  }

 private:
  const WorldModel& model_;
  std::vector<int> parent_;
};

// Makes one tree of the joints of some groups.
class TreeMaker {
 public:
  TreeMaker(WorldModel& model, const std::vector<int>& joints)
      : model_(model), joints_(joints), number_(static_cast<int>(model.trees.size())), coordinate_(model.joints.size(), -1) {}

  TreeModel make() {
    for (const int j : joints_) {
      const JointModel& joint = model_.joints[j];
      if (joint.b < 0 || !model_.bodies[joint.b].dynamic) grow(j, joint.a, -1);
    }
    checkAllHang();
    return std::move(tree_);
  }
  // The coordinate of a joint, -1 of balls and welds.
  int coordinateOf(int joint) const { return coordinate_[joint]; }

 private:
  // Adds the link that joint j holds to `parent`, and all that hangs on it.
  void grow(int j, int body, int parent) {
    const JointModel& joint = model_.joints[j];
    if (parent < 0) takeBase(joint);
    if (model_.bodies[body].tree >= 0) throwLoop(body);
    const int link = static_cast<int>(tree_.links.size());
    model_.bodies[body].tree = number_;
    model_.bodies[body].link = link;
    model_.bodies[body].joint_group = -1;
    addLink(j, body, parent);
    for (const int k : joints_) {
      const JointModel& next = model_.joints[k];
      if (k == j || (next.a != body && next.b != body)) continue;
      const int other = next.a == body ? next.b : next.a;
      if (other < 0 || !model_.bodies[other].dynamic) {
        if (next.a == body) throwLoop(body);  // held twice
        continue;
      }
      grow(k, other, link);
    }
  }

  void addLink(int j, int body, int parent) {
    const JointModel& joint = model_.joints[j];
    const bool is_a = joint.a == body;
    TreeLink link;
    link.body = body;
    link.parent = parent;
    link.kind = joint.kind;
    link.reversed = !is_a;
    link.first_q = tree_.q_count;
    link.first_v = tree_.coordinateCount();
    link.X_PJ = is_a ? joint.X_BJ : joint.X_AJ;
    link.X_LJ = is_a ? joint.X_AJ : joint.X_BJ;
    link.mass = model_.bodies[body].mass;
    link.moments = model_.bodies[body].moments;
    for (int k = 0; k < coordinatesOf(joint.kind); ++k) addCoordinate(j);
    tree_.q_count += joint.kind == JointKind::kBall ? 4 : coordinatesOf(joint.kind);
    tree_.links.push_back(link);
  }

  void addCoordinate(int j) {
    const JointModel& joint = model_.joints[j];
    TreeCoordinate coordinate;
    coordinate.link = static_cast<int>(tree_.links.size());
    coordinate.joint = j;
    coordinate.q = joint.kind == JointKind::kBall ? -1 : tree_.q_count;
    coordinate.damping = joint.damping;
    coordinate.traits = joint.traits;
    if (joint.kind != JointKind::kBall) coordinate_[j] = tree_.coordinateCount();
    tree_.coordinates.push_back(coordinate);
  }

  void takeBase(const JointModel& joint) {
    if (!tree_.links.empty() && tree_.base != joint.b)
      throw InputError(fmt::format(
          "\"{}\" and \"{}\": a drive or a coupling ties them together, but they hang on different bodies. Hold both to the same one.",
          model_.bodies[tree_.links[0].body].name, model_.bodies[joint.a].name));
    tree_.base = joint.b;
  }

  [[noreturn]] void throwLoop(int body) const {
    throw InputError(
        fmt::format("body \"{}\": its joints close a loop, or hold it twice. Limits, springs, drives and dry friction act in trees only: "
                    "take one of the "
                    "joints away.",
                    model_.bodies[body].name));
  }

  void checkAllHang() const {
    for (const int j : joints_) {
      for (const int body : {model_.joints[j].a, model_.joints[j].b}) {
        if (body < 0 || !model_.bodies[body].dynamic || model_.bodies[body].tree >= 0) continue;
        throw InputError(
            fmt::format("body \"{}\": nothing holds it and what it is joined with to the world. Limits, springs, drives and dry friction, "
                        "and more than {} "
                        "freedoms, need a tree that hangs on the world, on a static or on a driven body: add a joint.",
                        model_.bodies[body].name, kMoverFreedoms));
      }
    }
  }

  WorldModel& model_;
  const std::vector<int>& joints_;
  int number_;
  std::vector<int> coordinate_;  // per joint of the model
  TreeModel tree_;
};

int placeOf(const WorldModel& model, int joint) { return model.joint_places[joint].joint; }

// True if the group is a tree that hangs on something: as many joints as bodies, one of them to what holds it.
bool hangs(const WorldModel& model, const JointGroup& group) {
  const auto holds = [&](const JointModel& joint) { return joint.b < 0 || !model.bodies[joint.b].dynamic; };
  const auto first = model.joints.begin() + group.first;
  return group.count == static_cast<int>(group.bodies.size()) && std::count_if(first, first + group.count, holds) == 1;
}

// A chain or tree of pivots and sliders: its free course is of 4th order as a tree, of second by elimination (joints.h).
bool isBetterAsTree(const WorldModel& model, const JointGroup& group) {
  const auto first = model.joints.begin() + group.first;
  return group.count > 1 && hangs(model, group) && std::all_of(first, first + group.count, [](const JointModel& joint) {
           return joint.kind == JointKind::kPivot || joint.kind == JointKind::kSlider;
         });
}

// Per group, whether it becomes a tree; ties what drives and couplings bind.
std::vector<bool> whichBecomeTrees(const WorldModel& model, const std::vector<CouplingModel>& couplings, Ties& ties) {
  std::vector<bool> become(model.joint_groups.size(), false);
  for (std::size_t g = 0; g < become.size(); ++g) {
    const JointGroup& group = model.joint_groups[g];
    const auto first = model.joints.begin() + group.first;
    const bool is_large = freedomsOf(model, group) > kMoverFreedoms || 6 * std::ssize(group.bodies) > kMostGroupFreedoms;
    become[g] = !std::all_of(first, first + group.count, isPlain) || (is_large && hangs(model, group)) || isBetterAsTree(model, group);
  }
  for (const DriveModel& drive : model.drives) {
    for (const DriveTerm& term : drive.terms) {
      become[ties.groupOf(term.joint)] = true;
      ties.tie(drive.terms.front().joint, term.joint);
    }
  }
  for (const CouplingModel& coupling : couplings) {
    const int follower = placeOf(model, coupling.joint), leader = placeOf(model, coupling.follows);
    become[ties.groupOf(follower)] = become[ties.groupOf(leader)] = true;
    ties.tie(follower, leader);
  }
  return become;
}

void addCouplings(const WorldModel& model, const std::vector<CouplingModel>& couplings, const TreeMaker& maker, TreeModel& tree) {
  for (const CouplingModel& coupling : couplings) {
    const int follower = maker.coordinateOf(placeOf(model, coupling.joint)), leader = maker.coordinateOf(placeOf(model, coupling.follows));
    if (follower < 0 || leader < 0) continue;
    tree.coordinates[follower].leader = leader;
    tree.coordinates[follower].polynomial = coupling.polynomial;
    tree.has_couplings = true;
  }
}

void addDrives(const WorldModel& model, const TreeMaker& maker, TreeModel& tree) {
  for (int d = 0; d < static_cast<int>(model.drives.size()); ++d) {
    TreeDrive drive{d, {}};
    for (const DriveTerm& term : model.drives[d].terms) {
      if (maker.coordinateOf(term.joint) >= 0) drive.terms.push_back({maker.coordinateOf(term.joint), term.factor});
    }
    if (!drive.terms.empty()) tree.drives.push_back(std::move(drive));
  }
}

// Notes the tree's place in the world's arrays, and that of its joints in it.
void place(const TreeMaker& maker, TreeModel& tree, WorldModel& model) {
  tree.first_q = model.tree_q_count;
  tree.first_v = model.tree_v_count;
  tree.first_coordinate = model.tree_coordinate_count;
  tree.first_block = model.tree_block_count;
  model.tree_q_count += tree.q_count;
  model.tree_v_count += tree.columnCount();
  model.tree_coordinate_count += tree.coordinateCount();
  model.tree_block_count += static_cast<int>(tree.blocks.size());
  for (JointPlace& joint : model.joint_places) {
    if (maker.coordinateOf(joint.joint) < 0) continue;
    joint.tree = static_cast<int>(model.trees.size());
    joint.coordinate = maker.coordinateOf(joint.joint);
  }
}

void makeTree(const std::vector<int>& joints, const std::vector<CouplingModel>& couplings, WorldModel& model) {
  TreeMaker maker(model, joints);
  TreeModel tree = maker.make();
  addCouplings(model, couplings, maker, tree);
  addDrives(model, maker, tree);
  finishTree(tree);
  place(maker, tree, model);
  model.trees.push_back(std::move(tree));
}

void dropGroups(const std::vector<bool>& dropped, WorldModel& model) {
  std::vector<JointGroup> kept;
  for (std::size_t g = 0; g < dropped.size(); ++g) {
    if (dropped[g]) continue;
    for (const int body : model.joint_groups[g].bodies) model.bodies[body].joint_group = static_cast<int>(kept.size());
    kept.push_back(std::move(model.joint_groups[g]));
  }
  model.joint_groups = std::move(kept);
}

}  // namespace

void findTrees(const std::vector<CouplingModel>& couplings, WorldModel& model) {
  Ties ties(model);
  const std::vector<bool> become = whichBecomeTrees(model, couplings, ties);
  const int count = static_cast<int>(become.size());
  std::vector<int> root(become.size());
  for (int g = 0; g < count; ++g) root[g] = ties.rootOf(g);
  for (int g = 0; g < count; ++g) {
    if (!become[g] || root[g] != g) continue;
    std::vector<int> joints;
    for (int k = g; k < count; ++k) {
      for (int j = 0; root[k] == g && j < model.joint_groups[k].count; ++j) joints.push_back(model.joint_groups[k].first + j);
    }
    makeTree(joints, couplings, model);
  }
  dropGroups(become, model);
}

void findTouchedTrees(WorldModel& model) {
  for (TreeModel& tree : model.trees) tree.may_touch = !model.points.empty() || model.has_broad_phase;
  for (const PairModel& pair : model.pairs) {
    for (const int body : {pair.a, pair.b}) {
      if (model.bodies[body].tree >= 0) model.trees[model.bodies[body].tree].may_touch = true;
    }
  }
}

}  // namespace pincer::engine
