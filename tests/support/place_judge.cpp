#include "pincer/tests/support/place_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pincer/tests/support/random_poses.h"

namespace pincer::tests {

using contact::SurfaceContact;
using contact::SurfaceContacts;
using contact::SurfaceSlot;

namespace {

constexpr double kOne = 0.998;    // cosine of 3.6 degrees
constexpr double kShort = 0.95;   // of the way to a place, on which nothing may hide it
constexpr double kSlack = 1e-6;   // [m] at the margin's end, and at phi = 0
constexpr double kBeside = 1e-5;  // [m]: a contact further from every place has none

bool tells(const SurfaceContact& c, const ShellPlace& place) { return c.n_B.dot(place.n) > kOne; }

}  // namespace

void PlaceVerdicts::complain(const char* what, const Vec3& C, const Vec3& S, double phi) {
  if (!first.empty()) return;
  first = fmt::format("{}: C ({:.9g}, {:.9g}, {:.9g}) S ({:.9g}, {:.9g}, {:.9g}) phi {:.3g}", what, C[0], C[1], C[2],
                      S[0], S[1], S[2], phi);
}

PlaceJudge::PlaceJudge(const contact::TriangleMesh& mesh)
    : mesh_(mesh), oracle_(mesh), object_(contact::SmoothMesh::build(mesh)) {}

Vec3 PlaceJudge::homeOver(double height, RandomNumbers& random) const {
  for (;;) {
    const auto& t = mesh_.triangles[static_cast<std::size_t>(random.uniform(0, 1) *
                                                             static_cast<double>(mesh_.triangles.size() - 1))];
    const auto corner = [&](std::size_t i) -> const Vec3& { return mesh_.vertices[static_cast<std::size_t>(t[i])]; };
    const Vec3 n = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    const Vec3 C = (corner(0) + corner(1) + corner(2)) / 3 + height * n;
    if (oracle_.distance(C) > 0.99 * height) return C;
  }
}

void PlaceJudge::wander(const LedFinger& finger, const Vec3& home, int queries, RandomNumbers& random,
                        PlaceVerdicts& verdicts) {
  tracker_ = {};
  Vec3 C = home, heading = direction(random);
  for (int i = 0; i < queries; ++i) {
    const Vec3 outside = tracker_.has_centre ? tracker_.p_BC : C;
    const SurfaceContacts found = object_->querySphere(C, finger.r, finger.margin, tracker_, cache_);
    if (i > 0 && i % finger.each == 0) judge(finger, C, outside, found, verdicts);
    heading = (heading + 0.3 * direction(random) - 0.1 * (C - home) / finger.r).normalized();
    if (finger.depth > 0) {
      const SurfaceContact& main = found.main();
      heading = (heading - heading.dot(main.n_B) * main.n_B).normalized();
      C += std::clamp(-finger.depth - main.phi, -finger.step, finger.step) * main.n_B;
    }
    C += finger.step * heading;
    for (int k = 0; k < found.count && !(finger.depth > 0); ++k) {
      const SurfaceContact& c = found.points[static_cast<std::size_t>(k)];
      const double phi = (C - c.p_BS).dot(c.n_B) - finger.r;
      if (phi < 0) C -= phi * c.n_B;
    }
  }
}

void PlaceJudge::judge(const LedFinger& finger, const Vec3& C, const Vec3& outside, const SurfaceContacts& found,
                       PlaceVerdicts& verdicts) const {
  ++verdicts.judged;
  verdicts.several += found.count > 1;
  const std::span<const SurfaceContact> told(found.points.data(),
                                             static_cast<std::size_t>(std::min(found.count, finger.counted)));
  const std::vector<ShellPlace> places = oracle_.placesNear(C, finger.r + finger.margin + kSlack);
  for (const SurfaceContact& c : told) {
    const SurfaceSlot& slot = tracker_.slots[c.feature];
    const bool is_held = (tracker_.status & contact::kQueryHeldDirection) != 0;
    if (!slot.fades && slot.ease == 0 && c.phi < finger.margin && !is_held)
      judgeContact(finger, C, c, places, verdicts);
  }
  if (found.count == contact::kMaxSurfaceContacts) return;  // more are left out
  for (const ShellPlace& place : places) {
    if (mayBeTold(finger, C, outside, place)) judgePlace(finger, C, place, told, verdicts);
  }
}

// Is it one of the places?
void PlaceJudge::judgeContact(const LedFinger& finger, const Vec3& C, const SurfaceContact& c,
                              std::span<const ShellPlace> places, PlaceVerdicts& verdicts) const {
  double nearest = std::numeric_limits<double>::infinity(), gap = 0;
  for (const ShellPlace& place : places) {
    if ((place.S - c.p_BS).norm() >= nearest) continue;
    nearest = (place.S - c.p_BS).norm();
    gap = std::abs(place.h - finger.r - c.phi);
  }
  if (nearest > kBeside) {
    ++verdicts.extra;
    return verdicts.complain("extra", C, c.p_BS, c.phi);
  }
  verdicts.off_place = std::max(verdicts.off_place, nearest);
  verdicts.off_gap = std::max(verdicts.off_gap, gap);
}

bool PlaceJudge::mayBeTold(const LedFinger& finger, const Vec3& C, const Vec3& outside, const ShellPlace& place) const {
  return place.is_stable && place.h > 0 && place.h < finger.r + finger.margin - kSlack &&
         (outside - place.S).dot(place.n) > 0 && !oracle_.isHidden(C, C + kShort * (place.S - C));
}

// Is it told of?
void PlaceJudge::judgePlace(const LedFinger& finger, const Vec3& C, const ShellPlace& place,
                            std::span<const SurfaceContact> told, PlaceVerdicts& verdicts) const {
  ++verdicts.places;
  if (std::any_of(told.begin(), told.end(), [&](const SurfaceContact& c) { return tells(c, place); })) return;
  ++verdicts.missed;
  verdicts.complain("missed", C, place.S, place.h - finger.r);
  if (!(place.h < finger.r - kSlack)) return;
  ++verdicts.felt;
  verdicts.deepest = std::max(verdicts.deepest, finger.r - place.h);
}

}  // namespace pincer::tests
