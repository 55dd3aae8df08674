// axis_form: which form the spring-damper of a driven point's axis takes, once for all ticks of one length.
//
// Fox and Goodwin's quadrature (predict.cpp) is stable up to omega h = sqrt(6); half of the first axis' own limit
// leaves room for what the contact adds. Beyond, the force is that at the end of the tick.
#pragma once
#include <array>

#include "pincer/engine/model.h"

namespace pincer::engine {

//   h  the tick [s], > 0
inline AxisForm axisFormOf(const DrivenPointModel& point, int axis, double h) {
  if (point.locked[axis]) return AxisForm::kLocked;
  const bool soft = point.stiffness[axis] * h * h <= 0.25 * point.mass && point.damping[axis] * h <= 0.5 * point.mass;
  return point.mass > 0 && soft ? AxisForm::kFourthOrder : AxisForm::kImplicit;
}

inline std::array<AxisForm, 3> axisFormsOf(const DrivenPointModel& point, double h) {
  return {axisFormOf(point, 0, h), axisFormOf(point, 1, h), axisFormOf(point, 2, h)};
}

}  // namespace pincer::engine
