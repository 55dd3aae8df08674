// colliders: a body's shapes where the body is, and those of two bodies pair by pair.
#pragma once
#include "pincer/engine/model.h"

namespace pincer::engine {

// X_WS, of a body at X_WB. Where S is B, X_WB to the bit.
inline Pose poseOf(const ColliderModel& collider, const Pose& X_WB) {
  return collider.is_posed ? X_WB * collider.X_BS : X_WB;
}

inline bool isSphere(const ColliderModel& collider) { return std::holds_alternative<contact::Sphere>(collider.shape); }
inline bool isPlane(const ColliderModel& collider) {
  return std::holds_alternative<contact::HalfSpace>(collider.shape);
}

// The only shape of a body whose frame is its own, null for others.
inline const ColliderModel* loneCollider(const WorldModel& model, const BodyModel& body) {
  const ColliderModel& first = model.colliders[body.first_collider];
  return body.collider_count == 1 && !first.is_posed ? &first : nullptr;
}

// True if some shape of one body may touch some shape of the other, by their bits.
bool mayTouch(const WorldModel& model, int a, int b);

// True if the two are further apart than `margin`, by their spheres and planes. False doesn't say that they aren't.
bool areApart(const ColliderModel& a, const Pose& X_WA, const ColliderModel& b, const Pose& X_WB, double margin);

// f(collider, its X_WS, collider, its X_WS) for the shapes of bodies a and b at these poses, in order of
// theirs, that may touch and aren't apart.
template <class F>
void forEachNearShapes(const WorldModel& model, const BodyModel& a, const Pose& X_WA, const BodyModel& b,
                       const Pose& X_WB, double margin, F f) {
  const ColliderModel *const lone_a = loneCollider(model, a), *const lone_b = loneCollider(model, b);
  if (lone_a && lone_b) {  // whose bounds are the bodies', which have been looked at
    if (mayTouch(lone_a->bits, lone_b->bits)) f(*lone_a, X_WA, *lone_b, X_WB);
    return;
  }
  for (const ColliderModel& ca : collidersOf(model, a)) {
    const Pose X_WSa = poseOf(ca, X_WA);
    for (const ColliderModel& cb : collidersOf(model, b)) {
      if (!mayTouch(ca.bits, cb.bits)) continue;
      const Pose X_WSb = poseOf(cb, X_WB);
      if (!areApart(ca, X_WSa, cb, X_WSb, margin)) f(ca, X_WSa, cb, X_WSb);
    }
  }
}

}  // namespace pincer::engine
