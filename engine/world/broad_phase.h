// broad_phase: which bodies may be close enough to touch, for worlds of so many
// bodies that looking at every pair costs more.
//
// Bodies with bounds live in Bullet's dynamic tree of boxes (btDbvtBroadphase, double precision), whose boxes are a
// little larger than the bodies, so that what moves slowly changes nothing. The tree depends on the past, the
// candidates given out don't: they are those pairs of the tree whose present boxes overlap, sorted. Bodies without
// bounds (half-spaces, dishes) meet every dynamic body. Memory per body, not per pair; materials are combined where two
// touch. May allocate when more pairs come close than ever before.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "pincer/engine/model.h"

namespace pincer::engine {

struct WorldScratch;

constexpr int kAllPairsBodies = 16;  // up to so many bodies every pair is looked at: cheaper than keeping a tree

struct BodyPair {
  int a = 0, b = 0;  // a < b
};

class BroadPhase {
 public:
  explicit BroadPhase(const WorldModel& model);
  ~BroadPhase();
  BroadPhase(const BroadPhase&) = delete;
  BroadPhase& operator=(const BroadPhase&) = delete;

  // Pairs, sorted by (a, b), of which at least one is dynamic and whose boxes, grown by half the contact margin and by
  // what they may move in a tick, overlap; from the predicted poses in `scratch`. Valid until the next call.
  std::span<const BodyPair> candidates(const WorldModel& model, const WorldScratch& scratch);
  // Bodies, ascending, whose boxes of the last candidates() may be nearer than `reach` [m] to `p_W`, and all
  // without bounds. Valid until the next call.
  std::span<const int> bodiesNear(const Vec3& p_W, double reach);

 private:
  struct Tree;
  void sortBy(int BodyPair::*key);
  std::unique_ptr<Tree> tree_;
  std::vector<int> dynamic_, unbounded_;
  std::vector<BodyPair> pairs_, sorted_;
  std::vector<int> near_;
  std::vector<int> first_;  // per body, while sorting
};

}  // namespace pincer::engine
