#include "pincer/engine/world/tree_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/tree/speed_limit.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/fine_course.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/rest.h"

namespace pincer::engine {
namespace {

bool isDriven(const WorldModel& model, const TreeModel& tree) {
  return tree.base >= 0 && model.bodies[tree.base].driven;
}

TreeBase baseNow(const WorldModel& model, const WorldState& state, const TreeModel& tree) {
  if (tree.base < 0) return {};
  const BodyState& s = state.bodies[tree.base];
  TreeBase base{s.X_WI, {}};
  if (isDriven(model, tree)) base.motion = {s.v_W, state.driven_w_W[model.bodies[tree.base].motion]};
  return base;
}

// The middle of a driven base is predicted as that of all driven bodies is.
BaseCourse baseCourse(const WorldModel& model, const WorldState& state, const WorldScratch& scratch,
                      const TreeModel& tree) {
  const TreeBase start = baseNow(model, state, tree);
  if (!isDriven(model, tree)) return {start, start, start};
  const BodyScratch& body = scratch.bodies[tree.base];
  const Vec3 a_W = (body.free.v_W - body.start.v_W) / scratch.h, alpha_W = (body.free.w_W - body.start.w_W) / scratch.h;
  const Motion mean{0.5 * (body.start.v_W + body.free.v_W), 0.5 * (body.start.w_W + body.free.w_W)};
  return {{start.X_WB, body.start, a_W, alpha_W},
          {body.X_WI_mid, mean, a_W, alpha_W},
          {body.X_WB_end, body.free, a_W, alpha_W}};
}

void takeForces(const WorldScratch& scratch, const TreeModel& tree, TreeScratch& s) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const BodyForce* const force = forceOn(scratch, static_cast<std::size_t>(tree.links[l].body));
    s.forces[l] = force ? LinkForce{force->f_W, force->tau_W} : LinkForce{};
  }
}

// Fills a link's motions: `free` only if something can touch it.
void showLink(const WorldModel& model, const WorldState& state, const TreeModel& tree, int l, const TreeScratch& s,
              BodyScratch& out) {
  const int body = tree.links[l].body;
  out.X_WI_mid = linkPose(s.course.mid, l);
  out.start = {state.bodies[body].v_W, bodyAngularVelocity(model, state, body)};
  out.free_angular_impulse_W.setZero();
  if (!tree.may_touch) return;
  out.X_WB_mid = out.X_WI_mid * model.bodies[body].X_IB;
  out.R_WB_mid = out.X_WB_mid.q.toRotationMatrix();
  out.free = out.end = s.course.end.links[l].motion;
  out.inverse_inertia_W = inverseInertia(model.bodies[body].rotation, out.X_WI_mid.q);
}

BodyState stateOf(const WorldModel& model, const TreeModel& tree, const TreePlace& place, int l) {
  const BodyModel& body = model.bodies[tree.links[l].body];
  const Motion& motion = place.links[l].motion;
  const Pose X_WI = linkPose(place, l);
  return {X_WI, motion.v_W, X_WI.q * body.moments.cwiseProduct(X_WI.q.conjugate() * motion.w_W)};
}

// The motion of a link's centre in the middle that rates `u` give, the base at rest.
Motion motionBy(const TreeModel& tree, const TreePlace& place, int l, std::span<const double> u) {
  Motion sum;
  forEachCoordinateOf(tree, l, [&](std::size_t i) {
    const Motion unit = unitMotion(tree, place, i, place.links[l].p_OL);
    const double rate = place.coordinates[i].share * u[tree.coordinates[i].column];
    sum.v_W += rate * unit.v_W;
    sum.w_W += rate * unit.w_W;
  });
  return sum;
}

void gatherMover(const MoverScratch& mover, TreeScratch& s) {
  if (!mover.touched) return;
  s.rest_speed = s.touched ? std::min(s.rest_speed, mover.rest_speed) : mover.rest_speed;
  s.touched = true;
  s.closing = s.closing || mover.closing;
}

// Gives each link the impulses that would move it so if it were alone.
void showAnswer(const WorldModel& model, const TreeModel& tree, const TreeScratch& s, WorldScratch& scratch) {
  for (int l = 0; l < static_cast<int>(tree.links.size()); ++l) {
    const int i = tree.links[l].body;
    BodyScratch& body = scratch.bodies[i];
    const Motion gained = motionBy(tree, s.course.mid, l, s.gained);
    body.impulse_W = model.bodies[i].mass * gained.v_W;
    const Quat& q_WI = body.X_WI_mid.q;
    body.angular_impulse_W = q_WI * model.bodies[i].moments.cwiseProduct(q_WI.conjugate() * gained.w_W);
    body.touched = true;
    body.closing = s.closing;
  }
}

