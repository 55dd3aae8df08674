#include <algorithm>

#include "pincer/contact/surface/flat_minimum.h"
#include "pincer/contact/surface/lookout.h"
#include "pincer/contact/surface/shell_face.h"

namespace pincer::contact {

namespace {

constexpr int kMostTried = 16;   // places in a query; the others' turn comes in the next
constexpr int kMostWalked = 32;  // steps and crossings of a query's tries; the last walk is always ended

// True if the place is on this triangle, or on an edge or a vertex that it has too.
bool isOn(const SurfaceNet& net, const Foot& foot, std::int32_t triangle) {
  if (foot.triangle == triangle || foot.isOnFace()) return foot.triangle == triangle;
  const auto& v = net.mesh().triangles[static_cast<std::size_t>(triangle)];
  bool shares_all = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (foot.b[i] == 0) continue;
    shares_all = shares_all && std::find(v.begin(), v.end(),
                                         net.mesh().triangles[static_cast<std::size_t>(foot.triangle)][i]) != v.end();
  }
  return shares_all;
}

// Cosine of the angle between `n` and the nearest of the triangle's corner normals.
double closestNormal(const SurfaceNet& net, std::int32_t triangle, const Vec3& n) {
  return std::max({net.normal(triangle, 0).dot(n), net.normal(triangle, 1).dot(n), net.normal(triangle, 2).dot(n)});
}

}  // namespace

// Tries the places that are due and have their turn, until so much has been tried as a query may try; the next one goes
// on from there.
void Lookout::examineDue(NearParts& near, bool are_all) {
  if (hasTriedEnough()) return;
  std::array<std::uint16_t, kMostParts> due;
  std::size_t count = 0, first = 0;
  near.due = kInfinity;
  for (std::size_t i = 0; i < near.parts.size(); ++i) {
    const NearPart& part = near.parts[i];
    const double when = are_all ? part.due : std::max(part.due, part.turn);
    const bool is_due = when <= gone_;
    due[count] = static_cast<std::uint16_t>(i);
    count += is_due;
    first += is_due && i < static_cast<std::size_t>(tracker_.tried);
    near.due = std::min(near.due, is_due ? kInfinity : when);
  }
  const Turns turns(tracker_.gone, gone_, ball_.turn);
  tracker_.tried = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = due[first + k < count ? first + k : first + k - count];
    NearPart& part = near.parts[i];
    if (part.turn == 0) part.turn = tracker_.gone + turns.wayToFirst(part.place);
    if ((part.turn <= gone_ || are_all) && !hasTriedEnough()) {
      examine(turns, part);
      if (hasTriedEnough()) tracker_.tried = static_cast<std::int32_t>(i + 1);
    }
    near.due = std::min(near.due, std::max(part.due, part.turn));
  }
}

// The rest waits for the next query; not where everyone has a turn, but for the places that can be remembered.
bool Lookout::hasTriedEnough() const { return tries_ >= kMostTried || (walked_ >= kMostWalked && !isEveryonesTurn()); }

// Without anything to go by, and in free space with all slots taken, where the nearest is the answer.
bool Lookout::isEveryonesTurn() const {
  return !contacts_.hasHistory() || !contacts_.follows() || (contacts_.list().isFull() && !contacts_.touches());
}

// How near a place has to be to be tried now [m]; 0: none is. Where all slots are taken it has to be nearer than what
// may yield.
double Lookout::reachOfTry(bool has_turn) const {
  const bool is_free = !contacts_.hasHistory() || !contacts_.follows() || has_turn;
  if (!contacts_.list().isFull()) return is_free ? ball_.reach : 0;
  const double highest = contacts_.heightToYield();
  const bool is_asked_again = gone_ - tracker_.full_at > 0.5 * ball_.turn;  // only to see whether a place is left out
  if (!(highest > 0)) return is_free && is_asked_again ? ball_.reach : 0;
  return is_free ? highest : contacts_.touches() ? 0 : std::min(highest, contacts_.nearestHeight());
}

void Lookout::examine(const Turns& turns, NearPart& near) {
  const PatchBounds part = search_.part(near.place);
  const auto [triangle, other] = search_.trianglesAt(near.place);
  near.turn = gone_ + turns.wayToNext(near.place);
  const double reach = reachOfTry(turns.isOf(near.place));
  if (reach < ball_.reach && !(reach > 0 && part.mayHold(ball_.C, reach, Facing::front))) return;
  const double way = std::max(0.0, part.approach(ball_.C, ball_.reach) - kRoundOff * surface_.net.length());
  near.due = gone_ + way;
  if (way > 0 || !part.mayHold(ball_.C, reach, Facing::front)) return;
  if (isKnown(triangle, part) && (other == triangle || isKnown(other, part))) return;
  const FlatPoint flat = closestOnFacet(surface_.net, triangle, ball_.C);
  const double distance = std::sqrt(flat.distance2) - part.bulge;  // of large patches more than their balls tell
  near.due += std::max(0.0, distance - ball_.reach - kRoundOff * surface_.net.length());
  if (distance < reach && isFlatMinimum(surface_.net, triangle, flat, ball_.C)) tryPlace({triangle, flat.b});
}

// True if a followed contact stands for this patch: beside it, with a normal that the patch's could be. (Not any of its
// cone's: along a groove that holds the other wall's.)
[[gnu::flatten]] bool Lookout::isKnown(std::int32_t triangle, const PatchBounds& part) const {
  const double beside = std::max<double>(part.radius, kWay * ball_.r) + part.radius;
  return contacts_.isAny([&](const FollowedContact& f) {
    return isOn(surface_.net, f.contact.foot, triangle) ||
           ((ball_.placeOf(f.contact) - part.middle()).squaredNorm() < beside * beside &&
            closestNormal(surface_.net, triangle, f.contact.n) > kBeside);
  });
}

void Lookout::tryPlace(const Foot& foot) {
  const ShellContact found = follow(surface_, ball_.C, ball_.r, foot);
  ++tries_;
  walked_ += found.cost.steps + found.cost.crossings;
  if (!found.converged || !(found.h > 0 && found.h < ball_.reach) || !isNew(found)) return;
  if (contacts_.list().isFull()) tracker_.full_at = gone_;
  contacts_.admit(found);
}

// True if it is a stable place, that the finger could come to from outside, and no followed contact's.
bool Lookout::isNew(const ShellContact& candidate) const {
  constexpr double kShort = 0.95;  // of the way: a patch may bulge out of its triangle
  if (contacts_.isAny([&](const FollowedContact& f) { return f.contact.n.dot(candidate.n) > kApart; })) return false;
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
