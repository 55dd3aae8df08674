#include "pincer/engine/world/link_contacts.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numeric>

#include "pincer/engine/tree/sparse_ldl.h"
#include "pincer/engine/tree/tree_kinematics.h"
#include "pincer/engine/world/contact_rows.h"

namespace pincer::engine {
namespace {

bool isBody(const Side& side) { return side.kind == SideKind::kBody; }
bool isLed(const WorldModel& model, const Side& side) { return isBody(side) && !model.bodies[side.index].dynamic; }
bool isLink(const WorldModel& model, const Side& side) { return isBody(side) && model.bodies[side.index].tree >= 0; }
bool areOfOneTree(const WorldModel& model, const Contact& c) {
  return isLink(model, c.a) && isLink(model, c.b) && model.bodies[c.a.index].tree == model.bodies[c.b.index].tree;
}

struct SideAlong {
  const Side& side;
  Vec3 n_W;
};

using SidesAlong = std::initializer_list<SideAlong>;

// The square of a row of A: of the velocity of these sides of a contact, of one tree, each along its own direction.
double squareOfRow(const WorldModel& model, WorldScratch& scratch, const Contact& c, SidesAlong parts) {
  const int number = model.bodies[parts.begin()->side.index].tree;
  const TreeModel& tree = model.trees[number];
  TreeScratch& s = scratch.trees[number];
  std::fill(s.row.begin(), s.row.end(), 0.0);
  for (const SideAlong& part : parts) {
    const int link = model.bodies[part.side.index].link;
    const Vec3 p_OX = s.course.mid.links[link].p_OL + (c.p_W - scratch.bodies[part.side.index].X_WI_mid.p);
    addJacobian(tree, s.course.mid, link, p_OX, part.n_W, Vec3::Zero(), s.row);
  }
  scaleWholeRow(tree, s.course.factor, s.row);
  return std::inner_product(s.row.begin(), s.row.end(), s.row.begin(), 0.0);
}

// s; 1 where a side is neither a link nor stands still or is led.
double shareAlongNormal(const WorldModel& model, WorldScratch& scratch, const Contact& c) {
  const auto is_held = [&](const Side& side) { return isLed(model, side) || isLink(model, side); };
  if (!is_held(c.a) || !is_held(c.b)) return 1;
  double along2 = 0, all2 = 0;
  for (const Side* side : {&c.a, &c.b}) {
    if (!isLink(model, *side)) continue;
    for (int k = 0; k < 3; ++k) all2 += squareOfRow(model, scratch, c, {{*side, Vec3::Unit(k)}});
    along2 += squareOfRow(model, scratch, c, {{*side, c.n_W()}});
  }
  if (areOfOneTree(model, c)) along2 = squareOfRow(model, scratch, c, {{c.a, c.n_W()}, {c.b, -c.n_W()}});
  return all2 > 0 ? std::sqrt(along2 / all2) : 0;
}

// How fast the innermost link that carries both turns at the start [rad/s].
Vec3 turnOfCarrier(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  const TreeModel& tree = model.trees[model.bodies[c.a.index].tree];
  int a = model.bodies[c.a.index].link, b = model.bodies[c.b.index].link;
  while (a != b) {
    int& outer = a > b ? a : b;  // parents come first
    outer = tree.links[outer].parent;
  }
  if (a >= 0) return scratch.bodies[tree.links[a].body].start.w_W;
  return scratch.trees[model.bodies[c.a.index].tree].base.start.motion.w_W;
}

double turnWithCarrier(const WorldModel& model, const WorldScratch& scratch, const Contact& c) {
  const Vec3 w_W = turnOfCarrier(model, scratch, c), &w_a_W = c.mover_a->start.w_W, &w_b_W = c.mover_b->start.w_W;
  const Vec3 v_W = c.R_WC * c.v_start_C.head<3>();
  const Vec3 way_W = w_W.cross(2 * v_W - w_a_W.cross(c.arm_a_W) + w_b_W.cross(c.arm_b_W)) -
                     (w_a_W - w_W).cross(w_W.cross(c.arm_a_W)) + (w_b_W - w_W).cross(w_W.cross(c.arm_b_W));
  return 0.5 * scratch.h * c.n_W().dot(way_W);
}

bool knowsItsTurn(const Contact& c) { return c.memory && c.memory->active && !c.memory->closing; }

}  // namespace

void leaveOutGrazingLinks(const WorldModel& model, WorldScratch& scratch) {
  const double least = std::numeric_limits<double>::epsilon() / model.options.solver.tolerance;
  std::erase_if(scratch.contacts, [&](const Contact& c) { return shareAlongNormal(model, scratch, c) <= least; });
}

void adjustLinkContacts(const WorldModel& model, WorldScratch& scratch) {
  for (std::size_t i = 0; i < scratch.contacts.size(); ++i) {
    Contact& c = scratch.contacts[i];
    if (c.a.kind == SideKind::kJoint) continue;
    double bias = c.bias_C[kNormalRow];
    if (areOfOneTree(model, c) && !knowsItsTurn(c)) bias -= turnWithCarrier(model, scratch, c);
    if (bias < 0) bias = std::max(bias, -kLargestCorrection * shareAlongNormal(model, scratch, c));
    scratch.q[static_cast<std::size_t>(scratch.first_row[i] + kNormalRow)] += bias - c.bias_C[kNormalRow];
    c.bias_C[kNormalRow] = bias;
  }
}

}  // namespace pincer::engine
