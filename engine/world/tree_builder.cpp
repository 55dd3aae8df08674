#include "pincer/engine/world/tree_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/tree/loop_closure.h"
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

// Joints in their order: those that make a tree, and those that close loops in it.
struct SpanningJoints {
  std::vector<int> of_tree, of_loops;
};

// Which joints make the tree: first those that have more than a kind, then welds, pivots and sliders, then balls.
class SpanningTree {
 public:
  SpanningTree(const WorldModel& model, const std::vector<CouplingModel>& couplings)
      : model_(model), must_(model.joints.size(), false) {
    for (std::size_t j = 0; j < must_.size(); ++j) must_[j] = !isPlain(model.joints[j]) || model.joints[j].damping > 0;
    for (const DriveModel& drive : model.drives) {
      for (const DriveTerm& term : drive.terms) must_[term.joint] = true;
    }
    for (const CouplingModel& coupling : couplings) {
      for (const int joint : {coupling.joint, coupling.follows}) must_[model.joint_places[joint].joint] = true;
    }
  }

  // True if joints that are nothing but joints can close all loops.
  bool canClose(const SpanningJoints& joints) const {
    return std::none_of(joints.of_loops.begin(), joints.of_loops.end(), [&](int j) { return must_[j]; });
  }

  SpanningJoints of(const std::vector<int>& joints) {
    root_.resize(model_.bodies.size() + 1);
    std::iota(root_.begin(), root_.end(), 0);
    std::vector<int> order = joints;
    std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return rankOf(x) < rankOf(y); });
    SpanningJoints sorted;
    for (const int j : order) (joins(j) ? sorted.of_tree : sorted.of_loops).push_back(j);
    std::sort(sorted.of_tree.begin(), sorted.of_tree.end());
    std::sort(sorted.of_loops.begin(), sorted.of_loops.end());
    return sorted;
  }

 private:
  int rankOf(int joint) const {
    const JointKind kind = model_.joints[joint].kind;
    return must_[joint] ? 0 : kind == JointKind::kWeld ? 1 : kind == JointKind::kBall ? 3 : 2;
  }
  // All that stands still or is driven is one.
  int rootOf(int body) const {
    std::size_t at = body < 0 || !model_.bodies[body].dynamic ? model_.bodies.size() : static_cast<std::size_t>(body);
    while (root_[at] != static_cast<int>(at)) at = static_cast<std::size_t>(root_[at]);
    return static_cast<int>(at);
  }
  bool joins(int joint) {
    const int a = rootOf(model_.joints[joint].a), b = rootOf(model_.joints[joint].b);
    root_[static_cast<std::size_t>(a)] = b;
    return a != b;
  }
  const WorldModel& model_;
  std::vector<bool> must_;  // by joints of the model
  std::vector<int> root_;   // by bodies; the last one stands for all that no joint moves
};

// Makes one tree of the joints of some groups, and of those of them that close loops.
class TreeMaker {
 public:
  TreeMaker(WorldModel& model, const SpanningJoints& joints)
      : model_(model),
        joints_(joints.of_tree),
        loops_(joints.of_loops),
        number_(static_cast<int>(model.trees.size())),
        coordinate_(model.joints.size(), -1) {}

  TreeModel make() {
    for (const int j : joints_) {
      const JointModel& joint = model_.joints[j];
      if (joint.b < 0 || !model_.bodies[joint.b].dynamic) grow(j, joint.a, -1);
    }
    checkAllHang();
    for (const int j : loops_) addLoop(j);
    return std::move(tree_);
  }
  // The coordinate of a joint, -1 of balls and welds.
  int coordinateOf(int joint) const { return coordinate_[joint]; }

