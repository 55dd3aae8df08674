#include "pincer/engine/world/joint_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/tree/tree_course.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/drive_rows.h"
#include "pincer/engine/world/impact.h"
#include "pincer/engine/world/joint_row_parts.h"

namespace pincer::engine {
namespace {

constexpr int kRowsPerCoordinate = 3;  // one of each JointRowKind
constexpr double kNearStop = 1e-9;     // where a hit may leave it [m, rad]
constexpr double kAtStop = 1e-12;      // [m, rad]

int slotOf(const TreeModel& tree, int coordinate, JointRowKind kind) {
  return kRowsPerCoordinate * (tree.first_coordinate + coordinate) + static_cast<int>(kind);
}

// Gap of a stop in the middle of the tick and, without contact, at its end.
struct StopGap {
  double mid, end, rate, free_rate;  // out of the stop
};
StopGap gapOf(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, const JointRowScratch& row,
              bool is_pushed) {
  const TreeModel& tree = treeOf(model, row);
  const TreeScratch& s = scratch.trees[row.tree];
  const TreeCoordinate& own = tree.coordinates[row.element];
  const double share = s.course.mid.coordinates[row.element].share, h = scratch.h;
  const double q = state.tree_q[tree.first_q + own.q], u = state.tree_v[tree.first_v + own.column];
  const double rate = share * u, free_rate = share * s.course.u_free[own.column];
  const double way =
      is_pushed ? wayOf(s.course, {s.gained, h, s.closing}, own.column, u) : s.course.way_free[own.column];
  const bool is_lower = row.kind == JointRowKind::kLower;
  const double sign = is_lower ? 1 : -1, limit = is_lower ? own.traits.lower : own.traits.upper;
  return {sign * (q + 0.5 * h * rate - limit), sign * (q + share * way - limit), sign * rate, sign * free_rate};
}

bool hasStop(const TreeCoordinate& own, JointRowKind kind) {
  return own.q >= 0 && std::isfinite(kind == JointRowKind::kLower ? own.traits.lower : own.traits.upper);
}

// Tells if the joint flies into its stop in this part of the tick, or nearly does, so fast that the tick is cut there.
JointRowScratch::Hit hitOf(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, int slot,
                           const JointRowScratch& row, const StopGap& gap) {
  using Hit = JointRowScratch::Hit;
  const double h = scratch.h, phi = gap.mid - 0.5 * h * gap.rate;
  if (scratch.stops_hit == Hit::kNone || !(h > 0) || row.wanted || !(phi > kNearStop) ||
      !(phi + kLate * h * std::min(gap.rate, gap.free_rate) < 0))
    return Hit::kNone;
  if (pushedBefore(state, idOfRow(slot))) return Hit::kNone;
  const double u = -std::sqrt(std::max(gap.rate * gap.rate - 2 * row.acceleration * phi, 0.0));
  const double restitution = treeOf(model, row).coordinates[row.element].traits.restitution;
  if (bounceRestitution(restitution, u, row.acceleration, model.options.h) > 0) return Hit::kBounces;
  // Slower it lands at the end of the tick, where it is as well.
  const bool is_hard = -u > model.options.h * std::abs(row.acceleration) && -u > kClosingSpeed;
  return is_hard && scratch.stops_hit == Hit::kLands ? Hit::kLands : Hit::kNone;
}

void putStop(const WorldModel& model, const WorldState& state, int slot, JointRowScratch& row, WorldScratch& scratch) {
  const StopGap gap = gapOf(model, state, scratch, row, false);
  if (scratch.h > 0) row.acceleration = (gap.free_rate - gap.rate) / scratch.h;
  row.hit = hitOf(model, state, scratch, slot, row, gap);
  if (row.hit != JointRowScratch::Hit::kNone) return;
  row.wanted = row.wanted || std::min(gap.mid, gap.end) <= (scratch.h > 0 ? kAtStop : kNearStop);
  if (!row.wanted) return;
  row.mobility = mobilityOf(model, row, scratch.trees[row.tree]);
  row.start = {{0, 0, gap.rate}, Vec3::Zero()};
  row.free = row.end = {{0, 0, gap.free_rate}, Vec3::Zero()};
  if (Contact* const c = addRow(gap.mid, slot, row, scratch))
    c->material.restitution = treeOf(model, row).coordinates[row.element].traits.restitution;
}

void putFriction(const WorldModel& model, const WorldState& state, int slot, JointRowScratch& row,
                 WorldScratch& scratch) {
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

// The stops of a coordinate are out of reach.
bool isAwayFromStops(const WorldState& state, const TreeModel& tree, const TreeCoordinate& own) {
  const double q = state.tree_q[tree.first_q + own.q];
  return q > own.traits.lower + kNearStop && q < own.traits.upper - kNearStop;
}

void unlock(const TreeModel& tree, TreeScratch& s, WorldScratch& scratch) {
  for (int i = 0; i < tree.coordinateCount(); ++i) {
    JointRowScratch& row = scratch.joint_rows[slotOf(tree, i, JointRowKind::kFriction)];
    row.wanted = row.wanted || row.locked;
    row.locked = false;
  }
  std::fill(s.locked.begin(), s.locked.end(), char{0});
  s.has_locked = false;
}

// Finds what holds the locked joints of a tree; unlocks them all if one is
// pushed, or would have to give more than it has.
bool reviseLocked(const WorldState& state, const TreeModel& tree, TreeScratch& s, WorldScratch& scratch) {
  if (!s.has_locked) return false;
  holdingImpulses(tree, s.course, treeRates(tree, state), s.gained, s.impulse, s.row, s.held);
  for (int i = 0; i < tree.coordinateCount(); ++i) {
    JointRowScratch& row = scratch.joint_rows[slotOf(tree, i, JointRowKind::kFriction)];
    if (!row.locked) continue;
    const int column = tree.coordinates[i].column;
    row.impulse_W = Vec3(s.held[column], 0, 0);
    if (!s.pressed[column] && std::abs(s.held[column]) <= scratch.h * tree.coordinates[i].traits.friction) continue;
    unlock(tree, s, scratch);
    return true;
  }
  return false;
}

// A brake that holds, and needs no row to do so.
bool mayLock(const WorldState& state, const TreeModel& tree, const TreeScratch& s, const JointRowScratch& row,
             double rate) {
  constexpr double kShare = 0.5, kSlow = 1e-8;  // of its force; [rad/s, m/s]
  const TreeCoordinate& own = tree.coordinates[row.element];
  return !tree.has_couplings && std::abs(row.impulse_W.x()) <= kShare * row.limit && std::abs(rate) <= kSlow &&
         !s.pressed[own.column] && isAwayFromStops(state, tree, own);
}

// A joint that was to go on in one direction turned round, or stopped.
bool reviseFriction(const WorldModel& model, JointRowScratch& row, WorldScratch& scratch) {
  TreeScratch& s = scratch.trees[row.tree];
  const double friction = s.constant[row.element];
  if (row.wanted || friction == 0 || endRate(treeOf(model, row), s, row.element) * friction < 0) return false;
  s.constant[row.element] = 0;
  return row.wanted = true;
}

}  // namespace

double mobilityOf(const WorldModel& model, const JointRowScratch& row, TreeScratch& s) {
  const TreeModel& tree = treeOf(model, row);
  double sum = 0;
  for (int c = scaledRow(model, row, s); c >= 0; c = tree.before[c]) sum += s.row[c] * s.row[c];
  return sum;
}

Contact* addRow(double phi, int slot, const JointRowScratch& row, WorldScratch& scratch) {
  Contact* const c = addContact(scratch, phi);
  if (!c) return nullptr;
  c->id = idOfRow(slot);
  c->a = {SideKind::kJoint, 0, slot};
  c->b = {SideKind::kJoint, 0, static_cast<int>(scratch.joint_rows.size()) - 1};
  c->p_W.setZero();
  c->R_WC.setIdentity();
  c->material = {};
  c->material.mu_s = c->material.mu_d = row.isBrake() ? 1 : 0;
  ++scratch.joint_contacts;
  return c;
}

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
  scratch.joint_rows.resize(static_cast<std::size_t>(kRowsPerCoordinate * model.tree_coordinate_count) +
                            model.drives.size() + 1);
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
      JointRowScratch& row =
          scratch.joint_rows[kRowsPerCoordinate * model.tree_coordinate_count + tree.drives[d].drive];
      row.kind = JointRowKind::kDrive;
      row.tree = t;
      row.element = d;
    }
  }
}

