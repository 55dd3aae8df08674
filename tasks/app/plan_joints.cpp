#include "pincer/tasks/app/plan_joints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/io/counted.h"

namespace pincer::tasks {
namespace {

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

const engine::JointModel& jointOf(const engine::WorldModel& world, const engine::TreeCoordinate& c) {
  return world.joints[slot(c.joint)];
}

std::string baseOf(const engine::WorldModel& world, const engine::TreeModel& tree) {
  if (tree.base < 0) return "the world";
  const engine::BodyModel& base = world.bodies[slot(tree.base)];
  return fmt::format("{} ({})", base.name, base.driven ? "driven" : "static");
}

// True if the free course may be that of Runge and Kutta (engine/world/tree_motion.cpp).
bool movesAlone(const engine::TreeModel& tree) {
  return !tree.may_touch &&
         std::none_of(tree.coordinates.begin(), tree.coordinates.end(), [](const engine::TreeCoordinate& c) {
           return c.traits.friction > 0 || std::isfinite(c.traits.lower) || std::isfinite(c.traits.upper);
         });
}

std::string treeForm(const engine::WorldModel& world, const engine::TreeModel& tree) {
  std::vector<int> sizes;
  for (const engine::TreeBlock& block : tree.blocks) sizes.push_back(block.count);
  const std::string course =
      movesAlone(tree) ? "4th order in the tick where its drives are soft" : "2nd order in the tick";
  const std::string touch = tree.may_touch
                                ? fmt::format("{} of the solver, [{}] freedoms",
                                              counted(std::ssize(tree.blocks), "mover"), fmt::join(sizes, ", "))
                                : "touches nothing";
  return fmt::format("on {}: {}, {}; {}; {}", baseOf(world, tree), counted(std::ssize(tree.links), "link"),
                     counted(tree.columnCount(), "freedom"), touch, course);
}

// Forces along a coordinate, and which of them cost rows only where they act.
std::string coordinateForm(const engine::WorldModel& world, const engine::TreeModel& tree,
                           const engine::TreeCoordinate& c) {
  const engine::JointTraits& t = c.traits;
  const bool turns = jointOf(world, c).kind != engine::JointKind::kSlider;
  const char* const of_spring = turns ? "N m/rad" : "N/m";
  const char* const place = turns ? "rad" : "m";
  std::vector<std::string> parts;
  if (c.leader >= 0)
    parts.push_back(
        fmt::format("follows {}: no freedom of its own", jointOf(world, tree.coordinates[slot(c.leader)]).name));
  if (t.stiffness > 0) parts.push_back(fmt::format("spring {:g} {}, in M", t.stiffness, of_spring));
  if (c.damping > 0) parts.push_back(fmt::format("damper {:g}, in M", c.damping));
  if (t.armature > 0) parts.push_back(fmt::format("armature {:g}", t.armature));
  if (std::isfinite(t.lower))
    parts.push_back(fmt::format("stop at {:g} {}, a row where it is reached", t.lower, place));
  if (std::isfinite(t.upper))
    parts.push_back(fmt::format("stop at {:g} {}, a row where it is reached", t.upper, place));
  if (t.friction > 0)
    parts.push_back(fmt::format("dry friction {:g} {}: a row while it holds what pushes it, a force while it slides",
                                t.friction, turns ? "N m" : "N"));
  return fmt::format("{}{}{}", turns ? "turns" : "slides", parts.empty() ? "" : "; ", fmt::join(parts, "; "));
}

std::string driveForm(const engine::WorldModel& world, const engine::TreeModel& tree, const engine::TreeDrive& own) {
  constexpr std::array kControls = {"a force", "to a position", "to a rate"};  // by DriveModel::Control
  const engine::DriveModel& drive = world.drives[slot(own.drive)];
  std::vector<std::string> joints;
  for (const engine::TreeDrive::Term& term : own.terms)
    joints.push_back(fmt::format("{:g} {}", term.factor, jointOf(world, tree.coordinates[slot(term.coordinate)]).name));
  std::string text =
      fmt::format("{} on {}", kControls[static_cast<std::size_t>(drive.control)], fmt::join(joints, " + "));
  if (drive.stiffness > 0) text += fmt::format(", stiffness {:g}", drive.stiffness);
  if (drive.damping > 0) text += fmt::format(", damping {:g}", drive.damping);
  if (std::isfinite(drive.lower_force) || std::isfinite(drive.upper_force))
    text += fmt::format("; within [{:g}, {:g}]: in M while inside, a force while beyond, a row in between",
                        drive.lower_force, drive.upper_force);
  return text;
}

std::string treeName(const engine::WorldModel& world, const engine::TreeModel& tree) {
  return fmt::format("{}{}", world.bodies[slot(tree.links.front().body)].name, tree.links.size() > 1 ? " .." : "");
}

}  // namespace

void describeTrees(const engine::WorldModel& world, std::vector<PlanLine>& lines) {
  for (const engine::TreeModel& tree : world.trees) {
    lines.push_back({"tree", treeName(world, tree), treeForm(world, tree)});
    for (const engine::TreeCoordinate& c : tree.coordinates) {
      if (c.q >= 0) lines.push_back({"joint", jointOf(world, c).name, coordinateForm(world, tree, c)});
    }
    for (const engine::TreeDrive& drive : tree.drives)
      lines.push_back({"drive", world.drives[slot(drive.drive)].name, driveForm(world, tree, drive)});
  }
}

}  // namespace pincer::tasks