 private:
  // Adds the link that joint j holds to `parent`, and all that hangs on it.
  void grow(int j, int body, int parent) {
    const JointModel& joint = model_.joints[j];
    if (parent < 0) takeBase(joint);
    const int link = static_cast<int>(tree_.links.size());
    model_.bodies[body].tree = number_;
    model_.bodies[body].link = link;
    model_.bodies[body].joint_group = -1;
    addLink(j, body, parent);
    for (const int k : joints_) {
      const JointModel& next = model_.joints[k];
      if (k == j || (next.a != body && next.b != body)) continue;
      const int other = next.a == body ? next.b : next.a;
      if (other >= 0 && model_.bodies[other].dynamic) grow(k, other, link);
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
      throw InputError(
          fmt::format("\"{}\" and \"{}\": a drive or a coupling ties them together, but they hang on different bodies. "
                      "Hold both to the same one.",
                      model_.bodies[tree_.links[0].body].name, model_.bodies[joint.a].name));
    tree_.base = joint.b;
  }

  void addLoop(int j) {
    const JointModel& joint = model_.joints[j];
    const bool is_held = joint.b < 0 || !model_.bodies[joint.b].dynamic;
    if (is_held && joint.b != tree_.base)
      throw InputError(fmt::format(
          "body \"{}\": its joints close a loop over two bodies that don't hang together. Hold all of the loop to the "
          "same one.",
          model_.bodies[joint.a].name));
    tree_.loops.push_back({j, joint.kind, model_.bodies[joint.a].link, is_held ? -1 : model_.bodies[joint.b].link,
                           joint.X_AJ, joint.X_BJ});
  }

  void checkAllHang() const {
    for (const int j : joints_) {
      for (const int body : {model_.joints[j].a, model_.joints[j].b}) {
        if (body < 0 || !model_.bodies[body].dynamic || model_.bodies[body].tree >= 0) continue;
        throw InputError(
            fmt::format("body \"{}\": nothing holds it and what it is joined with to the world. Limits, springs, "
                        "drives and dry friction, "
                        "and more than {} "
                        "freedoms, need a tree that hangs on the world, on a static or on a driven body: add a joint.",
                        model_.bodies[body].name, kMoverFreedoms));
      }
    }
  }

  WorldModel& model_;
  const std::vector<int>&joints_, &loops_;
  int number_;
  std::vector<int> coordinate_;  // per joint of the model
  TreeModel tree_;
};

int placeOf(const WorldModel& model, int joint) { return model.joint_places[joint].joint; }

// True if the group hangs on something, and all of it on the same.
bool hangs(const WorldModel& model, const JointGroup& group) {
  std::optional<int> base;
  for (int j = group.first; j < group.first + group.count; ++j) {
    const int b = model.joints[j].b;
    if (b >= 0 && model.bodies[b].dynamic) continue;
    if (base && *base != b) return false;
    base = b;
  }
  return base.has_value();
}

std::vector<int> jointsOf(const JointGroup& group) {
  std::vector<int> joints(static_cast<std::size_t>(group.count));
  std::iota(joints.begin(), joints.end(), group.first);
  return joints;
}

// A linkage of pivots and sliders: its free course is of 4th order as a tree, of second by elimination (joints.h).
bool isBetterAsTree(const WorldModel& model, const JointGroup& group, SpanningTree& spanning) {
  const auto first = model.joints.begin() + group.first;
  const bool is_linkage =
      group.count > 1 && hangs(model, group) && std::all_of(first, first + group.count, [](const JointModel& joint) {
        return joint.kind == JointKind::kPivot || joint.kind == JointKind::kSlider;
      });
  return is_linkage && spanning.canClose(spanning.of(jointsOf(group)));
}

// Per group, whether it becomes a tree; ties what drives and couplings bind.
std::vector<bool> whichBecomeTrees(const WorldModel& model, const std::vector<CouplingModel>& couplings,
                                   SpanningTree& spanning, Ties& ties) {
  std::vector<bool> become(model.joint_groups.size(), false);
  for (std::size_t g = 0; g < become.size(); ++g) {
    const JointGroup& group = model.joint_groups[g];
    const auto first = model.joints.begin() + group.first;
    const bool is_large =
        freedomsOf(model, group) > kMoverFreedoms || 6 * std::ssize(group.bodies) > kMostGroupFreedoms;
    become[g] = !std::all_of(first, first + group.count, isPlain) || (is_large && hangs(model, group)) ||
                isBetterAsTree(model, group, spanning);
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

void addCouplings(const WorldModel& model, const std::vector<CouplingModel>& couplings, const TreeMaker& maker,
                  TreeModel& tree) {
  for (const CouplingModel& coupling : couplings) {
    const int follower = maker.coordinateOf(placeOf(model, coupling.joint)),
              leader = maker.coordinateOf(placeOf(model, coupling.follows));
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

// Where the joints start.
std::vector<double> jointsAtStart(const TreeModel& tree) {
  std::vector<double> q(static_cast<std::size_t>(tree.q_count), 0.0);
  for (const TreeCoordinate& own : tree.coordinates) {
    if (own.q >= 0) q[own.q] = own.traits.start;
  }
  for (const TreeLink& link : tree.links) {
    if (link.kind == JointKind::kBall) q[link.first_q] = 1;
  }
  return q;
}

void makeTree(const std::vector<int>& joints, const std::vector<CouplingModel>& couplings, SpanningTree& spanning,
              WorldModel& model) {
  const SpanningJoints sorted = spanning.of(joints);
  if (!spanning.canClose(sorted))
    throw InputError(
        fmt::format("body \"{}\": its joints close a loop, and each of them has limits, a spring, a drive, damping or "
                    "friction. A joint that "
                    "closes a loop has none: leave one of the loop's without.",
                    model.bodies[model.joints[sorted.of_loops.front()].a].name));
  TreeMaker maker(model, sorted);
  TreeModel tree = maker.make();
  addCouplings(model, couplings, maker, tree);
  addDrives(model, maker, tree);
  finishTree(tree);
  if (!tree.loops.empty()) {
    std::vector<double> q = jointsAtStart(tree);
    tree.blocked = blockedNear(tree, q);
    finishTree(tree);
  }
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
  SpanningTree spanning(model, couplings);
  const std::vector<bool> become = whichBecomeTrees(model, couplings, spanning, ties);
  const int count = static_cast<int>(become.size());
  std::vector<int> root(become.size());
  for (int g = 0; g < count; ++g) root[g] = ties.rootOf(g);
  for (int g = 0; g < count; ++g) {
    if (!become[g] || root[g] != g) continue;
    std::vector<int> joints;
    for (int k = g; k < count; ++k) {
      for (int j = 0; root[k] == g && j < model.joint_groups[k].count; ++j)
        joints.push_back(model.joint_groups[k].first + j);
    }
    makeTree(joints, couplings, spanning, model);
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
