#include "pincer/engine/world/drive_rows.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/tree/tree_course.h"
#include "pincer/engine/world/joint_row_parts.h"

namespace pincer::engine {
namespace {

bool hasLaw(const DriveTick& law) { return law.stiffness > 0 || law.damping > 0; }
double middleOf(const DriveModel& drive) { return 0.5 * (drive.lower_force + drive.upper_force); }
double rangeOf(const DriveModel& drive) { return 0.5 * (drive.upper_force - drive.lower_force); }

// The law of a drive without its limits.
DriveTick lawOf(const DriveModel& drive, const DriveInput& before, const DriveInput& now) {
  DriveTick law{.stiffness = drive.stiffness, .damping = drive.damping, .force = drive.offset};
  if (drive.control == DriveModel::Control::kForce) {
    law.force += drive.gain * (now.moves ? 0.5 * (before.value + now.value) : now.value);
  } else if (drive.control == DriveModel::Control::kVelocity) {
    law.start_rate = now.moves ? before.value : now.value;
    law.end_rate = now.value;
  } else {
    law.target = now.moves ? before.value : now.value;
    law.way = now.value - law.target;
    law.start_rate = now.moves ? before.rate : 0;
    law.end_rate = now.moves ? now.rate : 0;
  }
  return law;
}

// The force that the tree feels of a drive by itself: within its limits its law, else what is constant of it.
void applyMode(const DriveModel& drive, const DriveScratch& now, DriveTick& out) {
  out = now.law;
  if (now.mode == DriveMemory::kWithin) return;
  out = {};
  out.force = now.mode == DriveMemory::kLow    ? drive.lower_force
              : now.mode == DriveMemory::kHigh ? drive.upper_force
                                               : middleOf(drive);
}

// m^ and p of a drive's law where the tree is without it, and the mobility of l.
void findLaw(const TreeModel& tree, const TreeDrive& own, const TreeScratch& s, std::span<const double> u,
             double mobility, double h, DriveScratch& now) {
  const DriveTick& law = now.law;
  double l = 0;
  for (const TreeDrive::Term& term : own.terms) l += term.factor * s.q[tree.coordinates[term.coordinate].q];
  const ElementTick tick{law.stiffness, law.damping,    l - law.target, lengthRate(tree, s.course.mid, own, u),
                         law.way,       law.start_rate, law.end_rate,   h};
  const double inertia = 1 / mobility;
  const ImpliedInertia implied =
      isSoft(law.stiffness, law.damping, inertia, h) ? softLaw(tick) : stiffLaw(tick, inertia);
  now.mass = implied.mass;
  now.impulse = implied.impulse + h * law.force;
}

}  // namespace

bool isLimited(const DriveModel& drive) { return std::isfinite(drive.lower_force) || std::isfinite(drive.upper_force); }

DriveInput withinControls(const DriveModel& drive, const DriveInput& told) {
  if (drive.lower_control <= told.value && told.value <= drive.upper_control) return told;
  return {std::clamp(told.value, drive.lower_control, drive.upper_control), 0, told.moves};
}

DriveInput controlAt(const DriveInput& before, const DriveInput& end, double left, double share) {
  if (!end.moves || !(share < 1)) return end;
  Vec3 rate = Vec3::Zero();
  const auto along = [](double x) { return Vec3(x, 0, 0); };
  const Vec3 value =
      cubicBetween(along(before.value), along(before.rate), along(end.value), along(end.rate), left, share, rate);
  return {value.x(), rate.x(), true};
}

void startDrive(const WorldModel& model, const WorldState& state, const TreeDrive& own, WorldScratch& scratch,
                DriveTick& out) {
  const DriveModel& drive = model.drives[own.drive];
  DriveScratch& now = scratch.drives[own.drive];
  now.law = lawOf(drive, state.controls[own.drive], now.input);
  now.mode = state.drives[own.drive];
  if (scratch.h > 0) {
    const double h = scratch.h;
    if (drive.control == DriveModel::Control::kVelocity)
      now.law.way = 0.5 * h * (now.law.start_rate + now.law.end_rate);
  }
  if (!isLimited(drive)) now.mode = DriveMemory::kWithin;
  if (!hasLaw(now.law)) {  // a force, whatever moves
    now.law.force = std::clamp(now.law.force, drive.lower_force, drive.upper_force);
    now.mode = DriveMemory::kWithin;
  }
  applyMode(drive, now, out);
}

void putDrive(const WorldModel& model, const WorldState& state, int slot, JointRowScratch& row, WorldScratch& scratch) {
  const TreeModel& tree = treeOf(model, row);
  TreeScratch& s = scratch.trees[row.tree];
  const TreeDrive& own = tree.drives[row.element];
  DriveScratch& now = scratch.drives[own.drive];
  if (now.mode == DriveMemory::kWithin) return;
  const DriveModel& drive = model.drives[own.drive];
  const std::span<const double> q = treeCoordinates(tree, state);
  std::copy(q.begin(), q.end(), s.q.begin());
  row.mobility = mobilityOf(model, row, s);
  findLaw(tree, own, s, treeRates(tree, state), row.mobility, scratch.h, now);
  if (!row.wanted) return;
  row.limit = scratch.h * rangeOf(drive);
  row.grip = std::min(row.mobility, kGripSpeed / row.limit);
  row.compliance = 1 / now.mass;
  const double rate = lengthRate(tree, s.course.mid, own, treeRates(tree, state)),
               free = lengthRate(tree, s.course.mid, own, s.course.u_free);
  const double asked = now.impulse - scratch.h * middleOf(drive);  // past the constant force
  row.start = row.end = {};
  row.free = {{free - rate - asked / now.mass, 0, 0}, Vec3::Zero()};
  addRow(0, slot, row, scratch);
}

bool reviseDrive(const WorldModel& model, const WorldState& state, JointRowScratch& row, WorldScratch& scratch) {
  const TreeModel& tree = treeOf(model, row);
  TreeScratch& s = scratch.trees[row.tree];
  const TreeDrive& own = tree.drives[row.element];
  const DriveModel& drive = model.drives[own.drive];
  DriveScratch& now = scratch.drives[own.drive];
  if (!hasLaw(now.law) || row.wanted) return false;
  double end_rate = 0;
  for (const TreeDrive::Term& term : own.terms) end_rate += term.factor * endRate(tree, s, term.coordinate);
  const double h = scratch.h, change = end_rate - lengthRate(tree, s.course.mid, own, treeRates(tree, state));
  double impulse = now.impulse - now.mass * change;
  if (now.mode == DriveMemory::kWithin) {
    const ImpliedInertia& implied = s.course.drives[row.element].implied;
    impulse = implied.impulse + h * now.law.force - implied.mass * change;
  }
  now.force = impulse / h;
  if (!isLimited(drive)) return false;
  const double slack = kResidue * rangeOf(drive);
  const bool is_right = now.mode == DriveMemory::kLow ? now.force <= drive.lower_force + slack
                        : now.mode == DriveMemory::kHigh
                            ? now.force >= drive.upper_force - slack
                            : drive.lower_force - slack <= now.force && now.force <= drive.upper_force + slack;
  now.force = std::clamp(now.force, drive.lower_force, drive.upper_force);
  if (is_right) return false;
  now.mode = DriveMemory::kUnsure;
  applyMode(drive, now, s.drives[row.element]);
  return row.wanted = true;
}

void rememberDrive(const WorldModel& model, const JointRowScratch& row, WorldState& state, WorldScratch& scratch) {
  const int d = treeOf(model, row).drives[row.element].drive;
  DriveScratch& now = scratch.drives[d];
  if (row.wanted) {
    const double r = row.touched ? row.impulse_W.x() : 0, full = (1 - kResidue) * row.limit;
    now.mode = r >= full ? DriveMemory::kHigh : r <= -full ? DriveMemory::kLow : DriveMemory::kWithin;
    now.force = r / scratch.h + middleOf(model.drives[d]);
  }
  state.drives[d] = now.mode;
  state.controls[d] = now.input;
}

DriveReport driveAt(const WorldScratch& scratch, int drive) {
  const DriveScratch& now = scratch.drives[drive];
  return {hasLaw(now.law) ? now.force : now.law.force, now.mode == DriveMemory::kLow || now.mode == DriveMemory::kHigh};
}

}  // namespace pincer::engine
