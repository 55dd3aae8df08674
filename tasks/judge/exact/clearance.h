// clearance: a slider-crank whose slider has clearance in its guide, by events. SI units; no code of the engine.
//
// In the plane (x, y), gravity along -y; angles from the x axis: a_1 of the crank, a_2 of the rod, a_3 of the slider,
// which turns freely about the rod's end B:
//   B = l_1 (cos a_1, sin a_1) + l_2 (cos a_2, sin a_2)
//   M_11 = J_1 + (m_1/4 + m_2 + m_3) l_1^2,   M_12 = (m_2/2 + m_3) l_1 l_2 cos(a_1 - a_2)
//   M_22 = J_2 + (m_2/4 + m_3) l_2^2,         M_33 = J_3;   J about the centres of mass
//   M a'' = f,   f_1 = -k a_2'^2 - (m_1/2 + m_2 + m_3) g l_1 cos a_1,   f_2 = k a_1'^2 - (m_2/2 + m_3) g l_2 cos a_2,
//   f_3 = 0,     k = (m_2/2 + m_3) l_1 l_2 sin(a_1 - a_2)
// The slider's corners B + R(a_3) (s_x a, s_y b), s_x and s_y = +-1, stay between y = -(b + c) and y = b + c.
//
// Between events the smooth equations by Runge-Kutta's method at 5 us, where it's off by 1e-13 rad over a turn of the
// crank; an event's time by halving the step. Events: a corner hits, lifts off, stops sliding or begins to.
//   hit      u_n+ + e u_n- >= 0, Lambda_n >= 0, one of them 0; |Lambda_t| <= mu Lambda_n against u_t+
//            (Newton's and Coulomb's law, all corners that touch at once), by trying all ways to touch
//   touches  the same of accelerations, e = 0. Corners that would bounce at less than kLanding stay.
// Source: P. Flores, R. Leine, C. Glocker, Multibody Syst. Dyn. 23 (2010) 165-190; the parameters of its Table 1.
#pragma once
#include <array>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::exact {

struct ClearanceCrank {
  double crank = 0.153, rod = 0.306;                                             // l_1, l_2 [m]
  double half_length = 0.05, half_height = 0.025;                                // a, b of the slider [m]
  double clearance = 0.001;                                                      // c [m]
  double crank_mass = 0.038, rod_mass = 0.038, slider_mass = 0.076;              // m [kg]
  double crank_inertia = 7.4e-5, rod_inertia = 5.9e-4, slider_inertia = 2.7e-6;  // J [kg m^2]
  double restitution = 0.4, friction = 0.01, g = 9.81;                           // e [-], mu [-], [m/s^2]

  struct State {
    Vec3 angle = Vec3::Zero(), rate = Vec3::Zero();  // [rad], [rad/s]
  };
  struct Hit {
    double time;               // [s]
    std::vector<int> corners;  // that hit at once; 0, 1 the upper ones (s_x = -1, 1), 2, 3 the lower ones
  };
  struct Run {
    std::vector<State> states;  // at 0, step, 2 step ..
    std::vector<Hit> hits;
  };

  // From `start` until so many hits, at most to `longest` [s].
  Run run(const State& start, double step, int hits, double longest) const;

  Vec2 sliderCentre(const Vec3& angle) const;       // B [m]
  Vec2 corner(int which, const Vec3& angle) const;  // [m]
  double gap(int which, const Vec3& angle) const;   // to its side of the guide [m]
  double energy(const State& state) const;          // [J]
};

}  // namespace pincer::exact
