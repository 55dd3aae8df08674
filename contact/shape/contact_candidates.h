// contact_candidates: points where two bodies may touch, collected from many places, of which a few are kept (rule: mesh_pairs.h).
#pragma once
#include <array>

#include "contact/shape/pair_query.h"

namespace pincer::contact {

class ContactCandidates {
 public:
  static constexpr int kMost = 256;

  // Of equal features the one with the smaller gap or depth stays: the nearest surface is the one that a point may touch; when all places are taken the shallowest makes room.
  void add(const PairPoint& point);
  // Up to kMaxPairPoints of them, appended to the empty `out`, sorted by feature; `X_WF` is the pose of the frame that they were given in.
  void keepBest(const Pose& X_WF, PairPoints& out) const;

 private:
  std::array<PairPoint, kMost> points_;
  int count_ = 0;
};

}  // namespace pincer::contact
