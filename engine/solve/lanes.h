// lanes: numbers side by side, two to a register, and loops of a known length written out.
#pragma once
#include <utility>

#include "pincer/engine/solve/mobility.h"

namespace pincer::engine {

// act(integral constant) for 0 .. n - 1
template <int n, class Act>
[[gnu::always_inline]] inline void times(const Act& act) {
  [&]<int... k>(std::integer_sequence<int, k...>) { (act(std::integral_constant<int, k>()), ...); }
  (std::make_integer_sequence<int, n>());
}

inline DoublePair& pairAt(double* p) { return *reinterpret_cast<DoublePair*>(p); }
inline const DoublePair& pairAt(const double* p) { return *reinterpret_cast<const DoublePair*>(p); }
inline double sumOf(DoublePair pair) { return pair[0] + pair[1]; }

}  // namespace pincer::engine
