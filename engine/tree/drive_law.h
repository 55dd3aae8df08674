// drive_law: a tick of a spring, a damper or a drive along a length l, implicit in what it pushes.
//
//   M^ Du = .. + c p,   M^ = M + c c^T m^;     F = -k e - d e',   e = l - target,   l' = c . u
//
//   soft   h^2 k <= m/4 and h d <= m/2:   m^ = k h^2/12 + d h/2,
//          p = -k h (e + h l'/2 + h (t_1 - t_0)/6 - s/2) - d (h l' - s)
//   stiff  force at the tick's end:       m^ = h d + h^2 k theta,   p = -k h (e + h l' - s) - h d (l' - t_1)
//
//   m      1/(c^T M^-1 c), the least inertia that l can feel
//   s      the target's way in the tick;  t_0, t_1  its rate at both ends
//   theta  1/2, the mean; more where k alone is so stiff that e would ring: what e and h l'
//          were off by falls by 1/sqrt 3 per tick then
//
// All let rest what rests where k e is the load. Soft: order 4 in k, 2 in d; L. Fox, E. T. Goodwin, Proc. Camb. Phil.
// Soc. 45 (1949) 373-388. Beside stiff elements of a tree m^ = k h^2/4 + d h/2, of order 2, which keeps the energy.
// Stiff: needs no mass; order 2 where damping outweighs inertia.
#pragma once

namespace pincer::engine {

struct ElementTick {
  double k = 0, d = 0;                           // >= 0
  double e = 0, rate = 0;                        // l - target and l' at the start
  double way = 0, start_rate = 0, end_rate = 0;  // of the target
  double h = 0;                                  // > 0
};

struct ImpliedInertia {
  double mass = 0, impulse = 0;  // m^, p
};

bool isSoft(double k, double d, double m, double h);
ImpliedInertia softLaw(const ElementTick& t);
// Added to m^ of a soft spring, h^2 k/12, it is that of the force in the middle, h^2 k/4.
inline double middleMass(double k, double h) { return k * h * h / 6; }
ImpliedInertia stiffLaw(const ElementTick& t, double m);

}  // namespace pincer::engine
