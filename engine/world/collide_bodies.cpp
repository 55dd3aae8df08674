#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"
#include "pincer/engine/world/budget.h"
#include "pincer/engine/world/colliders.h"
#include "pincer/engine/world/impact.h"
#include "pincer/engine/world/island_sleep.h"
#include "pincer/engine/world/thin_contacts.h"
#include "pincer/engine/world/unchanged_pairs.h"

namespace pincer::engine {
namespace {

// True if `plane` is a half-space that is further than `margin` from b's bounding sphere.
bool isOver(const BodyModel& plane, const BodyModel& b, const BodyScratch& s_plane, const BodyScratch& sb,
            double margin) {
  return plane.is_plane && s_plane.R_WB_mid.col(2).dot(sb.X_WI_mid.p - s_plane.X_WB_mid.p) > b.bounding_radius + margin;
}

bool boundsTouch(const BodyModel& a, const BodyModel& b, const BodyScratch& sa, const BodyScratch& sb, double margin) {
  const double reach = a.bounding_radius + b.bounding_radius + margin;
  if ((sa.X_WI_mid.p - sb.X_WI_mid.p).squaredNorm() > reach * reach) return false;
  return !isOver(a, b, sa, sb, margin) && !isOver(b, a, sb, sa, margin);
}

double cornerSpeed(const BodyModel& body, const BodyScratch& s) {
  return body.corner_reach > 0 ? body.corner_reach * s.start.w_W.norm() : 0;
}

// Of two shapes, whose contacts are numbered from `first` on.
contact::LastPoints lastPoints(const WorldState& state, std::uint64_t first) {
  const auto end = state.contacts.begin() + state.contact_count;
  const auto less = [](const ContactMemory& m, std::uint64_t id) { return m.id < id; };
  contact::LastPoints last;
  for (auto m = std::lower_bound(state.contacts.begin(), end, first, less); m != end && m->id >> 32 == first >> 32;
       ++m) {
    if (last.count == 0) last.n_W = m->n_W;
    last.add(static_cast<std::uint32_t>(m->id), m->active);
  }
  return last;
}

void addPoints(const WorldModel& model, const ColliderModel& a, const ColliderModel& b, const Material& material,
               const contact::PairPoints& found, WorldScratch& scratch) {
  const Side side_a = sideOf(model, a), side_b = sideOf(model, b);
  for (int i = 0; i < found.count; ++i) {
    const contact::PairPoint& point = found.points[i];
    Contact* const contact = addContact(scratch, point.phi);
    if (!contact) continue;
    contact->id = contactId(model.shape_bits, side_a, side_b, point.feature);
    contact->a = side_a;
    contact->b = side_b;
    contact->p_W = point.p_W;
    contact->R_WC.col(2) = point.n_W;
    contact->material = material;
  }
}

// Of shapes at these places, but for the last points, which are looked up. Spheres need none, and are asked for sooner
// than remembered.
const contact::PairPoints& pointsOf(const WorldModel& model, const WorldState& state, const ColliderModel& a,
                                    const ColliderModel& b, PairPlace place, contact::PairPoints& found,
                                    WorldScratch& scratch) {
  const auto collide = [&](contact::PairPoints& points) {
    contact::collideShapes(a.shape, place.X_WA, b.shape, place.X_WB, place.margin, scratch.patches, points, place.last);
  };
  if (isSphere(a) || isSphere(b)) {
    collide(found);
    return found;
  }
  const std::uint64_t first = contactId(model.shape_bits, sideOf(model, a), sideOf(model, b), 0);
  place.last = lastPoints(state, first);
  return scratch.found_pairs.pointsOf(first, place, collide);
}

// material  of the pair, null where it is combined once two shapes touch;   found  working memory
void collidePair(const WorldModel& model, const WorldState& state, const BodyPair& pair, const Material* material,
                 double h, contact::PairPoints& found, WorldScratch& scratch) {
  if (isIdle(scratch, pair.a) && isIdle(scratch, pair.b)) return;
  PINCER_ASSERT(pair.a < pair.b);
  PINCER_ASSERT(model.bodies[pair.a].dynamic || model.bodies[pair.b].dynamic);
  const BodyModel &a = model.bodies[pair.a], &b = model.bodies[pair.b];
  const BodyScratch &sa = scratch.bodies[pair.a], &sb = scratch.bodies[pair.b];
  // A gap that closes within the tick must be seen at its middle: the far end of a sheet that slaps down as well.
  const double speed = (sa.start.v_W - sb.start.v_W).norm();
  const double turning = model.has_corners ? cornerSpeed(a, sa) + cornerSpeed(b, sb) : 0;
  const double margin = contactMargin(a, b) + h * std::max(speed, 0.5 * (speed + turning)) + sa.flung + sb.flung;
  if (!boundsTouch(a, b, sa, sb, margin)) return;
  noteFastPair(model, state, pair.a, pair.b, scratch);
  if (keepContacts(model, state, pair, scratch)) return;
  const auto collide = [&](const ColliderModel& ca, const Pose& X_WA, const ColliderModel& cb, const Pose& X_WB) {
    chargeQuery(ca, cb, scratch);
    const contact::PairPoints& points = pointsOf(model, state, ca, cb, {X_WA, X_WB, margin}, found, scratch);
    if (points.count > 0) addPoints(model, ca, cb, material ? *material : materialOf(model, ca, cb), points, scratch);
  };
  const std::size_t first = scratch.contacts.size();
  forEachNearShapes(model, a, sa.X_WB_mid, b, sb.X_WB_mid, margin, collide);
  if (a.collider_count + b.collider_count > 2) thinContacts(state, first, scratch);
}

}  // namespace

void collideBodies(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  const double h = model.options.h;
  contact::PairPoints found;
  for (const PairModel& pair : model.pairs) {
    const Material* const material = pair.is_of_many ? nullptr : &pair.material;
    collidePair(model, state, {pair.a, pair.b}, material, h, found, scratch);
  }
  if (scratch.broad_phase) {
    for (const BodyPair& pair : scratch.broad_phase->candidates(model, scratch))
      collidePair(model, state, pair, nullptr, h, found, scratch);
  }
  takeKept(scratch);
}

}  // namespace pincer::engine