// True if neither contacts nor joints' own rows can push on it: then its free course needn't be the one in which M^
// answers them. At rest the two must agree to the last bit, or what holds a load feels less than it.
bool movesAlone(const TreeModel& tree) {
  return !tree.may_touch && std::none_of(tree.coordinates.begin(), tree.coordinates.end(), [](const TreeCoordinate& c) {
    return c.traits.friction > 0 || std::isfinite(c.traits.lower) || std::isfinite(c.traits.upper);
  });
}

// True if a hinge, a ball or a link turns by more than `most` in this part of the tick.
bool turnsBy(double most, const TreeModel& tree, const TreeScratch& s, std::span<const double> u, double h) {
  for (const TreeCoordinate& own : tree.coordinates) {
    if (tree.links[own.link].kind == JointKind::kSlider) continue;
    const double start = u[own.column], end = s.course.u_free[own.column] + s.gained[own.column];
    if (!(h * std::max(std::abs(start), std::abs(end)) <= most)) return true;
  }
  const double most2 = most * most / (h * h);
  return std::any_of(s.course.mid.links.begin(), s.course.mid.links.end(),
                     [most2](const LinkPlace& link) { return link.motion.w_W.squaredNorm() > most2; });
}

// True if nothing but its own stops, brakes and drives pushes on it, and it turns fast: then their impulses give it no
// energy, but the turn of their directions within the tick would.
bool isWhirledByStops(const TreeModel& tree, const TreeScratch& s, std::span<const double> u, double h) {
  const auto pushes = [](char pressed) { return pressed != 0; };
  return s.touched && !s.course.fine && std::none_of(s.pressed.begin(), s.pressed.end(), pushes) &&
         turnsBy(kFastTurn, tree, s, u, h);
}

// The most that drives at their limits add to a tree's speed in the metric of M.
double givenByDrives(const WorldScratch& scratch, int tree) {
  double sum = 0;
  for (const JointRowScratch& row : scratch.joint_rows) {
    if (row.tree == tree && row.kind == JointRowKind::kDrive && row.wanted) sum += row.limit * std::sqrt(row.mobility);
  }
  return sum;
}

bool isSlow(const Motion& m, double reach, double limit) {
  return m.v_W.squaredNorm() <= limit * limit && reach * reach * m.w_W.squaredNorm() <= limit * limit;
}

// A tree that hardly moves, now and a tick ago, that nothing leads elsewhere, and on which
// nothing pushes but impulses of the last tick.
bool comesToRest(const WorldModel& model, const WorldScratch& scratch, const TreeModel& tree, const TreeScratch& s) {
  const double limit = s.touched ? s.rest_speed : kRestSpeed;
  if (limit == 0 || isDriven(model, tree)) return false;
  const auto leads = [](const DriveTick& drive) { return drive.way != 0 || drive.end_rate != 0; };
  if (std::any_of(s.drives.begin(), s.drives.end(), leads)) return false;
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const BodyModel& body = model.bodies[tree.links[l].body];
    const double reach = std::min(body.bounding_radius, 1.0) + (tree.links[l].X_LJ.p).norm();
    if (!isSlow(s.course.end.links[l].motion, reach, limit) ||
        !isSlow(scratch.bodies[tree.links[l].body].start, reach, limit))
      return false;
  }
  return true;
}

// Adds the impulse that a contact of the last part of a tick gave a link of it, for a part `share` times as long.
void expectContact(const ContactMemory& c, const BodyModel& link, double sign, const Vec3& arm_W, double share,
                   WorldScratch& scratch) {
  if (link.tree < 0) return;
  TreeScratch& s = scratch.trees[link.tree];
  s.was_pressed = true;
  // A landing gave more than the contact will, and moments of torsion and rolling would need its radii.
  if (c.closing || !c.r.tail<kMaxContactRows - kPointRows>().isZero(0)) s.is_expected = false;
  const Vec3 f_W = sign * share * (c.r[0] * c.t1_W + c.r[1] * c.n_W.cross(c.t1_W) + c.r[2] * c.n_W);
  LinkForce& sum = s.expected[link.link];
  sum.f_W += f_W;
  sum.tau_W += arm_W.cross(f_W);
}

