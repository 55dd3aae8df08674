// core_descent: the place of a fingertip's core that is deepest in a shape, or nearest to it; the
// equation and its source: finger_query.h.
#pragma once
#include "pincer/contact/finger_query.h"

namespace pincer::contact {

struct CoreDescent {
  SurfaceContacts found;    // of a ball of the finger's rounding there
  Vec3 c_F = Vec3::Zero();  // the place [m]
  int queries = 0;
};

// From where `tracker` was, which it moves on. Allocates nothing, always ends.
CoreDescent descend(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin,
                    CoreTracker& tracker, PatchCache& cache);

}  // namespace pincer::contact
