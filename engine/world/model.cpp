#include "pincer/engine/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/world/axis_form.h"
#include "pincer/engine/world/body_model.h"
#include "pincer/engine/world/broad_phase.h"
#include "pincer/engine/world/colliders.h"
#include "pincer/engine/world/joint_groups.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/most_numbered.h"
#include "pincer/engine/world/tree_builder.h"

namespace pincer::engine {
namespace {

bool comesBefore(const PairModel& x, const PairModel& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); }

// Of several for the same two bodies the last one stays.
void sortSpecialPairs(std::vector<PairModel>& pairs) {
  std::stable_sort(pairs.begin(), pairs.end(), comesBefore);
  const auto isSame = [](const PairModel& x, const PairModel& y) { return !comesBefore(x, y) && !comesBefore(y, x); };
  pairs.erase(pairs.begin(), std::unique(pairs.rbegin(), pairs.rend(), isSame).base());
}

using IndexPair = std::pair<int, int>;

// How many others of those that `counts` each body can meet: one of the two moves, and the pair isn't excluded.
// Counted, not listed: of thousands of bodies there are millions of pairs.
template <class Counts>
std::vector<int> partnersOf(const WorldModel& model, const std::vector<IndexPair>& excluded, const Counts& counts) {
  const int n = static_cast<int>(model.bodies.size());
  int all = 0, moving = 0;
  for (const BodyModel& body : model.bodies) {
    if (!counts(body)) continue;
    ++all;
    if (body.dynamic) ++moving;
  }
  std::vector<int> partners(model.bodies.size(), 0);
  for (int i = 0; i < n; ++i) {
    const BodyModel& body = model.bodies[i];
    if (counts(body)) partners[i] = body.dynamic ? all - 1 : moving;
  }
  for (const auto& [a, b] : excluded) {
    if (a < 0 || b >= n || a == b || !counts(model.bodies[a]) || !counts(model.bodies[b])) continue;
    if (!model.bodies[a].dynamic && !model.bodies[b].dynamic) continue;
    --partners[a];
    --partners[b];
  }
  return partners;
}

// Marks the bodies that something can touch, and prepares the meshes that are touched
// as flat triangles (contact::preparePair).
void findWhoMayTouch(WorldModel& model, const std::vector<IndexPair>& excluded) {
  const auto any = [](const BodyModel&) { return true; };
  const auto is_flat = [](const ColliderModel& c) {
    return !isSupport(c.shape) && !std::holds_alternative<contact::Sphere>(c.shape);
  };
  const auto has_flat = [&](const BodyModel& body) {
    const auto shapes = collidersOf(model, body);
    return std::any_of(shapes.begin(), shapes.end(), is_flat);
  };
  const std::vector<int> partners = partnersOf(model, excluded, any),
                         flat_partners = partnersOf(model, excluded, has_flat);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    BodyModel& body = model.bodies[i];
    body.may_touch = body.may_touch || partners[i] > 0;
    if (flat_partners[i] == 0) continue;
    for (const ColliderModel& c : collidersOf(model, body)) contact::preparePair(c.shape, c.shape);
  }
}

}  // namespace

Material materialOf(const WorldModel& model, const ColliderModel& a, const ColliderModel& b) {
  PINCER_ASSERT(a.body < b.body);  // the special pairs are sorted so
  const PairModel pair{a.body, b.body, {}, false};
  const auto own = std::lower_bound(model.special_pairs.begin(), model.special_pairs.end(), pair, comesBefore);
  if (own != model.special_pairs.end() && !comesBefore(pair, *own)) return own->material;
  return combine(a.material, b.material, model.options.combination);
}

Material materialOf(const WorldModel& model, int a, int b) {
  PINCER_ASSERT(a < b);  // as above
  return materialOf(model, model.colliders[model.bodies[a].first_collider],
                    model.colliders[model.bodies[b].first_collider]);
}

Material combine(const Material& a, const Material& b, Combination rule) {
  const bool is_maximum = rule == Combination::kMaximum;
  Material m;
  m.mu_s = is_maximum ? std::max(a.mu_s, b.mu_s) : std::sqrt(a.mu_s * b.mu_s);
  m.mu_d = std::min(m.mu_s, is_maximum ? std::max(a.mu_d, b.mu_d) : std::sqrt(a.mu_d * b.mu_d));
  m.restitution = std::sqrt(a.restitution * b.restitution);
  m.torsion_radius = std::max(a.torsion_radius, b.torsion_radius);
  m.rolling_radius = std::max(a.rolling_radius, b.rolling_radius);
  m.stribeck_speed = std::max(a.stribeck_speed, b.stribeck_speed);
  return m;
}

double slidingFriction(const Material& m, double speed) {
  PINCER_ASSERT(m.mu_d <= m.mu_s);
  if (m.stribeck_speed <= 0 || m.mu_d == m.mu_s) return m.mu_d;
  const double ratio = speed / m.stribeck_speed;
  return m.mu_d + (m.mu_s - m.mu_d) * math::exp(-ratio * ratio);
}

