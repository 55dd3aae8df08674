#include "pincer/tests/support/random_tree.h"

#include "pincer/engine/tree/tree_pattern.h"

namespace pincer::tests {
namespace {

using engine::JointKind;
using engine::TreeModel;

// Distributions of the standard library differ from one to the other; these don't.
class Dice {
 public:
  explicit Dice(std::mt19937_64& random) : random_(random) {}
  double between(double least, double most) {
    return least + (most - least) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  Vec3 vector(double most) { return {between(-most, most), between(-most, most), between(-most, most)}; }
  Pose pose(double reach) { return {quatFromRotationVector(vector(3)), vector(reach)}; }

 private:
  std::mt19937_64& random_;
};

void addLink(Dice& dice, const RandomTreeOptions& options, TreeModel& tree) {
  engine::TreeLink link;
  const int number = static_cast<int>(tree.links.size());
  link.parent = dice.below(number + 1) - 1;
  const int kind = dice.below(options.balls ? 8 : 7);
  link.kind = kind < 4   ? JointKind::kPivot
              : kind < 6 ? JointKind::kSlider
              : kind < 7 ? JointKind::kWeld
                         : JointKind::kBall;
  if (number == 0) link.kind = JointKind::kPivot;
  link.reversed = dice.below(2) == 1;
  link.X_PJ = dice.pose(0.2);
  link.X_LJ = dice.pose(0.2);
  link.mass = math::exp(dice.between(0, math::log(options.mass_ratio))) * 1e-3;
  // Of a solid box, so that the moments can be those of a body.
  const Vec3 sides = (Vec3::Constant(0.11) + dice.vector(0.09)).cwiseAbs2() / 12;
  link.moments = link.mass * Vec3(sides.y() + sides.z(), sides.x() + sides.z(), sides.x() + sides.y());
  link.first_q = tree.q_count;
  link.first_v = tree.coordinateCount();
  tree.q_count += link.kind == JointKind::kBall ? 4 : coordinatesOf(link.kind);
  for (int k = 0; k < coordinatesOf(link.kind); ++k) {
    engine::TreeCoordinate coordinate;
    coordinate.link = number;
    coordinate.q = link.kind == JointKind::kBall ? -1 : link.first_q;
    if (dice.below(3) == 0) coordinate.traits.armature = link.kind == JointKind::kSlider ? 0.1 : 1e-3;
    tree.coordinates.push_back(coordinate);
  }
  tree.links.push_back(link);
}

void addCoupling(Dice& dice, TreeModel& tree) {
  const int n = tree.coordinateCount(), follower = dice.below(n), leader = dice.below(n);
  engine::TreeCoordinate& a = tree.coordinates[static_cast<std::size_t>(follower)];
  const engine::TreeCoordinate& b = tree.coordinates[static_cast<std::size_t>(leader)];
  if (follower == leader || a.q < 0 || b.q < 0 || b.leader >= 0) return;
  for (const engine::TreeCoordinate& other : tree.coordinates) {
    if (other.leader == follower) return;
  }
  a.leader = leader;
  // Monotone over a turn and more: where a polynomial turns back, what follows has no inertia for a moment.
  const double slope = dice.between(0.5, 2) * (dice.below(2) == 1 ? 1 : -1);
  a.polynomial = {dice.between(-1, 1), slope, dice.between(-0.05, 0.05), dice.between(-0.01, 0.01),
                  dice.between(-1e-3, 1e-3)};
  tree.has_couplings = true;
}

void addDrive(Dice& dice, TreeModel& tree) {
  engine::TreeDrive drive;
  for (int k = 0; k < 3; ++k) {
    const int i = dice.below(tree.coordinateCount());
    if (tree.coordinates[static_cast<std::size_t>(i)].q >= 0) drive.terms.push_back({i, dice.between(-1, 1)});
  }
  if (!drive.terms.empty()) tree.drives.push_back(drive);
}

}  // namespace

RandomTree randomTree(std::mt19937_64& random, const RandomTreeOptions& options) {
  Dice dice(random);
  RandomTree out;
  const int links = 1 + dice.below(options.most_links);
  for (int l = 0; l < links; ++l) addLink(dice, options, out.tree);
  for (int k = 0; options.couplings && k < dice.below(3); ++k) addCoupling(dice, out.tree);
  for (int k = 0; options.drives && k < dice.below(3); ++k) addDrive(dice, out.tree);
  finishTree(out.tree);
  if (options.driven_base)
    out.base = {dice.pose(0.3), {dice.vector(1), dice.vector(2)}, dice.vector(5), dice.vector(5)};
  out.q.assign(static_cast<std::size_t>(out.tree.q_count), 0);
  std::vector<double> step(out.tree.before.size());
  for (double& s : step) s = dice.between(-1, 1);
  for (const engine::TreeLink& link : out.tree.links) {
    if (link.kind == JointKind::kBall) out.q[static_cast<std::size_t>(link.first_q)] = 1;
  }
  growCoordinates(out.tree, out.q, step, out.q);
  for (double& s : step) s = dice.between(-3, 3);
  out.u = step;
  return out;
}

}  // namespace pincer::tests
