#include "pincer/grasp/tick/followed_shapes.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"

namespace pincer::grasp {
namespace {

// Spheres find their contact with closed forms from nothing.
int shapesToFollow(const GraspModel& model, const FingerModel& finger) {
  const int shapes = static_cast<int>(model.world.colliders.size());
  if (finger.shape) return shapes;
  int meshes = 0;
  for (int i = 0; i < shapes; ++i) meshes += std::holds_alternative<contact::Mesh>(feltShape(model, i));
  return meshes;
}

}  // namespace

FollowedShapes placesFor(const GraspModel& model) {
  FollowedShapes all;
  for (const FingerModel& finger : model.fingers)
    all.per_finger = std::max(all.per_finger, shapesToFollow(model, finger));
  all.per_finger = std::min(all.per_finger, FollowedShapes::kMost);
  const std::size_t places = model.fingers.size() * static_cast<std::size_t>(all.per_finger);
  all.colliders.assign(places, -1);
  all.gaps.assign(places, 0);
  all.trackers.resize(places);
  return all;
}

FingerFollower::FingerFollower(FollowedShapes& all, int finger, contact::FingerTracker& spare)
    : all_(all), first_(static_cast<std::size_t>(finger) * static_cast<std::size_t>(all.per_finger)), spare_(spare) {
  PINCER_ASSERT(finger >= 0 && first_ + static_cast<std::size_t>(all.per_finger) <= all.trackers.size());
}

contact::FingerTracker& FingerFollower::of(int collider) {
  PINCER_ASSERT(collider >= 0);
  collider_ = collider;
  int* const end = colliders() + all_.per_finger;
  const int* place = std::find(colliders(), end, collider);
  const bool is_new = place == end;
  if (is_new) place = std::find(colliders(), end, -1);
  place_ = place == end ? -1 : static_cast<int>(place - colliders());
  contact::FingerTracker& tracker = place_ < 0 ? spare_ : all_.trackers[first_ + static_cast<std::size_t>(place_)];
  if (is_new) tracker = {};
  // the spare one's behind all others'
  const std::size_t memory = place_ < 0 ? all_.trackers.size() : first_ + static_cast<std::size_t>(place_);
  tracker.main.ball.memory = static_cast<std::uint32_t>(memory * contact::FingerTracker::kMemories);
  return tracker;
}

void FingerFollower::noteGap(double gap) {
  if (place_ >= 0) return take(place_, collider_, gap);
  const int place = furthest();
  if (!(all_.gaps[first_ + static_cast<std::size_t>(place)] > gap)) return;
  all_.trackers[first_ + static_cast<std::size_t>(place)] = spare_;
  take(place, collider_, gap);
}

void FingerFollower::take(int place, int collider, double gap) {
  const std::size_t at = first_ + static_cast<std::size_t>(place);
  all_.colliders[at] = collider;
  all_.gaps[at] = gap;
  looked_at_ |= 1u << place;
}

int FingerFollower::furthest() const {
  PINCER_ASSERT(all_.per_finger > 0);
  const double* const gaps = all_.gaps.data() + first_;
  return static_cast<int>(std::max_element(gaps, gaps + all_.per_finger) - gaps);
}

void FingerFollower::forgetOthers() {
  for (int place = 0; place < all_.per_finger; ++place) {
    if (!(looked_at_ >> place & 1)) colliders()[place] = -1;
  }
}

}  // namespace pincer::grasp
