#include "pincer/engine/world/joint_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/tree/tree_course.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/impact.h"

namespace pincer::engine {
namespace {

constexpr int kRowsPerCoordinate = 3;
constexpr double kGripSpeed = 1;     // most of w h F: what a brake can hold doesn't count among the problem's speeds [m/s, rad/s]
constexpr double kRoundOff = 1e-12;  // of a force at its limit
constexpr double kLate = 1.5;        // times this part of the tick: what gets to its stop so late may still get there in it
constexpr double kAtHit = 1e-9;      // in an impact: what is left of the root [m, rad]
constexpr double kAtStop = 1e-12;    // [m, rad]

int slotOf(const TreeModel& tree, int coordinate, JointRowKind kind) {
  return kRowsPerCoordinate * (tree.first_coordinate + coordinate) + static_cast<int>(kind);
}

const TreeModel& treeOf(const WorldModel& model, const JointRowScratch& row) { return model.trees[row.tree]; }

bool isLimited(const DriveModel& drive) { return std::isfinite(drive.lower_force) || std::isfinite(drive.upper_force); }
bool hasLaw(const DriveTick& law) { return law.stiffness > 0 || law.damping > 0; }
double middleOf(const DriveModel& drive) { return 0.5 * (drive.lower_force + drive.upper_force); }
double rangeOf(const DriveModel& drive) { return 0.5 * (drive.upper_force - drive.lower_force); }

// How a drive would act without limits.
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

// A coordinate's rate when the columns go at `u`.
double rateOf(const TreeModel& tree, const TreePlace& place, int coordinate, std::span<const double> u) {
  return place.coordinates[coordinate].share * u[tree.coordinates[coordinate].column];
}
double lengthRate(const TreeModel& tree, const TreePlace& place, const TreeDrive& drive, std::span<const double> u) {
  double rate = 0;
  for (const TreeDrive::Term& term : drive.terms) rate += term.factor * rateOf(tree, place, term.coordinate, u);
  return rate;
}

// The force that the tree feels of a drive by itself: within its limits its law, else what is constant of it.
void applyMode(const DriveModel& drive, const DriveScratch& now, DriveTick& out) {
  out = now.law;
  if (now.mode == DriveMemory::kWithin) return;
  out = {};
  out.force = now.mode == DriveMemory::kLow ? drive.lower_force : now.mode == DriveMemory::kHigh ? drive.upper_force : middleOf(drive);
}

void startDrive(const WorldModel& model, const WorldState& state, const TreeDrive& own, WorldScratch& scratch, DriveTick& out) {
  const DriveModel& drive = model.drives[own.drive];
  DriveScratch& now = scratch.drives[own.drive];
  now.law = lawOf(drive, state.controls[own.drive], now.input);
  now.mode = state.drives[own.drive];
  if (scratch.h > 0) {
    const double h = scratch.h;
    if (drive.control == DriveModel::Control::kVelocity) now.law.way = 0.5 * h * (now.law.start_rate + now.law.end_rate);
  }
  if (!isLimited(drive)) now.mode = DriveMemory::kWithin;
  if (!hasLaw(now.law)) {  // a force, whatever moves
    now.law.force = std::clamp(now.law.force, drive.lower_force, drive.upper_force);
    now.mode = DriveMemory::kWithin;
  }
  applyMode(drive, now, out);
}

// m^ and p of a drive's law where the tree is without it, and the mobility of l.
void findLaw(const TreeModel& tree, const TreeDrive& own, const TreeScratch& s, std::span<const double> u, double mobility, double h,
             DriveScratch& now) {
  const DriveTick& law = now.law;
  double l = 0;
  for (const TreeDrive::Term& term : own.terms) l += term.factor * s.q[tree.coordinates[term.coordinate].q];
  const ElementTick tick{law.stiffness, law.damping,    l - law.target, lengthRate(tree, s.course.mid, own, u),
                         law.way,       law.start_rate, law.end_rate,   h};
  const double inertia = 1 / mobility;
  const ImpliedInertia implied = isSoft(law.stiffness, law.damping, inertia, h) ? softLaw(tick) : stiffLaw(tick, inertia);
  now.mass = implied.mass;
  now.impulse = implied.impulse + h * law.force;
}

double mobilityOf(const WorldModel& model, const JointRowScratch& row, TreeScratch& s) {
  const TreeModel& tree = treeOf(model, row);
  double sum = 0;
  for (int c = scaledRow(model, row, s); c >= 0; c = tree.before[c]) sum += s.row[c] * s.row[c];
  return sum;
}

// What is at a stop in the middle of the tick or, without contact, at its end.
struct StopGap {
  double mid, end, rate, free_rate;  // out of the stop
};
StopGap gapOf(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, const JointRowScratch& row,
              double gained_share) {
  const TreeModel& tree = treeOf(model, row);
  const TreeScratch& s = scratch.trees[row.tree];
  const TreeCoordinate& own = tree.coordinates[row.element];
  const double share = s.course.mid.coordinates[row.element].share, h = scratch.h;
  const double q = state.tree_q[tree.first_q + own.q], gained = gained_share * s.gained[own.column];
  const double rate = share * state.tree_v[tree.first_v + own.column], free_rate = share * s.course.u_free[own.column];
  const double way =
      s.closing && gained_share > 0 ? h * (s.course.u_free[own.column] + gained) : s.course.way_free[own.column] + 0.5 * h * gained;
  const bool is_lower = row.kind == JointRowKind::kLower;
  const double sign = is_lower ? 1 : -1, limit = is_lower ? own.traits.lower : own.traits.upper;
  return {sign * (q + 0.5 * h * rate - limit), sign * (q + share * way - limit), sign * rate, sign * free_rate};
}

bool hasStop(const TreeCoordinate& own, JointRowKind kind) {
  return own.q >= 0 && std::isfinite(kind == JointRowKind::kLower ? own.traits.lower : own.traits.upper);
}

std::uint64_t idOf(int slot) { return std::uint64_t{2} << 62 | static_cast<std::uint64_t>(slot) << 32; }

Contact* addRow(double phi, int slot, JointRowScratch& row, WorldScratch& scratch) {
  Contact* const c = addContact(scratch, phi);
  if (!c) return nullptr;
  c->id = idOf(slot);
  c->a = {SideKind::kJoint, 0, slot};
  c->b = {SideKind::kJoint, 0, static_cast<int>(scratch.joint_rows.size()) - 1};
  c->p_W.setZero();
  c->R_WC.setIdentity();
  c->material = {};
  c->material.mu_s = c->material.mu_d = row.isBrake() ? 1 : 0;
  ++scratch.joint_contacts;
  return c;
}

// Whether the joint flies into its stop in this part of the tick, or nearly does, so fast that the tick is cut there.
JointRowScratch::Hit hitOf(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, int slot,
                           const JointRowScratch& row, const StopGap& gap) {
  using Hit = JointRowScratch::Hit;
  constexpr double kApart = 1e-9;  // [m, rad]
  const double h = scratch.h, phi = gap.mid - 0.5 * h * gap.rate;
  if (scratch.stops_hit == Hit::kNone || !(h > 0) || row.wanted || !(phi > kApart) ||
      !(phi + kLate * h * std::min(gap.rate, gap.free_rate) < 0))
    return Hit::kNone;
  if (pushedBefore(state, idOf(slot))) return Hit::kNone;
  const double u = -std::sqrt(std::max(gap.rate * gap.rate - 2 * row.acceleration * phi, 0.0));
  const double restitution = treeOf(model, row).coordinates[row.element].traits.restitution;
  if (bounceRestitution(restitution, u, row.acceleration, model.options.h) > 0) return Hit::kBounces;
  // Slower it lands at the end of the tick, where it is as well.
  const bool is_hard = -u > model.options.h * std::abs(row.acceleration) && -u > kClosingSpeed;
  return is_hard && scratch.stops_hit == Hit::kLands ? Hit::kLands : Hit::kNone;
}

void putStop(const WorldModel& model, const WorldState& state, int slot, JointRowScratch& row, WorldScratch& scratch) {
  const StopGap gap = gapOf(model, state, scratch, row, 0);
  if (scratch.h > 0) row.acceleration = (gap.free_rate - gap.rate) / scratch.h;
  row.hit = hitOf(model, state, scratch, slot, row, gap);
  if (row.hit != JointRowScratch::Hit::kNone) return;
  row.wanted = row.wanted || std::min(gap.mid, gap.end) <= (scratch.h > 0 ? kAtStop : kAtHit);
  if (!row.wanted) return;
  row.mobility = mobilityOf(model, row, scratch.trees[row.tree]);
  row.start = {{0, 0, gap.rate}, Vec3::Zero()};
  row.free = row.end = {{0, 0, gap.free_rate}, Vec3::Zero()};
  if (Contact* const c = addRow(gap.mid, slot, row, scratch))
    c->material.restitution = treeOf(model, row).coordinates[row.element].traits.restitution;
}

void putFriction(const WorldModel& model, const WorldState& state, int slot, JointRowScratch& row, WorldScratch& scratch) {
  if (!row.wanted) return;
  const TreeModel& tree = treeOf(model, row);
  TreeScratch& s = scratch.trees[row.tree];
  row.mobility = mobilityOf(model, row, s);
  row.limit = scratch.h * tree.coordinates[row.element].traits.friction;
  row.grip = std::min(row.mobility, kGripSpeed / row.limit);
  row.start = {{rateOf(tree, s.course.mid, row.element, treeRates(tree, state)), 0, 0}, Vec3::Zero()};
  row.free = row.end = {{rateOf(tree, s.course.mid, row.element, s.course.u_free), 0, 0}, Vec3::Zero()};
  addRow(0, slot, row, scratch);
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

// Once the rates have changed by what contacts gained.
double endRate(const TreeModel& tree, const TreeScratch& s, int coordinate) {
  const int column = tree.coordinates[coordinate].column;
  return s.course.mid.coordinates[coordinate].share * (s.course.u_free[column] + s.gained[column]);
}
double endLengthRate(const TreeModel& tree, const TreeScratch& s, const TreeDrive& drive) {
  double rate = 0;
  for (const TreeDrive::Term& term : drive.terms) rate += term.factor * endRate(tree, s, term.coordinate);
  return rate;
}

// A joint that was to go on in one direction turned round, or stopped.
bool reviseFriction(const WorldModel& model, JointRowScratch& row, WorldScratch& scratch) {
  TreeScratch& s = scratch.trees[row.tree];
  const double friction = s.constant[row.element];
  if (row.wanted || friction == 0 || endRate(treeOf(model, row), s, row.element) * friction < 0) return false;
  s.constant[row.element] = 0;
  return row.wanted = true;
}

bool reviseDrive(const WorldModel& model, const WorldState& state, JointRowScratch& row, WorldScratch& scratch) {
  const TreeModel& tree = treeOf(model, row);
  TreeScratch& s = scratch.trees[row.tree];
  const TreeDrive& own = tree.drives[row.element];
  const DriveModel& drive = model.drives[own.drive];
  DriveScratch& now = scratch.drives[own.drive];
  if (!hasLaw(now.law) || row.wanted) return false;
  const double h = scratch.h, change = endLengthRate(tree, s, own) - lengthRate(tree, s.course.mid, own, treeRates(tree, state));
  double impulse = now.impulse - now.mass * change;
  if (now.mode == DriveMemory::kWithin) {
    const ImpliedInertia& implied = s.course.drives[row.element].implied;
    impulse = implied.impulse + h * now.law.force - implied.mass * change;
  }
  now.force = impulse / h;
  if (!isLimited(drive)) return false;
  const double slack = kRoundOff * rangeOf(drive);
  const bool is_right = now.mode == DriveMemory::kLow    ? now.force <= drive.lower_force + slack
                        : now.mode == DriveMemory::kHigh ? now.force >= drive.upper_force - slack
                                                         : drive.lower_force - slack <= now.force && now.force <= drive.upper_force + slack;
  now.force = std::clamp(now.force, drive.lower_force, drive.upper_force);
  if (is_right) return false;
  now.mode = DriveMemory::kUnsure;
  applyMode(drive, now, s.drives[row.element]);
  return row.wanted = true;
}

}  // namespace

int jointRowsOf(const WorldModel& model) {
  int count = 0;
  for (const TreeModel& tree : model.trees) {
    for (const TreeCoordinate& own : tree.coordinates)
      count += hasStop(own, JointRowKind::kLower) + hasStop(own, JointRowKind::kUpper) + (own.traits.friction > 0);
    for (const TreeDrive& drive : tree.drives) count += isLimited(model.drives[drive.drive]);
  }
  return count;
}

void sizeJointRows(const WorldModel& model, WorldScratch& scratch) {
  if (model.trees.empty()) return;
  scratch.joint_rows.resize(static_cast<std::size_t>(kRowsPerCoordinate * model.tree_coordinate_count) + model.drives.size() + 1);
  scratch.drives.resize(model.drives.size());
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    const TreeModel& tree = model.trees[t];
    scratch.trees.emplace_back(tree);
    for (int i = 0; i < tree.coordinateCount(); ++i) {
      for (const JointRowKind kind : {JointRowKind::kLower, JointRowKind::kUpper, JointRowKind::kFriction}) {
        JointRowScratch& row = scratch.joint_rows[slotOf(tree, i, kind)];
        row.kind = kind;
        row.tree = t;
        row.element = i;
      }
    }
    for (int d = 0; d < static_cast<int>(tree.drives.size()); ++d) {
      JointRowScratch& row = scratch.joint_rows[kRowsPerCoordinate * model.tree_coordinate_count + tree.drives[d].drive];
      row.kind = JointRowKind::kDrive;
      row.tree = t;
      row.element = d;
    }
  }
}

void startJointRows(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  for (JointRowScratch& row : scratch.joint_rows) {
    row.wanted = false;
    row.hit = JointRowScratch::Hit::kNone;
  }
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const TreeModel& tree = model.trees[t];
    TreeScratch& s = scratch.trees[t];
    for (std::size_t d = 0; d < tree.drives.size(); ++d) startDrive(model, state, tree.drives[d], scratch, s.drives[d]);
    for (int i = 0; i < tree.coordinateCount(); ++i) {
      const double friction = tree.coordinates[i].traits.friction, u = state.tree_v[tree.first_v + tree.coordinates[i].column];
      s.constant[i] = 0;
      if (friction == 0) continue;
      const BrakeMemory memory = state.brakes[tree.first_coordinate + i];
      if (memory == BrakeMemory::kForward && u != 0) s.constant[i] = -friction;
      if (memory == BrakeMemory::kBackward && u != 0) s.constant[i] = friction;
      scratch.joint_rows[slotOf(tree, i, JointRowKind::kFriction)].wanted = s.constant[i] == 0 && scratch.h > 0;
    }
  }
}