void startJointRows(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  for (JointRowScratch& row : scratch.joint_rows) {
    row.wanted = row.locked = false;
    row.hit = JointRowScratch::Hit::kNone;
  }
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const TreeModel& tree = model.trees[t];
    TreeScratch& s = scratch.trees[t];
    unlock(tree, s, scratch);
    for (std::size_t d = 0; d < tree.drives.size(); ++d) startDrive(model, state, tree.drives[d], scratch, s.drives[d]);
    for (int i = 0; i < tree.coordinateCount(); ++i) {
      const double friction = tree.coordinates[i].traits.friction,
                   u = state.tree_v[tree.first_v + tree.coordinates[i].column];
      s.constant[i] = 0;
      if (friction == 0) continue;
      const BrakeMemory memory = state.brakes[tree.first_coordinate + i];
      if (memory == BrakeMemory::kForward && u != 0) s.constant[i] = -friction;
      if (memory == BrakeMemory::kBackward && u != 0) s.constant[i] = friction;
      JointRowScratch& row = scratch.joint_rows[slotOf(tree, i, JointRowKind::kFriction)];
      row.locked =
          memory == BrakeMemory::kLocks && tree.loops.empty() && isAwayFromStops(state, tree, tree.coordinates[i]);
      row.wanted = !row.locked && s.constant[i] == 0 && scratch.h > 0;
      s.locked[tree.coordinates[i].column] = row.locked ? 1 : 0;
      s.has_locked = s.has_locked || row.locked;
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

void noteStopHits(const WorldModel& model, WorldScratch& scratch) {
  for (std::size_t slot = 0; slot < scratch.joint_rows.size(); ++slot) {
    const JointRowScratch& row = scratch.joint_rows[slot];
    if (row.hit == JointRowScratch::Hit::kNone || scratch.impact_pairs.size() == scratch.impact_pairs.capacity())
      continue;
    const int body = treeOf(model, row).links[treeOf(model, row).coordinates[row.element].link].body;
    scratch.impact_pairs.push_back({body, body, row.hit == JointRowScratch::Hit::kLands, static_cast<int>(slot)});
  }
}

double timeOfStop(const WorldModel& model, const WorldState& state, const WorldScratch& scratch,
                  const JointRowScratch& row) {
  const StopGap gap = gapOf(model, state, scratch, row, true);
  const double h = scratch.h, phi = gap.mid - 0.5 * h * gap.rate;
  if (scratch.trees[row.tree].closing)
    return gap.end < 0 ? h * phi / (phi - gap.end) : std::numeric_limits<double>::infinity();
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
  for (std::size_t t = 0; t < model.trees.size(); ++t)
    is_wrong = reviseLocked(state, model.trees[t], scratch.trees[t], scratch) || is_wrong;
  for (JointRowScratch& row : scratch.joint_rows) {
    if (row.tree < 0) continue;
    if (row.kind == JointRowKind::kDrive) {
      if (!reviseDrive(model, state, row, scratch)) continue;
      unlock(treeOf(model, row), scratch.trees[row.tree], scratch);
      is_wrong = true;
    } else if (row.kind == JointRowKind::kFriction) {
      is_wrong = reviseFriction(model, row, scratch) || is_wrong;
    } else if (!row.wanted && row.hit == JointRowScratch::Hit::kNone &&
               hasStop(treeOf(model, row).coordinates[row.element], row.kind) &&
               gapOf(model, state, scratch, row, true).end < -kAtStop) {
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
  return scaleRow(tree, s.course.factor, tip, s.row);
}

void rememberJointRows(const WorldModel& model, WorldState& state, WorldScratch& scratch) {
  for (JointRowScratch& row : scratch.joint_rows) {
    if (row.tree < 0) continue;
    if (row.kind == JointRowKind::kDrive) {
      rememberDrive(model, row, state, scratch);
      continue;
    }
    const TreeModel& tree = treeOf(model, row);
    const TreeScratch& s = scratch.trees[row.tree];
    const double rate = s.rests ? 0 : endRate(tree, s, row.element);
    row.end.v_W = row.kind == JointRowKind::kFriction ? Vec3(rate, 0, 0)
                                                      : Vec3(0, 0, row.kind == JointRowKind::kUpper ? -rate : rate);
    if (row.kind != JointRowKind::kFriction || row.locked) continue;
    const double r = row.touched ? row.impulse_W.x() : 0;
    const bool slips =
        row.wanted ? std::abs(r) >= (1 - kResidue) * row.limit && rate * r < 0 : s.constant[row.element] != 0;
    BrakeMemory& memory = state.brakes[tree.first_coordinate + row.element];
    const bool locks = !slips && row.wanted && row.touched && mayLock(state, tree, s, row, rate);
    memory = locks      ? BrakeMemory::kLocks
             : !slips   ? BrakeMemory::kHolds
             : rate > 0 ? BrakeMemory::kForward
                        : BrakeMemory::kBackward;
  }
}

JointReport jointAt(const WorldModel& model, const WorldScratch& scratch, int joint) {
  JointReport report;
  const JointPlace& place = model.joint_places[joint];
  if (place.tree < 0 || !(scratch.h > 0)) return report;
  const TreeModel& tree = model.trees[place.tree];
  const auto forceOf = [&](JointRowKind kind) {
    const JointRowScratch& row = scratch.joint_rows[slotOf(tree, place.coordinate, kind)];
    return row.locked || (row.wanted && row.touched)
               ? (row.isBrake() ? row.impulse_W.x() : row.impulse_W.z()) / scratch.h
               : 0.0;
  };
  const double lower = forceOf(JointRowKind::kLower), upper = forceOf(JointRowKind::kUpper);
  report.stop_force = lower - upper;
  report.at_lower = lower > 0;
  report.at_upper = upper > 0;
  report.friction_force = forceOf(JointRowKind::kFriction) + scratch.trees[place.tree].constant[place.coordinate];
  return report;
}

}  // namespace pincer::engine
