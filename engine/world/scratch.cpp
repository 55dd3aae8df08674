#include "pincer/engine/world/scratch.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/axis_form.h"
#include "pincer/engine/world/colliders.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/most_numbered.h"
#include "pincer/engine/world/room.h"

namespace pincer::engine {
namespace {

// A finger or body on a mesh needs some dozens of patches; a world without meshes none.
int patchesFor(const WorldModel& model) {
  const auto is_mesh = [](const ColliderModel& collider) {
    return std::holds_alternative<contact::Mesh>(collider.shape);
  };
  return std::any_of(model.colliders.begin(), model.colliders.end(), is_mesh) ? 1024 : 1;
}

bool mayIslandsSleep(const WorldModel& model) {
  return model.options.sleep &&
         std::any_of(model.bodies.begin(), model.bodies.end(), [](const BodyModel& body) { return body.dynamic; });
}

// So that copying a state into it allocates nothing.
void sizeState(const WorldModel& model, WorldState& state) {
  state.bodies.resize(model.bodies.size());
  state.points.resize(model.points.size());
  state.driven_w_W.resize(static_cast<std::size_t>(model.driven_count));
  state.contacts.resize(static_cast<std::size_t>(model.options.max_contacts));
  state.tree_q.resize(static_cast<std::size_t>(model.tree_q_count));
  state.tree_v.resize(static_cast<std::size_t>(model.tree_v_count));
  state.brakes.resize(static_cast<std::size_t>(model.tree_coordinate_count));
  state.controls.resize(model.drives.size());
  state.drives.resize(model.drives.size());
}

// True if the couplings of the points are those of the model's tick.
bool fitTheTick(const WorldModel& model) {
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    if (model.point_forms[i] != axisFormsOf(model.points[i], model.options.h)) return false;
  }
  return true;
}

// Pairs of shapes to remember: some touching pairs per shape, with room so that few share a place.
int pairsFor(const WorldModel& model) {
  constexpr std::ptrdiff_t kPerShape = 16, kMost = 1 << 16;
  const auto is_remembered = [](const ColliderModel& collider) { return !isSphere(collider); };
  const auto shapes = std::count_if(model.colliders.begin(), model.colliders.end(), is_remembered);
  return static_cast<int>(std::min(kPerShape * shapes, kMost));
}

}  // namespace

WorldSleep::WorldSleep(const WorldModel& model)
    : room(static_cast<std::size_t>(model.options.max_contacts)),
      idle(model.bodies.size()),
      group(model.bodies.size()),
      states(model.bodies.size()),
      forces(model.bodies.size()) {
  sizeState(model, rest.state);
  rest.points.resize(model.points.size());
  rest.motions.resize(static_cast<std::size_t>(model.driven_count));
  rest.forces.reserve(model.bodies.size());
  if (mayIslandsSleep(model)) makeRoom(contacts, room);
}

WorldScratch::WorldScratch(const WorldModel& model)
    : h(model.options.h),
      patches(patchesFor(model)),
      found_pairs(pairsFor(model)),
      last(model),
      islands(model),
      sleep(model) {
  PINCER_DEMAND(fitTheTick(model),
                "WorldScratch: options.h isn't the tick that the model was built for; build it again (WorldBuilder)");
  const auto contact_count = static_cast<std::size_t>(model.options.max_contacts);
  const std::size_t row_count = contact_count * kMaxContactRows;
  bodies.resize(model.bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].still = !model.bodies[i].dynamic;
  points.resize(model.points.size());
  for (PointScratch& point : points) point.has_hollows = model.has_hollows;
  makeRoom(contacts, contact_count);
  makeRoom(tried, contact_count);
  for (std::vector<ImpactPair>* pairs : {&fast_pairs, &pushed_pairs, &landed_pairs}) makeRoom(*pairs, contact_count);
  makeRoom(impact_pairs, 3 * contact_count);
  for (const JointGroup& group : model.joint_groups) {
    const auto rows = static_cast<std::size_t>(group.count) * kMostJointRows;
    JointGroupScratch& out = joint_groups.emplace_back();
    out.rows.reserve(rows);
    out.A.resize(rows * rows);
    out.lambda.resize(rows);
    out.pivots.resize(rows);
    out.basis.resize(36 * group.bodies.size() * group.bodies.size());
    out.factor.resize(6 * kMoverFreedoms * group.bodies.size());
    out.may_touch = group.may_touch;
  }
  sizeJointRows(model, *this);
  if (model.options.position_tolerance > 0) {
    for (WorldState* copy : {&before, &coarse}) sizeState(model, *copy);
  }
  struck.resize(model.bodies.size());
  pushed.resize(model.bodies.size());
  linked.resize(model.bodies.size() + 1);
  linked_speed2.resize(model.bodies.size() + 1);
  pushed_contacts.resize(contact_count);
  if (mayIslandsSleep(model)) makeRoom(kept, contact_count);
  point_inputs.resize(model.points.size());
  motion_inputs.resize(static_cast<std::size_t>(model.driven_count));
  first_row.resize(contact_count + 1);
  mu.resize(contact_count);
  q.resize(row_count);
  r.resize(row_count);
  u.resize(row_count);
  if (model.has_broad_phase) broad_phase = std::make_unique<BroadPhase>(model);
}

