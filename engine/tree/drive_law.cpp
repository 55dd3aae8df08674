#include "pincer/engine/tree/drive_law.h"

#include <algorithm>

#include "pincer/engine/tree/slot.h"

namespace pincer::engine {

// At m/4 the error of the frequency is (h^2 k/m)^2/480, 1e-4, and the scheme is far
// from its limit of stability, h^2 k = 6 m.
bool isSoft(double k, double d, double m, double h) { return h * h * k <= 0.25 * m && h * d <= 0.5 * m; }

ImpliedInertia softLaw(const ElementTick& t) {
  const double spring = t.k * t.h * (t.e + t.h * (0.5 * t.rate + (t.end_rate - t.start_rate) / 6) - 0.5 * t.way);
  return {t.k * t.h * t.h / 12 + 0.5 * t.d * t.h, -spring - t.d * (t.h * t.rate - t.way)};
}

ImpliedInertia stiffLaw(const ElementTick& t, double m) {
  const double stiff = t.h * t.h * t.k;
  // The error of that moment goes on with at most a third of its rate, turned round (predict.cpp, shareOfEnd).
  const double theta = stiff > 0 ? std::max(0.5, 0.75 - (m + 0.25 * t.h * t.d) / stiff) : 0.5;
  const double spring = t.k * t.h * (t.e + t.h * t.rate - t.way);
  return {t.h * t.d + stiff * theta, -spring - t.h * t.d * (t.rate - t.end_rate)};
}

}  // namespace pincer::engine
