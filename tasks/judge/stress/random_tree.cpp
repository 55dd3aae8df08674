#include "pincer/tasks/judge/stress/random_tree.h"

#include <fmt/format.h>

#include <limits>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

double between(Random& random, double low, double high) { return low * math::pow(high / low, random.uniform()); }
bool oneIn(Random& random, std::uint64_t n) { return random.below(n) == 0; }

// Draws link by link: each starts where the one before it ends, joints at 0.
class TreeDraft {
 public:
  TreeDraft(Random& random, const engine::Material& material) : random_(random), material_(material) {}

  RandomTree draw() {
    const int chains = 1 + static_cast<int>(random_.below(3));
    for (int c = 0; c < chains; ++c) drawChain(-1, Vec3(0.4 * c, 0, 1.5), 1 + static_cast<int>(random_.below(6)));
    if (oneIn(random_, 2)) drawObject();
    for (int j = 0; j < static_cast<int>(tree_.joints.size()); ++j) {
      const auto kind = tree_.joints[static_cast<std::size_t>(j)].kind;
      if ((kind == engine::JointKind::kPivot || kind == engine::JointKind::kSlider) && !oneIn(random_, 3)) drawDrive(j);
    }
    return std::move(tree_);
  }

 private:
  void drawChain(int parent, Vec3 p_W, int links) {
    heavy_ = between(random_, 1e-2, 10);
    for (int l = 0; l < links; ++l) {
      const double length = random_.uniform(0.02, 0.1);
      const int body = addLink(between(random_, 1e-4, 1) * heavy_, length, p_W);
      addJoint(body, parent, p_W);
      parent = body;
      p_W.z() -= length;
      if (l == 1 && links > 3 && oneIn(random_, 2)) drawChain(parent, p_W + Vec3(0, 0.12, 0), 2);
    }
  }

  int addLink(double mass, double length, const Vec3& top_W) {
    engine::BodySpec link;
    link.name = fmt::format("link{}", tree_.bodies.size());
    link.shape = contact::Box{Vec3(0.008, 0.008, 0.5 * length)};
    link.mass = mass;
    link.material = material_;
    tree_.bodies.push_back(link);
    tree_.starts.push_back({{Quat::Identity(), top_W - Vec3(0, 0, 0.5 * length)}, Vec3::Zero(), Vec3::Zero()});
    return static_cast<int>(tree_.bodies.size()) - 1;
  }

  Quat anyAxis() {
    if (oneIn(random_, 2)) {
      const Vec3 axes[] = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
      return Quat::FromTwoVectors(Vec3::UnitZ(), axes[random_.below(3)]);
    }
    const Quat q = Quat::FromTwoVectors(Vec3::UnitZ(), random_.normal3().normalized());
    return isUnit(q) ? q : q.normalized();  // opposite vectors cost it digits
  }

  void addJoint(int body, int parent, const Vec3& p_W) {
    engine::JointModel joint;
    joint.name = fmt::format("joint{}", tree_.joints.size());
    joint.kind = oneIn(random_, 8)   ? engine::JointKind::kBall
                 : oneIn(random_, 4) ? engine::JointKind::kSlider
                                     : engine::JointKind::kPivot;
    joint.a = body;
    joint.b = parent;
    const Quat q = anyAxis();
    joint.X_AJ = {q, p_W - tree_.starts[static_cast<std::size_t>(body)].X_WB.p};
    joint.X_BJ = {q, parent < 0 ? p_W : Vec3(p_W - tree_.starts[static_cast<std::size_t>(parent)].X_WB.p)};
    joint.damping = oneIn(random_, 2) ? 0 : heavy_ * between(random_, 1e-5, 1);
    if (joint.kind == engine::JointKind::kBall)
      joint.traits.armature = between(random_, 1e-7, 1e-4);
    else
      drawTraits(joint);
    tree_.joints.push_back(joint);
    weights_.push_back(heavy_);
  }

  void drawTraits(engine::JointModel& joint) {
    engine::JointTraits& traits = joint.traits;
    const double scale = joint.kind == engine::JointKind::kSlider ? 0.05 : 1;
    if (joint.kind == engine::JointKind::kSlider || !oneIn(random_, 3)) {
      traits.lower = -scale * random_.uniform(0, 1);
      traits.upper = scale * random_.uniform(0, 1);
      traits.restitution = oneIn(random_, 2) ? 0 : random_.uniform(0, 0.9);
    }
    if (oneIn(random_, 3)) {
      traits.stiffness = heavy_ * between(random_, 1e-3, 1e3);
      traits.rest = scale * random_.uniform(-0.5, 0.5);
    }
    if (oneIn(random_, 2)) traits.friction = heavy_ * between(random_, 1e-4, 1);
    traits.armature = oneIn(random_, 2) ? 0 : heavy_ * between(random_, 1e-6, 1e-2);
  }

  void drawDrive(int joint) {
    engine::DriveModel drive;
    drive.name = fmt::format("drive{}", tree_.drives.size());
    drive.terms = {{joint, 1}};
    const double heavy = weights_[static_cast<std::size_t>(joint)];
    drive.gain = heavy;
    drive.control = static_cast<engine::DriveModel::Control>(random_.below(3));
    if (drive.control == engine::DriveModel::Control::kPosition) drive.stiffness = heavy * between(random_, 1e-1, 1e4);
    drive.damping = oneIn(random_, 2) ? 0 : heavy * between(random_, 1e-2, 10);
    if (!oneIn(random_, 3)) {
      drive.upper_force = heavy * between(random_, 1e-2, 20);
      drive.lower_force = -drive.upper_force;
    }
    tree_.drives.push_back(drive);
  }

  void drawObject() {
    engine::BodySpec object;
    object.name = "object";
    if (oneIn(random_, 2))
      object.shape = contact::Sphere{0.03};
    else
      object.shape = contact::Box{Vec3(0.02, 0.03, 0.02)};
    object.mass = between(random_, 1e-3, 10);
    object.material = material_;
    tree_.bodies.push_back(object);
    tree_.starts.push_back({{Quat::Identity(), Vec3(0.03, 0, 1.7)}, Vec3::Zero(), Vec3::Zero()});
  }

  Random& random_;
  const engine::Material& material_;
  RandomTree tree_;
  double heavy_ = 1;             // the heaviest link of the chain, at most [kg]: forces go with it
  std::vector<double> weights_;  // of joints
};

}  // namespace

RandomTree drawTree(Random& random, const engine::Material& material) { return TreeDraft(random, material).draw(); }

void drawControls(Random& random, const std::vector<engine::DriveModel>& drives,
                  std::vector<engine::DriveInput>& controls) {
  controls.resize(drives.size());
  for (std::size_t d = 0; d < drives.size(); ++d) {
    if (!oneIn(random, 50)) continue;
    const double most = drives[d].control == engine::DriveModel::Control::kForce ? 1 : 0.5;
    controls[d] = {random.uniform(-most, most), 0, false};
  }
}

}  // namespace pincer::tasks
