#include "pincer/engine/world/far_contacts.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/world/impact.h"

namespace pincer::engine {
namespace {

constexpr double kFarTimes = 4;  // impulses of a hit pass on no more than twice its speed

// Square of the fastest motion of any place of it, no less.
double fastest2Of(const BodyModel& body, const BodyScratch& s) {
  if (!body.dynamic && !body.driven) return 0;
  const double reach = std::min(body.bounding_radius, 1e6);
  return 2 * (std::max(s.free.v_W.squaredNorm(), s.start.v_W.squaredNorm()) + reach * reach * s.free.w_W.squaredNorm());
}
double fastest2Of(const PointScratch& point) { return 2 * point.free.v_W.squaredNorm(); }
double fastest2Of(const WorldModel& model, const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kPoint) return fastest2Of(scratch.points[side.index]);
  return fastest2Of(model.bodies[side.index], scratch.bodies[side.index]);
}

double fastestFree(const WorldModel& model, const WorldScratch& scratch) {
  double fastest2 = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i)
    fastest2 = std::max(fastest2, fastest2Of(model.bodies[i], scratch.bodies[i]));
  for (const PointScratch& point : scratch.points) fastest2 = std::max(fastest2, fastest2Of(point));
  return std::sqrt(fastest2);
}

bool isJoined(const WorldModel& model, const Side& side) {
  return side.kind == SideKind::kJoint || (side.kind == SideKind::kBody && engine::isJoined(model.bodies[side.index]));
}

// At the end of this part of the tick, contacts included.
Motion endMotion(const WorldModel& model, const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kPoint) {
    const PointScratch& point = scratch.points[side.index];
    return {point.free.v_W + point.response(point.impulse_W), point.free.w_W};
  }
  const BodyModel& body = model.bodies[side.index];
  const BodyScratch& s = scratch.bodies[side.index];
  if (!body.dynamic) return s.free;
  return {s.free.v_W + body.inverse_mass * s.impulse_W, endAngularVelocity(model, scratch, side.index)};
}

}  // namespace

void markFarContacts(const WorldModel& model, WorldScratch& scratch) {
  scratch.far_contacts = 0;
  if (!(scratch.h > 0)) return;
  const auto is_open = [](const Contact& c) { return c.bias_C[kNormalRow] > 0; };
  if (std::none_of(scratch.contacts.begin(), scratch.contacts.end(), is_open)) return;
  const double fastest = fastestFree(model, scratch);
  const auto limitOf = [&](const Contact& c) {
    const double own = std::sqrt(std::max(fastest2Of(model, scratch, c.a), fastest2Of(model, scratch, c.b)));
    return std::max(fastest, kFarTimes * own);
  };
  for (std::size_t i = 0; i < scratch.contacts.size(); ++i) {
    Contact& c = scratch.contacts[i];
    const double opens = scratch.q[static_cast<std::size_t>(scratch.first_row[i] + kNormalRow)];
    c.far = c.bias_C[kNormalRow] > 0 && opens > fastest && !isJoined(model, c.a) && !isJoined(model, c.b) &&
            opens > limitOf(c);
    scratch.far_contacts += c.far;
  }
}

bool haveFarClosed(const WorldModel& model, WorldScratch& scratch) {
  if (scratch.far_contacts == 0) return false;
  int closed = 0;
  const Contact* before = nullptr;
  Motion end_a, end_b;
  for (Contact& c : scratch.contacts) {
    if (!c.far) continue;
    if (!before || !isOfSameTwo(*before, c)) {
      end_a = endMotion(model, scratch, c.a);
      end_b = endMotion(model, scratch, c.b);
    }
    before = &c;
    double v_C[kMaxContactRows];
    relativeVelocity(c, end_a, end_b, kPointRows, v_C);
    for (int k = 0; k < kPointRows; ++k) c.u_C[k] = v_C[k] + c.bias_C[k];
    if (c.u_C[kNormalRow] >= 0) continue;
    c.far = false;
    ++closed;
  }
  scratch.far_contacts -= closed;
  return closed > 0;
}

}  // namespace pincer::engine
