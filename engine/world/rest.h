// rest: what has come to rest stays there to the bit, and a tick that would repeat the last one isn't computed.
//
// At rest is a body or point on which contacts push whose impulses of the last tick still obey the contact
// law (no iteration was needed), and which is slower than kRestSpeed, now and a tick ago: its velocity
// becomes 0 and its pose stays (advance.cpp). What that takes away is less than what the solver's tolerance
// leaves open. It holds whether sleep is on or off.
//
// Sleep is exact, no heuristic: a tick is a function of state and inputs. Where it ended in the state that
// it started from, bit by bit, the next one from the same state with the same inputs does so too. Any change
// of either (a finger, a target, a force, a driven body, a state set from outside) is a difference, and the
// tick is computed. Costs a comparison of the
// state. Of a world that isn't at rest as a whole, islands sleep (island_sleep.h).
#pragma once
#include <limits>

#include "pincer/engine/world/stages.h"

namespace pincer::engine {

constexpr double kRestSpeed = 1e-13;  // 3 um in a year [m/s]

// How fast links that stand still may be [m/s]: coordinates of some radians or metres are rounded, which drives answer;
// anything slower than an ulp per tick doesn't move them. 30 um in a year with ticks of 1 ms.
inline double linkNoise(double h) { return 4 * std::numeric_limits<double>::epsilon() / h; }

// To the bit, but for the sign of zeros.
bool same(const BodyState& a, const BodyState& b);
bool same(const ContactMemory& a, const ContactMemory& b);
bool same(const MotionInput& a, const MotionInput& b);

// True if the tick from `state` with these inputs ends where it starts.
bool repeatsItself(const WorldModel& model, const WorldState& state, const WorldScratch& scratch,
                   const StepInputs& inputs);

// Notes how a tick with these inputs ended. `calm`: nothing happened in it that state and inputs don't show.
void noteRest(const WorldState& state, const StepInputs& inputs, bool calm, WorldScratch& scratch);

}  // namespace pincer::engine
