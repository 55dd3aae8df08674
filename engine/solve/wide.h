// wide: loops over numbers side by side, four to an instruction where the processor has them (AVX2), else two
// or, by clang, one: tests/golden compares the bits, and switches AVX2 off as the C library lets it.
//
// Each number goes through the same operations in the same order either way, and FMA stays out: the same bits.
#pragma once
#include "pincer/engine/solve/lanes.h"

#if defined(__x86_64__) && !defined(__clang__) && __has_include(<sys/platform/x86.h>)
#include <sys/platform/x86.h>
#endif

namespace pincer::engine {

// By clang one: where templates name a type, it reads numbers as if they were aligned, and crashes.
struct NarrowLanes {
#if defined(__clang__)
  static constexpr int count = 1;
  using Numbers = double;
#else
  static constexpr int count = 2;
  using Numbers = DoublePair;
#endif
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

// act(lanes), a lambda that is always inlined, compiled once for either kind of processor.
#if defined(__x86_64__) && !defined(__clang__)
#if defined(CPU_FEATURE_ACTIVE)
inline const bool kProcessorHasFour = CPU_FEATURE_ACTIVE(AVX2);
#else
inline const bool kProcessorHasFour = __builtin_cpu_supports("avx2");
#endif
template <class Act>
[[gnu::target("avx2"), gnu::noinline]] auto withFourLanes(const Act& act) {
  return act(FourLanes());
}
template <class Act>
auto wide(const Act& act) {
  return kProcessorHasFour ? withFourLanes(act) : act(NarrowLanes());
}
#else
template <class Act>
auto wide(const Act& act) {
  return act(NarrowLanes());
}
#endif

}  // namespace pincer::engine
