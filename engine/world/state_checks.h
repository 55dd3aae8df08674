// state_checks: what a tick asks of inputs and states as a whole.
#pragma once
#include "pincer/engine/step.h"

namespace pincer::engine {

bool isFinite(const MotionInput& in);
bool isFinite(const PointInput& in);
bool isFinite(const DriveInput& in);
bool isFinite(const WorldState& state);

// How far a point of a body, or a driven point, is from where it is in the other state, at most [m].
double largestDistance(const WorldModel& model, const WorldState& a, const WorldState& b);

}  // namespace pincer::engine
