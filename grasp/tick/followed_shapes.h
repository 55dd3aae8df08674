// followed_shapes: a finger's look at the shapes around it, each with the memory of the look before.
#pragma once
#include "pincer/grasp/step.h"

namespace pincer::grasp {

// Places for `model`'s fingers, all free.
FollowedShapes placesFor(const GraspModel& model);

// One look of a finger. A shape that isn't looked at is forgotten when the look ends; where more are near than there
// are places for, the nearest keep them, and the others are looked at as if never seen before. Allocates nothing.
class FingerFollower {
 public:
  // `spare` serves the shapes without a place.
  FingerFollower(FollowedShapes& all, int finger, contact::FingerTracker& spare);
  ~FingerFollower() { forgetOthers(); }
  FingerFollower(const FingerFollower&) = delete;
  FingerFollower& operator=(const FingerFollower&) = delete;

  // The memory of a shape (of model.world.colliders), for one query; it ends with noteGap.
  contact::FingerTracker& of(int collider);
  // The gap that the query found [m].
  void noteGap(double gap);

 private:
  int* colliders() { return all_.colliders.data() + first_; }
  void forgetOthers();
  int furthest() const;
  void take(int place, int collider, double gap);

  FollowedShapes& all_;
  const std::size_t first_;
  contact::FingerTracker& spare_;
  int collider_ = -1, place_ = -1;  // of the query
  unsigned looked_at_ = 0;          // bit per place
};

}  // namespace pincer::grasp