void putJointRows(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  std::erase_if(scratch.contacts, [](const Contact& c) { return c.a.kind == SideKind::kJoint; });
  scratch.joint_contacts = 0;
  for (int slot = 0; slot + 1 < static_cast<int>(scratch.joint_rows.size()); ++slot) {
    JointRowScratch& row = scratch.joint_rows[slot];
    if (row.tree < 0) continue;
    if (row.kind == JointRowKind::kDrive) {
      if (scratch.h > 0) putDrive(model, state, slot, row, scratch);
    } else if (row.kind == JointRowKind::kFriction) {
      putFriction(model, state, slot, row, scratch);
    } else if (hasStop(treeOf(model, row).coordinates[row.element], row.kind)) {
      putStop(model, state, slot, row, scratch);
    }
  }
}

void fillBrake(const JointRowScratch& row, double* q, double* r) {
  q[kNormalRow] = -row.grip * row.limit;
  r[kNormalRow] = row.limit;
}

void noteStopHits(const WorldModel& model, WorldScratch& scratch) {
  for (std::size_t slot = 0; slot < scratch.joint_rows.size(); ++slot) {
    const JointRowScratch& row = scratch.joint_rows[slot];
    if (row.hit == JointRowScratch::Hit::kNone || scratch.impact_pairs.size() == scratch.impact_pairs.capacity()) continue;
    const int body = treeOf(model, row).links[treeOf(model, row).coordinates[row.element].link].body;
    scratch.impact_pairs.push_back({body, body, row.hit == JointRowScratch::Hit::kLands, static_cast<int>(slot)});
  }
}

