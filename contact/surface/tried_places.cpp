#include <algorithm>

#include "pincer/contact/surface/flat_minimum.h"
#include "pincer/contact/surface/lone_contact.h"
#include "pincer/contact/surface/lookout.h"
#include "pincer/contact/surface/shell_face.h"
#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

namespace {

constexpr int kMostWork = 48;  // walks, steps and crossings of a query's tries; the others' turn comes in the next

bool shareVertex(const TriangleMesh& mesh, std::int32_t t, std::int32_t other) {
  const auto &a = mesh.triangles[static_cast<std::size_t>(t)], &b = mesh.triangles[static_cast<std::size_t>(other)];
  return std::any_of(a.begin(), a.end(), [&](std::int32_t v) { return v == b[0] || v == b[1] || v == b[2]; });
}

// Cosine of the angle between `n` and the nearest of the triangle's corner normals.
double closestNormal(const SurfaceNet& net, std::int32_t triangle, const Vec3& n) {
  return std::max({net.normal(triangle, 0).dot(n), net.normal(triangle, 1).dot(n), net.normal(triangle, 2).dot(n)});
}

}  // namespace

// Places have their turns spread evenly around a circle, which is gone around once within `turn`.
bool Lookout::hasTurn(const NearPart& part) const {
  constexpr std::uint32_t kGolden = 2654435769;  // the circle over the golden ratio
  return kGolden * static_cast<std::uint32_t>(part.place) - tracker_.turn <= share_;
}

bool Lookout::isNothingDue() {
  if (!isNear()) return false;
  if (tracker_.look.is_alone) return true;
  NearParts& near = surface_.cache.partsOf(tracker_);
  if (!near.areOf(surface_.net.fingerprint(), tracker_.look)) return false;
  near.advance(ball_.C, ball_.reach);
  return std::none_of(near.parts.begin(), near.parts.end(),
                      [&](const NearPart& part) { return part.due <= near.gone && hasTurn(part); });
}

// Tries those that have their turn; all without anything to go by. What a query has too much work for waits for its
// next.
void Lookout::examineNear(NearParts& near) {
  const bool is_free = !(contacts_->nearestHeight() < ball_.r) && !contacts_->hasRoom();  // the nearest is the answer
  const bool is_all = !contacts_->hadContacts() || !contacts_->follows() || is_free;
  for (NearPart& part : near.parts) {
    if (!(part.due <= near.gone && (is_all || hasTurn(part)))) continue;
    if (work_ >= kMostWork) return;
    part.due = near.gone + examine(part.place);
  }
}

// Tries a place of the part, if it has one that is no followed contact's. Returns the way for which it can't matter.
double Lookout::examine(std::int32_t place) {
  const PatchBounds part = search_.part(place);
  const double rounding = kRoundOff * surface_.net.length();
  const double way = part.approach(ball_.C, ball_.reach) - rounding;
  if (way > 0) return way;
  const double reach = std::min(ball_.reach, contacts_->heightToBeat());
  if (reach < ball_.reach && !part.mayHold(ball_.C, reach, Facing::front)) return 0;
  const auto [triangle, other] = search_.trianglesAt(place);
  if (isBeside(part, triangle) && (other == triangle || isBeside(part, other))) return 0;
  const FlatPoint flat = closestOnFacet(surface_.net, triangle, ball_.C);
  const double distance = std::sqrt(flat.distance2) - part.bulge;  // of large patches more than their balls tell
  if (distance < reach && !isKnown(triangle, flat) && isFlatMinimum(surface_.net, triangle, flat, ball_.C))
    tryPlace({triangle, flat.b});
  return std::max(0.0, distance - ball_.reach - rounding);
}

// True if the patch is beside a followed contact's, and bends so little that it holds no other.
bool Lookout::isBeside(const PatchBounds& part, std::int32_t triangle) const {
  return part.hollow * ball_.reach < LoneContact::kFits && contacts_->isAny([&](const HeldContact& f) {
    return shareVertex(surface_.net.mesh(), triangle, f.contact.foot.triangle) &&
           closestNormal(surface_.net, triangle, f.contact.n) > kBeside;
  });
}

// True if a followed contact stands for what is that way.
bool Lookout::isKnown(std::int32_t triangle, const FlatPoint& flat) const {
  Vec3 R = ball_.C;
  for (int i = 0; i < 3; ++i) R -= flat.b[static_cast<std::size_t>(i)] * surface_.net.vertex(triangle, i);
  const double least = kApart * std::sqrt(flat.distance2);
  return contacts_->isAny([&](const HeldContact& f) { return f.contact.n.dot(R) > least; });
}

void Lookout::tryPlace(const Foot& foot) {
  const ShellContact found = follow(surface_, ball_.C, ball_.r, foot);
  work_ += 1 + found.cost.steps + found.cost.crossings;
  if (!found.converged || !(found.h > 0 && found.h < ball_.reach) || !isNew(found)) return;
  if (!contacts_->admit(found)) tracker_.left_out = 0;
}

// True if it is a stable place, that the finger could come to from outside, and no followed contact's.
bool Lookout::isNew(const ShellContact& candidate) const {
  constexpr double kShort = 0.95;  // of the way: a patch may bulge out of its triangle
  if (contacts_->isAny([&](const HeldContact& f) { return f.contact.n.dot(candidate.n) > kApart; })) return false;
  const Foot& foot = candidate.foot;
  const Vec3& C = ball_.C;
  if (foot.isOnFace() &&
      !isStable(evaluate(surface_.net.cell(foot.triangle, surface_.cache).patch, foot.b[1], foot.b[2]), C))
    return false;
  const Vec3 S = ball_.placeOf(candidate);
  if (tracker_.has_centre && (tracker_.p_BC - S).dot(candidate.n) <= 0) return false;
  return !search_.isHidden(surface_.net, C, C + kShort * (S - C));
}

}  // namespace pincer::contact
