// grasp_contact: where and how a grasp holds a body: what the measures of its quality start from.
//
// A finger's force on the body at p_W, in frame C (axes t1, t2, n; n out of the body), with a torsional moment about n:
//
//   f = t1 f_1 + t2 f_2 - n f_n,   tau = -n tau_n,   sqrt(f_1^2 + f_2^2 + (tau_n / e)^2) <= mu f_n,   f_n >= 0
//
// Wrench about the centre of mass c:  w = (f, ((p - c) x f + tau) / rho) [N], rho the length
//                                     that makes a torque comparable to a force.
// Sources: B. Mishra, J. T. Schwartz, M. Sharir, Algorithmica 2 (1987) 541-558 (grasp matrix); R. D. Howe, M. R.
// Cutkosky, Int. J. Robotics Res. 15 (1996) 554-572 (the soft finger's ellipsoid).
#pragma once
#include "pincer/grasp/grasp_quality.h"

namespace pincer::grasp {

// The columns of the grasp matrix that belong to one contact: wrenches [N] of unit f_n, f_1, f_2 [N] and unit tau_n / e
// [N]. The last is zero for a point contact.
Eigen::Matrix<double, 6, 4> graspColumns(const GraspContact& contact, const Vec3& p_WC, double rho);

}  // namespace pincer::grasp