double timeOfStop(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, const JointRowScratch& row) {
  const StopGap gap = gapOf(model, state, scratch, row, 1);
  const double h = scratch.h, phi = gap.mid - 0.5 * h * gap.rate;
  if (scratch.trees[row.tree].closing) return gap.end < 0 ? h * phi / (phi - gap.end) : std::numeric_limits<double>::infinity();
  const double bent = gap.end - phi - h * gap.rate;  // phi(t) = phi + t rate + (t/h)^2 bent
  const double root2 = gap.rate * gap.rate * h * h - 4 * bent * phi;
  if (root2 < 0) return std::numeric_limits<double>::infinity();
  // The first root, by the form that doesn't cancel.
  const double root = std::sqrt(root2), s = gap.rate < 0 ? 2 * phi / (root - h * gap.rate)
                                            : bent < 0   ? (root + h * gap.rate) / (-2 * bent)
                                                         : 2.0;
  return s <= kLate ? std::max(s, 0.0) * h : std::numeric_limits<double>::infinity();
}

bool reviseJointRows(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  bool is_wrong = false;
  for (JointRowScratch& row : scratch.joint_rows) {
    if (row.tree < 0) continue;
    if (row.kind == JointRowKind::kDrive) {
      is_wrong = reviseDrive(model, state, row, scratch) || is_wrong;
    } else if (row.kind == JointRowKind::kFriction) {
      is_wrong = reviseFriction(model, row, scratch) || is_wrong;
    } else if (!row.wanted && row.hit == JointRowScratch::Hit::kNone && hasStop(treeOf(model, row).coordinates[row.element], row.kind) &&
               gapOf(model, state, scratch, row, 1).end < -kAtStop) {
      is_wrong = row.wanted = true;
    }
  }
  return is_wrong;
}