// Which trees contacts, stops or brakes pushed on in the last part of a tick, and by how much if it was contacts alone.
void notePressed(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  for (TreeScratch& s : scratch.trees) {
    s.was_pressed = false;
    s.is_expected = state.h_last > 0;
    std::fill(s.expected.begin(), s.expected.end(), LinkForce{});
  }
  const double share = state.h_last > 0 ? scratch.h / state.h_last : 0;
  for (int k = 0; k < state.contact_count; ++k) {
    const ContactMemory& c = state.contacts[k];
    if (!c.active) continue;
    const ContactOwners owners = ownersOf(model.shape_bits, c.id);
    if (owners.row >= 0 && scratch.joint_rows[owners.row].tree >= 0) {
      TreeScratch& s = scratch.trees[scratch.joint_rows[owners.row].tree];
      s.was_pressed = true;
      s.is_expected = false;
    }
    if (owners.a >= 0) expectContact(c, model.bodies[owners.a], 1, c.arm_a_W, share, scratch);
    if (owners.b >= 0) expectContact(c, model.bodies[owners.b], -1, c.arm_b_W, share, scratch);
  }
  for (TreeScratch& s : scratch.trees) s.is_expected = s.is_expected && s.was_pressed;
}

}  // namespace

TreeScratch::TreeScratch(const TreeModel& tree)
    : drives(tree.drives.size()),
      forces(tree.links.size()),
      constant(tree.coordinates.size()),
      course(tree),
      expected(tree.links.size()) {
  for (std::vector<double>* columns : {&impulse, &gained, &row, &held, &old_free, &old_way})
    columns->resize(static_cast<std::size_t>(tree.columnCount()));
  for (std::vector<char>* columns : {&locked, &pressed}) columns->resize(static_cast<std::size_t>(tree.columnCount()));
  q.resize(static_cast<std::size_t>(tree.q_count));
}

TreePush pushOn(const WorldScratch& scratch, const TreeModel& tree, const TreeScratch& s) {
  return {.gravity_W = scratch.gravity_W,
          .forces = scratch.forces.empty() ? std::span<const LinkForce>{} : std::span<const LinkForce>(s.forces),
          .drives = s.drives,
          .constant = s.constant,
          .may_be_fine = movesAlone(tree),
          .pressed = s.was_pressed,
          .locked = s.has_locked ? std::span<const char>(s.locked) : std::span<const char>{},
          .expected = s.is_expected ? std::span<const LinkForce>(s.expected) : std::span<const LinkForce>{}};
}

void predictTrees(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  notePressed(model, state, scratch);
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const TreeModel& tree = model.trees[t];
    TreeScratch& s = scratch.trees[t];
    s.base = baseCourse(model, state, scratch, tree);
    if (!scratch.forces.empty()) takeForces(scratch, tree, s);
    const TreePush push = pushOn(scratch, tree, s);
    const std::span<const double> q = treeCoordinates(tree, state), u = treeRates(tree, state);
    predictTree(tree, s.base, push, q, u, scratch.h, s.course);
    std::fill(s.gained.begin(), s.gained.end(), 0.0);
    s.course.rough = turnsBy(kFarTurn, tree, s, u, scratch.h);
    if (s.course.rough) limitFreeCourse(tree, s.base, push, q, u, scratch.h, s.course);
    s.touched = s.closing = false;
    if (tree.may_touch) moveFreeEnd(tree, s.base, q, u, scratch.h, s.course);
    for (int l = 0; l < static_cast<int>(tree.links.size()); ++l)
      showLink(model, state, tree, l, s, scratch.bodies[tree.links[l].body]);
  }
}

void predictTreeImpacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const TreeModel& tree = model.trees[t];
    TreeScratch& s = scratch.trees[t];
    const TreeBase base = baseNow(model, state, tree);
    s.base = {base, base, base};
    placeLinks(tree, base, treeCoordinates(tree, state), s.course.mid);
    moveLinks(tree, base, treeCoordinates(tree, state), treeRates(tree, state), s.course.mid);
    fillInertia(tree, s.course.mid, s.course.composite, s.course.factor.entries);
    if (!tree.loops.empty()) fillLoops(tree, base, s.course.mid, s.course.loop_rows);
    s.course.sound = factoriseClosed(tree, s.course.loop_rows, s.course.factor);
    const std::span<const double> u = treeRates(tree, state);
    std::copy(u.begin(), u.end(), s.course.u_free.begin());
    std::fill(s.course.way_free.begin(), s.course.way_free.end(), 0.0);
    s.course.end = s.course.mid;
    for (int l = 0; l < static_cast<int>(tree.links.size()); ++l)
      showLink(model, state, tree, l, s, scratch.bodies[tree.links[l].body]);
  }
}

