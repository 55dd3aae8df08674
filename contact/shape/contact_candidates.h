// contact_candidates: points where two bodies may touch, collected from many places, of
// which a few are kept (rule: mesh_pairs.h).
#pragma once
#include <algorithm>
#include <array>
#include <span>

#include "pincer/contact/pair_query.h"

namespace pincer::contact {

// A point, and the mesh's triangle at which it was found; -1 where none was named.
struct FoundPoint : PairPoint {
  std::int32_t triangle = -1;
};
struct FoundPoints {
  std::array<FoundPoint, kMaxPairPoints> points;
  int count = 0;

  std::span<FoundPoint> all() { return {points.data(), static_cast<std::size_t>(count)}; }
  // Appended to the empty `out`; `X_WF` is the pose of the frame that they are in.
  void place(const Pose& X_WF, PairPoints& out) const;
};

class ContactCandidates {
 public:
  // Chosen: up to eight of them are kept, and add() compares with all.
  static constexpr int kMost = 256;

  // Of equal features the one with the smaller gap or depth stays: the nearest surface is the one that a point may
  // touch; when all places are taken the shallowest makes room.
  void add(const FoundPoint& point);
  // A point of one body that is in the other, whose own way out `phi` < 0 is refused because
  // another is much shorter. Where nothing else overlaps, the shallowest of these counts: the
  // shorter ways are closed to what surrounds the point.
  void addRefused(const FoundPoint& point) {
    if (point.phi > refused_.phi) refused_ = point;
  }
  // Up to kMaxPairPoints of them, sorted by feature, in the frame that they were given in.
  // Points of `last` stay for as long as no other is kStays times as good.
  FoundPoints keepBest(const LastPoints& last = {});

 private:
  bool overlap() const {
    return std::any_of(points_.begin(), points_.begin() + count_, [](const PairPoint& p) { return p.phi < 0; });
  }

  std::array<FoundPoint, kMost> points_;
  int count_ = 0;
  FoundPoint refused_{{Vec3::Zero(), Vec3::UnitZ(), -kInfinity, 0}};
};

}  // namespace pincer::contact
