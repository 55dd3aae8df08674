// held_body: a body that one pivot or slider holds to what never moves. It has one coordinate, and
// moves as that coordinate's equation says.
//
//   I th'' = m n . (r x g) - d th'  (pivot),    m th'' = m n . g - d th'  (slider)
//   th' = n . (L + r x m v) / I  or  n . v  at the start
//
//   n  the joint's axis;  r  from the pivot to the centre of mass [m];  I  about the axis [kg m^2]
//   d  the joint's damping;  L, v  of the body
//
// Without contact that is solved to round-off (motion/one_freedom.h). Contacts see the velocity that it leads to and
// one column of F (joints.h): (n x r, n)/sqrt(I') or (n, 0)/sqrt(I'), I' = I c h/(1 - exp(-c h)), c = d/I: of an
// impulse that comes during the tick the damper takes its part. Their change of th' is taken as a constant push, as for
// free bodies (decision 3): half of it acts on the way, with a damper a little more. The body is placed on its joint by
// the coordinate: nothing drifts, nothing is projected. Joints that bind several bodies: joints.h.
#pragma once
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// The body's motions at the start and, without contact, at the end of this part of the tick, its inertial frame in the
// middle, and F. Where nothing can touch it, only its coordinate.
void predictHeldBody(const WorldModel& model, const WorldState& state, const JointGroup& g, WorldScratch& scratch,
                     JointGroupScratch& group);

// Effect of the gathered contact impulses, the joint's answer included.
void gatherHeldBody(const WorldModel& model, const JointGroup& g, WorldScratch& scratch, JointGroupScratch& group);

// To the end of this part of the tick.
void advanceHeldBody(const WorldModel& model, const JointGroup& g, const JointGroupScratch& group, double h,
                     BodyScratch& scratch, BodyState& s);

// Where it is `t` after the start of this part of the tick, once its contacts are solved.
BodyState heldBodyAt(const WorldModel& model, const JointGroup& g, const JointGroupScratch& group,
                     const BodyScratch& scratch, const BodyState& s, double h, double t);

}  // namespace pincer::engine