void addAlong(const WorldModel& model, const JointRowScratch& row, double impulse, TreeScratch& s) {
  const TreeModel& tree = treeOf(model, row);
  const auto add = [&](int coordinate, double factor) {
    s.impulse[tree.coordinates[coordinate].column] += s.course.mid.coordinates[coordinate].share * factor * impulse;
  };
  if (row.kind != JointRowKind::kDrive) return add(row.element, row.kind == JointRowKind::kUpper ? -1 : 1);
  for (const TreeDrive::Term& term : tree.drives[row.element].terms) add(term.coordinate, term.factor);
}

int scaledRow(const WorldModel& model, const JointRowScratch& row, TreeScratch& s) {
  const TreeModel& tree = treeOf(model, row);
  std::fill(s.row.begin(), s.row.end(), 0.0);
  int tip = -1;
  const auto add = [&](int coordinate, double factor) {
    const int column = tree.coordinates[coordinate].column;
    s.row[column] += factor * s.course.mid.coordinates[coordinate].share;
    tip = std::max(tip, column);
  };
  if (row.kind != JointRowKind::kDrive) {
    add(row.element, row.kind == JointRowKind::kUpper ? -1 : 1);
  } else {
    for (const TreeDrive::Term& term : tree.drives[row.element].terms) add(term.coordinate, term.factor);
  }
  scaleRow(tree, s.course.factor, tip, s.row);
  return tip;
}

