#include "pincer/engine/world/far_contacts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

// The fastest of all that contacts link, open or not. Bodies on joints and points are one, whatever they touch. So
// nothing that moves elsewhere decides how a thing rests, which may sleep.
class Linked {
 public:
  Linked(const WorldModel& model, WorldScratch& scratch)
      : model_(model), root_(scratch.linked.data()), fastest2_(scratch.linked_speed2.data()) {
    std::iota(scratch.linked.begin(), scratch.linked.end(), 0);
    std::fill(scratch.linked_speed2.begin(), scratch.linked_speed2.end(), 0.0);
    const Contact* before = nullptr;
    for (const Contact& c : scratch.contacts) {
      if (!before || !isOfSameTwo(*before, c)) unite(c);
      before = &c;
    }
    for (std::size_t i = 0; i < model.bodies.size(); ++i)
      note(nodeOf(static_cast<int>(i)), fastest2Of(model.bodies[i], scratch.bodies[i]));
    for (const PointScratch& point : scratch.points) note(others(), fastest2Of(point));
  }

  // Of all that the contact is linked with [m/s]
  double fastest(const Contact& c) {
    const int a = nodeOf(c.a), b = nodeOf(c.b);
    const double a2 = a < 0 ? 0 : fastest2_[rootOf(a)], b2 = b < 0 ? 0 : fastest2_[rootOf(b)];
    return std::sqrt(std::max(a2, b2));
  }

 private:
  int others() const { return static_cast<int>(model_.bodies.size()); }
  int nodeOf(int body) const {
    const BodyModel& b = model_.bodies[static_cast<std::size_t>(body)];
    if (b.driven || engine::isJoined(b)) return others();
    return b.dynamic ? body : -1;
  }
  int nodeOf(const Side& side) const { return side.kind == SideKind::kBody ? nodeOf(side.index) : others(); }
  int rootOf(int node) {
    while (root_[node] != node) node = root_[node] = root_[root_[node]];
    return node;
  }
  void unite(const Contact& c) {
    const int a = nodeOf(c.a), b = nodeOf(c.b);
    if (a < 0 || b < 0) return;
    const int x = rootOf(a), y = rootOf(b);
    root_[std::max(x, y)] = std::min(x, y);
  }
  void note(int node, double speed2) {
    if (node < 0) return;
    double& fastest2 = fastest2_[rootOf(node)];
    fastest2 = std::max(fastest2, speed2);
  }

  const WorldModel& model_;
  int* const root_;
  double* const fastest2_;
};

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
  Linked linked(model, scratch);
  const auto limitOf = [&](const Contact& c) {
    const double own = std::sqrt(std::max(fastest2Of(model, scratch, c.a), fastest2Of(model, scratch, c.b)));
    return std::max(linked.fastest(c), kFarTimes * own);
  };
  for (std::size_t i = 0; i < scratch.contacts.size(); ++i) {
    Contact& c = scratch.contacts[i];
    const double opens = scratch.q[static_cast<std::size_t>(scratch.first_row[i] + kNormalRow)];
    c.far = c.bias_C[kNormalRow] > 0 && !isJoined(model, c.a) && !isJoined(model, c.b) && opens > limitOf(c);
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