void gatherTrees(const WorldModel& model, WorldScratch& scratch) {
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    TreeScratch& s = scratch.trees[t];
    s.touched = s.closing = false;
    s.rest_speed = 0;
    std::fill(s.impulse.begin(), s.impulse.end(), 0.0);
    for (std::size_t l = 0; l < model.trees[t].links.size(); ++l) {
      const BodyScratch& body = scratch.bodies[model.trees[t].links[l].body];
      gatherMover(body, s);
      if (body.touched)
        addWrench(model.trees[t], s.course.mid, static_cast<int>(l), body.impulse_W, body.angular_impulse_W, s.impulse);
    }
    std::transform(s.impulse.begin(), s.impulse.end(), s.pressed.begin(),
                   [](double r) { return static_cast<char>(r != 0); });
  }
  for (const JointRowScratch& row : scratch.joint_rows) {
    if (!row.touched || row.tree < 0) continue;
    TreeScratch& s = scratch.trees[row.tree];
    gatherMover(row, s);
    addAlong(model, row, row.isBrake() ? row.impulse_W.x() : row.impulse_W.z(), s);
  }
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    TreeScratch& s = scratch.trees[t];
    s.gained = s.impulse;
    if (!s.touched) continue;
    solve(model.trees[t], s.course.factor, s.gained);
    showAnswer(model, model.trees[t], s, scratch);
  }
}

void advanceTrees(const WorldModel& model, WorldState& state, WorldScratch& scratch) {
  noteNearTrees(model, scratch);
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const TreeModel& tree = model.trees[t];
    TreeScratch& s = scratch.trees[t];
    const std::span<double> q = treeCoordinates(tree, state), u = treeRates(tree, state);
    refineCourse(model, state, scratch, static_cast<int>(t));
    const bool is_limited = s.course.rough || isWhirledByStops(tree, s, u, scratch.h);
    if (is_limited && !s.course.rough) noteMost(tree, s.base, pushOn(scratch, tree, s), q, u, scratch.h, s.course);
    const double given = is_limited ? givenByDrives(scratch, static_cast<int>(t)) : 0;
    if (s.course.rough) limitGained(tree, given, s.course, s.gained);
    advanceTree(tree, s.base.end, {s.gained, scratch.h, s.closing}, scratch.h, q, u, s.course, s.q, s.row);
    if (is_limited) limitRates(tree, s.base.end, pushOn(scratch, tree, s), s.q, given, s.course, s.row);
    s.rests = comesToRest(model, scratch, tree, s);
    if (s.rests) {
      std::fill(u.begin(), u.end(), 0.0);
    } else {
      std::copy(s.q.begin(), s.q.end(), q.begin());
      std::copy(s.row.begin(), s.row.end(), u.begin());
    }
    for (int l = 0; l < static_cast<int>(tree.links.size()); ++l) {
      const int i = tree.links[l].body;
      BodyState& body = state.bodies[i];
      if (s.rests) {
        body.v_W.setZero();
        body.L_W.setZero();
        scratch.bodies[i].end = {};
      } else {
        body = stateOf(model, tree, s.course.end, l);
        scratch.bodies[i].end = s.course.end.links[l].motion;
      }
    }
  }
}

bool treesTurnFar(const WorldModel& model, const WorldState& state, const WorldScratch& scratch) {
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    if (turnsBy(kFarTurn, model.trees[t], scratch.trees[t], treeRates(model.trees[t], state), scratch.h)) return true;
  }
  return false;
}

void strikeTrees(const WorldModel& model, WorldState& state, WorldScratch& scratch) {
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const TreeModel& tree = model.trees[t];
    TreeScratch& s = scratch.trees[t];
    if (!s.touched) continue;
    const std::span<double> u = treeRates(tree, state);
    std::copy(u.begin(), u.end(), s.row.begin());
    for (std::size_t c = 0; c < u.size(); ++c) u[c] += s.gained[c];
    if (s.course.rough) limitStruck(tree, s.row, s.course, u);
    moveLinks(tree, s.base.start, treeCoordinates(tree, state), u, s.course.mid);
    for (int l = 0; l < static_cast<int>(tree.links.size()); ++l) {
      BodyState& body = state.bodies[tree.links[l].body];
      const BodyState now = stateOf(model, tree, s.course.mid, l);
      body.v_W = now.v_W;
      body.L_W = now.L_W;
    }
  }
}

LinkMoment linkAt(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int body, double t) {
  PINCER_ASSERT(scratch.h > 0 && t >= 0);
  const TreeModel& tree = model.trees[model.bodies[body].tree];
  TreeScratch& s = scratch.trees[model.bodies[body].tree];
  TreeBase base = s.base.start;
  if (isDriven(model, tree)) {
    const DrivenPlace place =
        drivenPlace({base.X_WB, base.motion}, {s.base.end.X_WB, s.base.end.motion}, scratch.h, t / scratch.h);
    base.X_WB = place.X_WB;
    base.motion = place.motion;
  }
  advanceTree(tree, base, {s.gained, scratch.h, s.closing}, t, treeCoordinates(tree, state), treeRates(tree, state),
              s.course, s.q, s.row);
  const int l = model.bodies[body].link;
  return {linkPose(s.course.end, l), s.course.end.links[l].motion};
}

}  // namespace pincer::engine