void rememberJointRows(const WorldModel& model, WorldState& state, WorldScratch& scratch) {
  for (const JointRowScratch& row : scratch.joint_rows) {
    if (row.tree < 0 || !row.isBrake()) continue;
    const TreeModel& tree = treeOf(model, row);
    const TreeScratch& s = scratch.trees[row.tree];
    const double r = row.touched ? row.impulse_W.x() : 0, full = (1 - kRoundOff) * row.limit;
    if (row.kind == JointRowKind::kDrive) {
      const int d = tree.drives[row.element].drive;
      DriveScratch& now = scratch.drives[d];
      if (row.wanted) {
        now.mode = r >= full ? DriveMemory::kHigh : r <= -full ? DriveMemory::kLow : DriveMemory::kWithin;
        now.force = r / scratch.h + middleOf(model.drives[d]);
      }
      state.drives[d] = now.mode;
      state.controls[d] = now.input;
      continue;
    }
    const double rate = endRate(tree, s, row.element);
    const bool slips = row.wanted ? std::abs(r) >= full && rate * r < 0 : s.constant[row.element] != 0;
    BrakeMemory& memory = state.brakes[tree.first_coordinate + row.element];
    memory = !slips ? BrakeMemory::kHolds : rate > 0 ? BrakeMemory::kForward : BrakeMemory::kBackward;
  }
}

JointReport jointAt(const WorldModel& model, const WorldScratch& scratch, int joint) {
  JointReport report;
  const JointPlace& place = model.joint_places[joint];
  if (place.tree < 0 || !(scratch.h > 0)) return report;
  const TreeModel& tree = model.trees[place.tree];
  const auto forceOf = [&](JointRowKind kind) {
    const JointRowScratch& row = scratch.joint_rows[slotOf(tree, place.coordinate, kind)];
    return row.wanted && row.touched ? (row.isBrake() ? row.impulse_W.x() : row.impulse_W.z()) / scratch.h : 0.0;
  };
  const double lower = forceOf(JointRowKind::kLower), upper = forceOf(JointRowKind::kUpper);
  report.stop_force = lower - upper;
  report.at_lower = lower > 0;
  report.at_upper = upper > 0;
  report.friction_force = forceOf(JointRowKind::kFriction) + scratch.trees[place.tree].constant[place.coordinate];
  return report;
}

DriveReport driveAt(const WorldScratch& scratch, int drive) {
  const DriveScratch& now = scratch.drives[drive];
  return {hasLaw(now.law) ? now.force : now.law.force, now.mode == DriveMemory::kLow || now.mode == DriveMemory::kHigh};
}

}  // namespace pincer::engine
