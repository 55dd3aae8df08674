#include "pincer/engine/world/joint_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/world/body_model.h"

namespace pincer::engine {
namespace {

bool moves(const WorldModel& model, int body) { return body >= 0 && model.bodies[body].dynamic; }

// Per body the lowest one that moving bodies and joints connect it with.
std::vector<int> rootsOf(const WorldModel& model) {
  std::vector<int> root(model.bodies.size());
  std::iota(root.begin(), root.end(), 0);
  for (bool changes = true; changes;) {
    changes = false;
    for (const JointModel& joint : model.joints) {
      if (!moves(model, joint.b) || root[joint.a] == root[joint.b]) continue;
      root[joint.a] = root[joint.b] = std::min(root[joint.a], root[joint.b]);
      changes = true;
    }
  }
  return root;
}

// Joints by roots; what named them names their new places.
void sortJoints(const std::vector<int>& root, WorldModel& model) {
  std::vector<int> order(model.joints.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int x, int y) { return root[model.joints[x].a] < root[model.joints[y].a]; });
  std::vector<JointModel> sorted;
  model.joint_places.resize(order.size());
  for (const int j : order) {
    model.joint_places[j].joint = static_cast<int>(sorted.size());
    sorted.push_back(std::move(model.joints[j]));
  }
  model.joints = std::move(sorted);
  for (DriveModel& drive : model.drives) {
    for (DriveTerm& term : drive.terms) term.joint = model.joint_places[term.joint].joint;
  }
}

// Notes if the group has one coordinate, and which.
void findHeldBody(const WorldModel& model, JointGroup& group) {
  const JointModel& joint = model.joints[group.first];
  const bool turns = joint.kind == JointKind::kPivot, slides = joint.kind == JointKind::kSlider;
  const bool stands = joint.b < 0 || (!model.bodies[joint.b].dynamic && !model.bodies[joint.b].driven);
  if (group.count != 1 || !stands || !(turns || slides)) return;
  const BodyModel& body = model.bodies[joint.a];
  group.is_held_body = true;
  group.axis_A = joint.X_AJ.q * Vec3::UnitZ();
  PINCER_ASSERT(isUnit(group.axis_A));
  const double about_centre = group.axis_A.cwiseAbs2().dot(body.moments),
               arm2 = group.axis_A.cross(joint.X_AJ.p).squaredNorm();
  group.inertia = turns ? about_centre + body.mass * arm2 : body.mass;
}

int blockedBy(JointKind kind) { return kind == JointKind::kWeld ? 6 : kind == JointKind::kBall ? 3 : 5; }

}  // namespace

void groupJoints(WorldModel& model) {
  const std::vector<int> root = rootsOf(model);
  sortJoints(root, model);
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointModel& joint = model.joints[j];
    if (j == 0 || root[joint.a] != root[model.joints[j - 1].a]) model.joint_groups.push_back({j, 0, {}});
    ++model.joint_groups.back().count;
    for (const int body : {joint.a, joint.b}) {
      if (moves(model, body)) model.bodies[body].joint_group = static_cast<int>(model.joint_groups.size()) - 1;
      if (body >= 0) model.bodies[body].may_touch = true;
    }
  }
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    if (model.bodies[i].joint_group >= 0) model.joint_groups[model.bodies[i].joint_group].bodies.push_back(i);
  }
  PINCER_ASSERT(model.joint_groups.empty() || model.joint_groups.back().first + model.joint_groups.back().count ==
                                                  static_cast<int>(model.joints.size()));
}

int freedomsOf(const WorldModel& model, const JointGroup& group) {
  int freedoms = 6 * static_cast<int>(group.bodies.size());
  for (int j = group.first; j < group.first + group.count; ++j) freedoms -= blockedBy(model.joints[j].kind);
  return freedoms;
}

void checkGroups(WorldModel& model) {
  for (const PairModel& pair : model.pairs) {
    for (const int body : {pair.a, pair.b}) {
      if (model.bodies[body].joint_group >= 0) model.joint_groups[model.bodies[body].joint_group].may_touch = true;
    }
  }
  for (JointGroup& group : model.joint_groups) {
    group.may_touch = group.may_touch || !model.points.empty() || model.has_broad_phase;
    findHeldBody(model, group);
    const int freedoms = freedomsOf(model, group);
    const bool large = 6 * static_cast<int>(group.bodies.size()) > kMostGroupFreedoms;
    if (!group.may_touch || (freedoms <= kMoverFreedoms && !large)) continue;
    throw InputError(
        fmt::format("the {} bodies joined with \"{}\" can move in {} ways together, and contacts know joined bodies of "
                    "at most {} bodies and {} "
                    "ways. Hold one of them to the world, weld some, or let nothing touch them.",
                    group.bodies.size(), model.bodies[group.bodies.front()].name, freedoms, kMostGroupFreedoms / 6,
                    kMoverFreedoms));
  }
}

