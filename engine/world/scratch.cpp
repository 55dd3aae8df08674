#include "engine/world/scratch.h"

#include <algorithm>

#include "contact/invariants.h"
#include "engine/world/most_numbered.h"

namespace pincer::engine {
namespace {

// A finger or body on a mesh needs some dozens of patches; a world without meshes none.
int patchesFor(const WorldModel& model) {
  const auto is_mesh = [](const BodyModel& body) { return std::holds_alternative<contact::Mesh>(body.shape); };
  return std::any_of(model.bodies.begin(), model.bodies.end(), is_mesh) ? 1024 : 1;
}

void sizeForSleep(const WorldModel& model, SleepScratch& sleep) {
  const std::size_t bodies = model.bodies.size();
  sleep.room = static_cast<std::size_t>(model.options.max_contacts);
  sleep.idle.resize(bodies);
  sleep.group.resize(bodies);
  sleep.states.resize(bodies);
  const bool may_sleep = std::any_of(model.bodies.begin(), model.bodies.end(), [](const BodyModel& body) { return body.dynamic; });
  if (!model.options.sleep || !may_sleep) return;
  sleep.contacts.reserve(static_cast<std::size_t>(model.options.max_contacts));
  sleep.kept.reserve(static_cast<std::size_t>(model.options.max_contacts));
}

}  // namespace

WorldScratch::WorldScratch(const WorldModel& model) : h(model.options.h), patches(patchesFor(model)), islands(model) {
  const auto contact_count = static_cast<std::size_t>(model.options.max_contacts);
  const std::size_t row_count = contact_count * kMaxContactRows;
  bodies.resize(model.bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].still = !model.bodies[i].dynamic;
  points.resize(model.points.size());
  for (PointScratch& point : points) point.has_hollows = model.has_hollows;
  contacts.reserve(contact_count);
  fast_pairs.reserve(contact_count);
  pushed_pairs.reserve(contact_count);
  impact_pairs.reserve(3 * contact_count);
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
  for (WorldState* copy : {&before, &coarse}) {  // so that copying a state allocates nothing
    if (!(model.options.position_tolerance > 0)) break;
    copy->bodies.resize(model.bodies.size());
    copy->points.resize(model.points.size());
    copy->contacts.resize(contact_count);
  }
  struck.resize(model.bodies.size());
  rest.state.bodies.resize(model.bodies.size());
  rest.state.points.resize(model.points.size());
  rest.state.contacts.resize(contact_count);
  rest.points.resize(model.points.size());
  rest.motions.resize(static_cast<std::size_t>(model.driven_count));
  sizeForSleep(model, sleep);
  point_inputs.resize(model.points.size());
  motion_inputs.resize(static_cast<std::size_t>(model.driven_count));
  first_row.resize(contact_count + 1);
  mu.resize(contact_count);
  q.resize(row_count);
  r.resize(row_count);
  u.resize(row_count);
  if (model.has_broad_phase) broad_phase = std::make_unique<BroadPhase>(model);
}

std::uint64_t contactId(int kind, int a, int b, std::uint32_t feature) {
  PINCER_ASSERT(kind == 0 || kind == 1);
  PINCER_ASSERT(isIndex(a, kMostNumbered) && isIndex(b, kMostNumbered));
  return static_cast<std::uint64_t>(kind) << 62 | static_cast<std::uint64_t>(a & (kMostNumbered - 1)) << 47 |
         static_cast<std::uint64_t>(b & (kMostNumbered - 1)) << 32 | feature;
}

Contact* addContact(WorldScratch& scratch, double phi) {
  std::vector<Contact>& contacts = scratch.contacts;
  PINCER_ASSERT(scratch.sleep.room <= contacts.capacity());  // the tick allocates nothing
  if (contacts.size() < scratch.sleep.room) {
    contacts.emplace_back().phi = phi;
    return &contacts.back();
  }
  scratch.contacts_dropped = true;
  const auto shallowest =
      std::max_element(contacts.begin(), contacts.end(), [](const Contact& x, const Contact& y) { return x.phi < y.phi; });
  if (!(shallowest->phi > phi)) return nullptr;
  *shallowest = {};
  shallowest->phi = phi;
  return &*shallowest;
}

}  // namespace pincer::engine