namespace {

// Every pair of bodies that can meet.
void listPairs(WorldModel& model, const std::vector<IndexPair>& excluded) {
  const int n = static_cast<int>(model.bodies.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (!model.bodies[a].dynamic && !model.bodies[b].dynamic) continue;
      if (std::binary_search(excluded.begin(), excluded.end(), IndexPair(a, b)) || !mayTouch(model, a, b)) continue;
      const bool is_of_many = model.bodies[a].collider_count + model.bodies[b].collider_count > 2;
      model.pairs.push_back({a, b, materialOf(model, a, b), is_of_many});
    }
  }
}

// Most contacts of a body's own: those of a brick in a wall, of a ball in a heap, and near misses.
int contactsOf(const contact::Shape& shape) {
  if (std::holds_alternative<contact::Sphere>(shape)) return 8;
  return std::holds_alternative<contact::Capsule>(shape) ? 10 : 24;
}

// Bits that tell the shapes of any one body apart; what is left of an identity's number must tell the bodies apart.
int shapeBits(const WorldModel& model) {
  int most = 1, bits = 0;
  for (const BodyModel& body : model.bodies) most = std::max(most, body.collider_count);
  while (1 << bits < most) ++bits;
  const int bodies = static_cast<int>(model.bodies.size());
  if (bits <= kNumberBits && bodies <= kMostNumbered >> bits) return bits;
  throw InputError(fmt::format(
      "{} bodies, of which one has {} shapes: contacts can tell apart {} bodies of so many shapes, {} in all. Use "
      "fewer shapes per body, or several worlds.",
      bodies, most, kMostNumbered >> std::min(bits, kNumberBits), kMostNumbered));
}

// Of the whole scene; the fewest are those of a hand-sized one.
int contactCapacity(const WorldModel& model) {
  constexpr std::int64_t kFewest = 64, kPerPoint = 8;  // contacts: of a scene without bodies, and of each point
  std::int64_t sum = kFewest + kPerPoint * std::ssize(model.points);
  for (const ColliderModel& c : model.colliders) sum += model.bodies[c.body].dynamic ? contactsOf(c.shape) : 0;
  return static_cast<int>(std::min<std::int64_t>(sum, kMostContacts));
}

}  // namespace

WorldBuilder::WorldBuilder(const WorldOptions& options) {
  requireRange("tick", options.h, 1e-5, 1e-2, "The tick is in seconds; 0.001 is the usual one.");
  requireRange("contact_margin", options.contact_margin, 1e-9, 1, "It is in metres; 0.001 suits hand-sized bodies.");
  if (options.max_contacts != 0)
    requireRange("max_contacts", options.max_contacts, 4, kMostContacts,
                 "0 takes as many as the bodies of the scene may well have.");
  requireRange("threads", options.threads, 1, 16, "1 suits hand-sized scenes; more pay where many heaps lie apart.");
  if (options.solver.accuracy != 0)
    requireRange("solver.accuracy", options.solver.accuracy, 1e-12, 1,
                 "In m/s: 1e-6 is the usual one, 0 is exact, 1e-3 suits heaps that are only looked at.");
  requireRange("solver.tolerance", options.solver.tolerance, 1e-14, 1e-2, "1e-10 is the usual one.");
  if (options.solver.budget != 0)
    requireRange("solver.budget", options.solver.budget, 1e-6, 10,
                 "In seconds; half a tick leaves time for everything else.");
  if (options.position_tolerance != 0)
    requireRange("position_tolerance", options.position_tolerance, 1e-12, 1,
                 "In metres; 1e-6 is a micrometre per tick.");
  requireRange("max_parts", options.max_parts, 2, 1024, "16 suits a tick of a millisecond.");
  if (!options.gravity_W.allFinite())
    throw InputError("gravity isn't finite. Give three numbers in m/s^2, for example [0, 0, -9.81].");
  model_.options = options;
}

int WorldBuilder::addBody(const BodySpec& spec) {
  if (model_.bodies.size() == kMostNumbered)
    throw InputError(fmt::format(
        "body \"{}\": the world has {} bodies already, the most that its contacts can tell apart. Use several worlds.",
        spec.name, kMostNumbered));
  if (spec.driven && spec.dynamic)
    throw InputError(fmt::format("body \"{}\": it can't be both dynamic and driven. Choose one.", spec.name));
  const int number = static_cast<int>(model_.bodies.size());
  std::vector<ColliderModel> colliders = collidersFor(spec, number);
  BodyModel body = bodyFor(spec, colliders, model_.options.contact_margin);
  body.first_collider = static_cast<int>(model_.colliders.size());
  if (spec.driven) body.motion = model_.driven_count++;
  model_.bodies.push_back(std::move(body));
  std::move(colliders.begin(), colliders.end(), std::back_inserter(model_.colliders));
  return number;
}

