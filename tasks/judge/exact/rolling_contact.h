// rolling_contact: how fast a contact moves over two surfaces that roll and slide
// on each other, in the plane of the motion.
//
//   s_f' = (w - k_b v) / (k_f + k_b)
//
//   s_f'  of the contact over the finger [m/s];  k_f, k_b  curvatures of finger and body [1/m], 0 for a plane
//   w  angular velocity of the finger relative to the body, about the axis in the tangent plane [rad/s];
//      v  slip of the finger past the body [m/s]
// Source: D. J. Montana, "The kinematics of contact and grasp", Int. J. Robotics Res. 7(3),
// 1988, 17-32, eq. (14)-(15), in one direction.
#pragma once

namespace pincer::tasks::exact {

inline double contactSpeedOnFinger(double k_f, double k_b, double w, double v) { return (w - k_b * v) / (k_f + k_b); }

}  // namespace pincer::tasks::exact
