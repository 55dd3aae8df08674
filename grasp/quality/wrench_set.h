// wrench_set: every wrench that a grasp can put on its body with normal forces that add up
// to 1 N at most (Ferrari & Canny's L1 set).
//
//   W = conv( {0} u { g_n,i + mu_i (s_1 g_1,i + s_2 g_2,i + s_3 g_3,i) : |s| <= 1 } ),   g:
//   columns of contact i, see grasp_contact.h
//
// Its support function is known in closed form, h(d) = max(0, max_i g_n,i . d + mu_i |(g_1,i . d, g_2,i . d, g_3,i .
// d)|): cones stay cones. Where a ray leaves W is a linear programme whose columns are all points of W's boundary; h
// prices them, one enters per pivot, and the dual is the normal of W there. The largest ball touches W where the ray
// along the normal leaves through that very point: from any direction, going on along the normal comes closer (each
// ray's exit is no further than the plane before). Sources: C. Ferrari, J. Canny, "Planning optimal grasps", ICRA 1992,
// 2290-2295; ray shooting after Y. Zheng, IEEE Trans. Robotics 29 (2013) 271-281.
#pragma once
#include <vector>

#include "pincer/grasp/quality/grasp_contact.h"

namespace pincer::grasp {

class WrenchSet {
 public:
  // Throws InputError if `rho` isn't positive. Torques about `p_WC`, the centre of mass.
  WrenchSet(const std::vector<GraspContact>& contacts, const Vec3& p_WC, double rho);

  // Dimensions in which the grasp can push at all, 0 .. 6; a pinch with two point contacts has 5:
  // it can't turn the body about their line.
  int rank() const { return static_cast<int>(basis_.cols()); }
  double support(const Vec6& d) const;  // h(d) [N]

  struct Ball {
    // of the largest ball about 0 within W: epsilon [N per N of summed normal force]; 0 without force closure
    double radius = 0;
    // unit direction in which the ball touches W's boundary: the wrench that is resisted least
    Vec6 weakest = Vec6::Zero();
  };
  // Searched from 12 + 52 directions: no proof that no other touches closer, but none
  // was found by brute force (the tests look).
  Ball largestBall() const;

  // Where the ray of `w` leaves W: the largest t with t w in W, 0 if no positive
  // multiple is; and W's normal there, unit.
  struct Exit {
    double t = 0;
    Vec6 normal = Vec6::Zero();
  };
  Exit shoot(const Vec6& w) const;

  // 6-dimensional volume (pi^3 / 6 times the mean of t^6 over directions), of 2000 directions:
  // good to some per cent. 0 without closure.
  double volume() const;

 private:
  Eigen::VectorXd extreme(const Vec6& d, double& h) const;
  std::vector<Vec6> searchDirections() const;

  std::vector<Eigen::Matrix<double, 6, 4>> columns_;
  std::vector<double> mu_;
  Eigen::MatrixXd basis_;  // orthonormal, of the space that the columns span
  double size_ = 0;        // of W: the furthest extreme point's distance
};

}  // namespace pincer::grasp
