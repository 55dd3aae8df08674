// wide: loops over numbers side by side, four to an instruction where the processor has them (AVX2), else two.
//
// Each number goes through the same operations in the same order either way, and FMA stays out: the same bits.
#pragma once
#include "pincer/engine/solve/lanes.h"

namespace pincer::engine {

struct TwoLanes {
  static constexpr int count = 2;
  using Numbers = DoublePair;
  [[gnu::always_inline]] static Numbers& at(double* p) { return *reinterpret_cast<Numbers*>(p); }
  [[gnu::always_inline]] static const Numbers& at(const double* p) { return *reinterpret_cast<const Numbers*>(p); }
};
// (Templates over the type itself would forget the alignment.)
struct FourLanes {
  static constexpr int count = 4;
  using Numbers [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
  [[gnu::always_inline]] static Numbers& at(double* p) { return *reinterpret_cast<Numbers*>(p); }
  [[gnu::always_inline]] static const Numbers& at(const double* p) { return *reinterpret_cast<const Numbers*>(p); }
};

// act(lanes), a lambda that is always inlined, compiled once for either kind of processor. By clang, which reads local
// lanes as if they were aligned, with two of them: so that tests/golden compares the bits of both.
#if defined(__x86_64__) && !defined(__clang__)
template <class Act>
[[gnu::target("avx2"), gnu::noinline]] auto withFourLanes(const Act& act) {
  return act(FourLanes());
}
template <class Act>
auto wide(const Act& act) {
  return __builtin_cpu_supports("avx2") ? withFourLanes(act) : act(TwoLanes());
}
#else
template <class Act>
auto wide(const Act& act) {
  return act(TwoLanes());
}
#endif

}  // namespace pincer::engine