namespace {

std::string nameOf(const JointModel& joint, std::size_t number) {
  return joint.name.empty() ? fmt::format("joint {}", number) : fmt::format("joint \"{}\"", joint.name);
}

bool hasCoordinate(const JointModel& joint) {
  return joint.kind == JointKind::kPivot || joint.kind == JointKind::kSlider;
}

void checkTraits(const std::string& name, const JointModel& joint) {
  const JointTraits& t = joint.traits;
  requireRange(name + ".restitution", t.restitution, 0, 1, "The share of its speed with which it leaves a stop.");
  requireRange(name + ".stiffness", t.stiffness, 0, 1e12, "A spring's stiffness is zero or positive.");
  requireRange(name + ".friction", t.friction, 0, 1e9, "Dry friction is zero or positive, in N or N m.");
  requireRange(name + ".armature", t.armature, 0, 1e6, "An armature is zero or positive, in kg or kg m^2.");
  if (!(t.lower <= t.upper))
    throw InputError(fmt::format("{}.limits: [{:g}, {:g}]: the lower one comes first.", name, t.lower, t.upper));
  JointTraits of_balls;
  of_balls.armature = t.armature;
  const bool is_plain = t == of_balls && (joint.kind == JointKind::kBall || t.armature == 0);
  if (hasCoordinate(joint) || is_plain) return;
  throw InputError(
      fmt::format("{}: only pivots and sliders have limits, springs, dry friction and a start; balls may have damping "
                  "and an armature.",
                  name));
}

const JointModel& checkedJoint(const WorldModel& model, const std::string& who, int joint) {
  if (!isIndex(joint, model.joints.size()))
    throw InputError(fmt::format("{}: joint {} isn't one of the {} that were added. Add the joints first.", who, joint,
                                 model.joints.size()));
  if (!hasCoordinate(model.joints[joint]))
    throw InputError(
        fmt::format("{}: {} has no coordinate. Name a pivot or a slider.", who, nameOf(model.joints[joint], joint)));
  return model.joints[joint];
}

}  // namespace

int WorldBuilder::addJoint(const JointModel& joint) {
  const int count = static_cast<int>(model_.bodies.size());
  const std::string name = nameOf(joint, model_.joints.size());
  requireRange(name + ".damping", joint.damping, 0, 1e9, "A damper's coefficient is zero or positive.");
  if (joint.a < 0 || joint.a >= count || joint.b < -1 || joint.b >= count || joint.a == joint.b) {
    throw InputError(fmt::format("{}: it joins bodies {} and {}, but there are {}. Add both bodies first.", name,
                                 joint.a, joint.b, count));
  }
  if (!model_.bodies[joint.a].dynamic) {
    throw InputError(fmt::format("{}: its first body \"{}\" never moves by itself. Name the moving one first.", name,
                                 model_.bodies[joint.a].name));
  }
  PINCER_DEMAND(isUnit(joint.X_AJ.q) && isUnit(joint.X_BJ.q),
                "addJoint: the frames' quaternions have length 1; normalise them");
  JointModel inertial = joint;
  inertial.X_AJ = model_.bodies[joint.a].X_IB * joint.X_AJ;
  if (joint.b >= 0) inertial.X_BJ = model_.bodies[joint.b].X_IB * joint.X_BJ;
  if (joint.b >= 0) excludePair(joint.a, joint.b);
  checkTraits(name, joint);
  model_.joints.push_back(inertial);
  return static_cast<int>(model_.joints.size()) - 1;
}

int WorldBuilder::addCoupling(const CouplingModel& coupling) {
  const std::string name = fmt::format("coupling {}", couplings_.size());
  const std::string follower = nameOf(checkedJoint(model_, name, coupling.joint), coupling.joint);
  checkedJoint(model_, name, coupling.follows);
  for (const CouplingModel& other : couplings_) {
    if (other.joint == coupling.joint || other.joint == coupling.follows || other.follows == coupling.joint)
      throw InputError(fmt::format(
          "{}: {} follows two joints, or is followed by one and follows another. Let all follow one that is free.",
          name, follower));
  }
  if (coupling.joint == coupling.follows) throw InputError(fmt::format("{}: {} follows itself.", name, follower));
  for (const double c : coupling.polynomial)
    requireRange(name + ".polynomial", c, -1e6, 1e6, "Coefficients of 1, q, q^2 ..");
  couplings_.push_back(coupling);
  return static_cast<int>(couplings_.size()) - 1;
}

int WorldBuilder::addDrive(const DriveModel& drive) {
  const std::string name = fmt::format("drive \"{}\"", drive.name);
  if (drive.terms.empty()) throw InputError(fmt::format("{}: it drives nothing. Name a joint.", name));
  for (const DriveTerm& term : drive.terms) {
    checkedJoint(model_, name, term.joint);
    requireRange(name + ".factor", term.factor, -1e6, 1e6,
                 "How much a joint's coordinate counts; 1 drives the joint itself.");
  }
  requireRange(name + ".stiffness", drive.stiffness, 0, 1e12, "In N/m or N m/rad, zero or positive.");
  requireRange(name + ".damping", drive.damping, 0, 1e9, "In N s/m or N m s/rad, zero or positive.");
  requireRange(name + ".gain", drive.gain, -1e12, 1e12, "The force per unit of the control.");
  requireRange(name + ".offset", drive.offset, -1e12, 1e12, "A force that is always there.");
  if (!(drive.lower_force <= drive.upper_force))
    throw InputError(
        fmt::format("{}.force: [{:g}, {:g}]: the lower one comes first.", name, drive.lower_force, drive.upper_force));
  if (!(drive.lower_control <= drive.upper_control))
    throw InputError(fmt::format("{}.control: [{:g}, {:g}]: the lower one comes first.", name, drive.lower_control,
                                 drive.upper_control));
  if (std::isfinite(drive.lower_force) != std::isfinite(drive.upper_force))
    throw InputError(fmt::format("{}.force: [{:g}, {:g}]: it is limited on one side only. Give both limits, or none.",
                                 name, drive.lower_force, drive.upper_force));
  model_.drives.push_back(drive);
  return static_cast<int>(model_.drives.size()) - 1;
}

}  // namespace pincer::engine
