// hollow_inertia: driven points in hollows hardly wider than themselves.
//
//   kappa = -dn . dp / |dp|^2,     m_g = max(0, 3/4 h^2 f kappa - (m + h d) / 2)
//   v_free' = (M v_free + m_g v) / (M + m_g),     1/M' = 1/(M + m_g)
//
//   dn, dp   turn of the contact's normal and way of the point, in the body, from the middle of the last
//            part of a tick to that of this one [-, m]
//   kappa    curvature of what the point's centre runs in, 1/(R - r) for a ball of r in a hollow of
//            R [1/m]; 0 on anything that isn't hollow
//   f        normal force of the last tick [N];  m, d  mass and damping of the coupling [kg, N s/m]
//   M        its effective mass [kg], predict.cpp
//
// A turning normal pushes back with the stiffness f kappa, which a tick takes at its middle as it is. On its own the
// coupling has only k: pressed in by L the point swings by lambda = f kappa / k = L / (R - r) times its way to the
// other side, ever further where that is more than its damping can bear, until it leaves through the wall. m_g bounds
// that: the eigenvalues of the linear tick stay below 1 for any lambda up to 30 and any d, with kappa wrong by 40 % to
// either side (decision 17). What moves evenly, or rests, doesn't feel m_g; couplings with d > 3/2 h f kappa have none.
#pragma once
#include "pincer/engine/model.h"
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// After the contacts were recalled, before they are filled. Allocates nothing.
void steadyInHollows(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

}  // namespace pincer::engine
