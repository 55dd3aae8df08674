// state_checks: what a tick asks of inputs and states as a whole.
#pragma once
#include "pincer/engine/step.h"

namespace pincer::engine {

bool isFinite(const MotionInput& in);
bool isFinite(const PointInput& in);
bool isFinite(const DriveInput& in);
bool isFinite(const WorldState& state);

// Largest distance of a body's point, or of a driven point, between two states [m].
double largestDistance(const WorldModel& model, const WorldState& a, const WorldState& b);

}  // namespace pincer::engine