int WorldBuilder::addPoint(const DrivenPointModel& point) {
  if (model_.points.size() == kMostNumbered)
    throw InputError(
        fmt::format("{}: the world has {} driven points already, the most that its contacts can tell apart.",
                    point.name, kMostNumbered));
  requireRange(point.name + ".mass", point.mass, 0, 1e6, "A proxy's mass is zero or positive, in kilograms.");
  requireRange(point.name + ".twist_stiffness", point.twist_stiffness, 0, 1e6,
               "In N m/rad; a fingertip has about 0.3.");
  requireRange(point.name + ".twist_damping", point.twist_damping, 0, 1e6, "In N m s/rad; 0.001 suits a fingertip.");
  requireRange(point.name + ".turn_stiffness", point.turn_stiffness, 0, 1e6,
               "In N m/rad; a gripper's finger has about 50.");
  requireRange(point.name + ".turn_damping", point.turn_damping, 0, 1e6,
               "In N m s/rad; a thousandth of the stiffness damps it within some ticks.");
  if (point.turn_stiffness + point.turn_damping > 0 && point.twist_stiffness + point.twist_damping > 0)
    throw InputError(
        point.name +
        ": it turns against a spring about every axis (turn_stiffness) and twists against another. Keep one.");
  for (int axis = 0; axis < 3; ++axis) {
    requireRange(fmt::format("{}.stiffness[{}]", point.name, axis), point.stiffness[axis], 0, 1e9,
                 "In N/m; 1000 suits a fingertip.");
    requireRange(fmt::format("{}.damping[{}]", point.name, axis), point.damping[axis], 0, 1e6,
                 "In N s/m; 5 suits a fingertip.");
    if (!point.locked[axis] && point.mass <= 0 && point.stiffness[axis] <= 0) {
      throw InputError(
          fmt::format("{}: axis {} has neither mass nor stiffness, so nothing says how it moves. Give it a mass, a "
                      "stiffness, or lock it.",
                      point.name, axis));
    }
  }
  model_.points.push_back(point);
  return static_cast<int>(model_.points.size()) - 1;
}

void WorldBuilder::excludePair(int a, int b) {
  PINCER_DEMAND(isIndex(a, model_.bodies.size()) && isIndex(b, model_.bodies.size()),
                "excludePair: add both bodies first");
  excluded_.emplace_back(std::min(a, b), std::max(a, b));
}

void WorldBuilder::setPairMaterial(int a, int b, const Material& material) {
  PINCER_DEMAND(isIndex(a, model_.bodies.size()) && isIndex(b, model_.bodies.size()),
                "setPairMaterial: add both bodies first");
  checkMaterial(fmt::format("pair {} and {}", model_.bodies[static_cast<std::size_t>(a)].name,
                            model_.bodies[static_cast<std::size_t>(b)].name),
                material);
  model_.special_pairs.push_back({std::min(a, b), std::max(a, b), material, false});
}

WorldModel WorldBuilder::build() const {
  WorldModel model = model_;
  sortSpecialPairs(model.special_pairs);
  groupJoints(model);
  findTrees(couplings_, model);
  model.shape_bits = shapeBits(model);
  for (const ColliderModel& c : model.colliders) model.bounces = model.bounces || c.material.restitution > 0;
  for (const PairModel& pair : model.special_pairs) model.bounces = model.bounces || pair.material.restitution > 0;
  for (const DrivenPointModel& point : model.points) model.point_forms.push_back(axisFormsOf(point, model.options.h));
  const int n = static_cast<int>(model.bodies.size());
  model.has_broad_phase = n > kAllPairsBodies;
  const auto has_corners = [](const BodyModel& body) { return body.dynamic && body.corner_reach > 0; };
  model.has_corners = std::any_of(model.bodies.begin(), model.bodies.end(), has_corners);
  const auto may_be_hollow = [](const BodyModel& body) { return body.may_be_hollow; };
  model.has_hollows = !model.points.empty() && std::any_of(model.bodies.begin(), model.bodies.end(), may_be_hollow);
  std::vector<IndexPair> excluded = excluded_;
  std::sort(excluded.begin(), excluded.end());
  excluded.erase(std::unique(excluded.begin(), excluded.end()), excluded.end());
  findWhoMayTouch(model, excluded);
  if (model.has_broad_phase) {
    model.excluded_pairs = std::move(excluded);
  } else {
    listPairs(model, excluded);
  }
  if (!model.points.empty()) {
    for (BodyModel& body : model.bodies) body.may_touch = true;
  }
  checkGroups(model);
  findTouchedTrees(model);
  if (model.options.max_contacts == 0) model.options.max_contacts = contactCapacity(model);
  model.options.max_contacts = std::min(model.options.max_contacts + jointRowsOf(model), kMostContacts);
  return model;
}

}  // namespace pincer::engine
