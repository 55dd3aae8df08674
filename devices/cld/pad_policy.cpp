#include "pincer/devices/cld/pad_policy.h"

#include <algorithm>
#include <cmath>

namespace pincer::devices {
namespace {

bool counts(const PadContact& c) {
  return c.place_L.allFinite() && c.normal_force > 0 && std::isfinite(c.normal_force);
}

std::optional<Vec2> meanPlace(const PadInput& in) {
  double strongest = 0;
  for (int i = 0; i < in.contact_count; ++i) {
    if (counts(in.contacts[i])) strongest = std::max(strongest, in.contacts[i].normal_force);
  }
  if (strongest == 0) return std::nullopt;
  Vec2 sum = Vec2::Zero();
  double weights = 0;
  for (int i = 0; i < in.contact_count; ++i) {
    if (!counts(in.contacts[i])) continue;
    const double weight = in.contacts[i].normal_force / strongest;  // <= 1: no sum of huge forces overflows
    sum += weight * in.contacts[i].place_L;
    weights += weight;
  }
  return sum / weights;
}

bool isNear(const PadPolicy& policy, const std::optional<NearestPoint>& nearest) {
  return nearest && nearest->distance <= policy.preposition_distance && nearest->place_L.allFinite();
}

struct Goal {
  PadMode mode;
  Vec2 place_L;
};

Goal choose(const PadPolicy& policy, const PadInput& in) {
  if (in.parked) return {PadMode::kParked, Vec2::Zero()};
  if (const auto place = meanPlace(in)) return {PadMode::kContact, *place};
  if (isNear(policy, in.nearest)) return {PadMode::kPreposition, in.nearest->place_L};
  return {PadMode::kCentre, Vec2::Zero()};
}

Vec2 towards(const Vec2& from, const Vec2& to, double longest) {
  const Vec2 way = to - from;
  const double length = way.norm();
  return length <= longest ? to : Vec2(from + way * (longest / length));
}

}  // namespace

TactileCommand padCommand(const PadPolicy& policy, const PadInput& in, double dt, PadState& state) {
  const Goal goal = choose(policy, in);
  state.mode = goal.mode;
  state.place_L = towards(state.place_L, goal.place_L, policy.speed * dt);
  return {in.parked, state.place_L};
}

}  // namespace pincer::devices