void DeleteScratch::operator()(WorldScratch* scratch) const { delete scratch; }
ScratchHandle makeScratch(const WorldModel& model) { return ScratchHandle(new WorldScratch(model)); }

void timeStages(StageClock* clock, WorldScratch& scratch) { scratch.clock = clock; }

int contactCount(const WorldScratch& scratch) {
  return static_cast<int>(scratch.contacts.size() + scratch.sleep.contacts.size()) - scratch.joint_contacts;
}

ContactReport contactAt(const WorldScratch& scratch, int k) {
  const auto i = static_cast<std::size_t>(k);
  const std::size_t awake = scratch.contacts.size() - static_cast<std::size_t>(scratch.joint_contacts);
  const Contact& c = i < awake ? scratch.contacts[i] : scratch.sleep.contacts[i - awake].contact;
  ContactReport report;
  report.id = c.id;
  (c.a.kind == SideKind::kPoint ? report.point : report.other_body) = c.a.index;
  report.body = c.b.index;
  report.shape = c.b.shape;
  report.other_shape = c.a.shape;
  report.p_W = c.p_W;
  report.n_W = c.n_W();
  report.gap = c.phi;
  report.f_W = c.impulse_W / scratch.h;
  for (int row = kTorsionRow; row < rowsOf(c.material); ++row)
    report.moment_W += (radiusOf(c, row) * c.r[row] / scratch.h) * axisOf(c, row);
  report.mu = c.mu;
  report.pushes = c.active();
  report.sliding = c.sliding;
  return report;
}

std::uint64_t contactId(int shape_bits, const Side& a, const Side& b, std::uint32_t feature) {
  PINCER_ASSERT(isIndex(b.index, std::size_t{kMostNumbered} >> shape_bits) &&
                isIndex(b.shape, std::size_t{1} << shape_bits));
  const auto on_b = static_cast<std::uint64_t>(b.index) << shape_bits;
  if (a.kind == SideKind::kPoint) {
    PINCER_ASSERT(isIndex(a.index, kMostNumbered));
    return std::uint64_t{1} << 62 | static_cast<std::uint64_t>(a.index) << (32 + kNumberBits) | (on_b | b.shape) << 32 |
           feature;
  }
  PINCER_ASSERT(isIndex(a.index, std::size_t{kMostNumbered} >> shape_bits) &&
                isIndex(a.shape, std::size_t{1} << shape_bits));
  const std::uint64_t shapes = static_cast<std::uint64_t>(a.shape) << shape_bits | b.shape;
  return static_cast<std::uint64_t>(a.index) << (32 + kNumberBits + shape_bits) | (on_b << shape_bits | shapes) << 32 |
         feature;
}

ContactOwners ownersOf(int shape_bits, std::uint64_t id) {
  const auto take = [id](int from, int bits) {
    return static_cast<int>(id >> from & ((std::uint64_t{1} << bits) - 1));
  };
  const int bits = kNumberBits - shape_bits;
  if (id >> 63) return {.row = take(32, 2 * kNumberBits)};
  if (id >> 62) return {.b = take(32 + shape_bits, bits)};
  return {.a = take(32 + kNumberBits + shape_bits, bits), .b = take(32 + 2 * shape_bits, bits)};
}

Contact* addContact(WorldScratch& scratch, double phi) {
  std::vector<Contact>& contacts = scratch.contacts;
  PINCER_ASSERT(scratch.sleep.room <= contacts.capacity());  // the tick allocates nothing
  if (contacts.size() < scratch.sleep.room) {
    contacts.emplace_back().phi = phi;
    return &contacts.back();
  }
  scratch.contacts_dropped = true;
  const auto shallowest = std::max_element(contacts.begin(), contacts.end(),
                                           [](const Contact& x, const Contact& y) { return x.phi < y.phi; });
  if (!(shallowest->phi > phi)) return nullptr;
  *shallowest = {};
  shallowest->phi = phi;
  return &*shallowest;
}

}  // namespace pincer::engine
