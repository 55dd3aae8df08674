// wide: loops over numbers side by side, four to an instruction where the processor has them (AVX2), else two.
//
// Each number goes through the same operations in the same order either way, and FMA stays out: the same bits.
#pragma once

namespace pincer::engine {

using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
constexpr int kFour = 4;  // numbers of it

[[gnu::always_inline]] inline Four& fourAt(double* p) { return *reinterpret_cast<Four*>(p); }
[[gnu::always_inline]] inline const Four& fourAt(const double* p) { return *reinterpret_cast<const Four*>(p); }

// act(), a lambda that is always inlined, compiled once for either kind of processor.
#if defined(__x86_64__)
template <class Act>
[[gnu::target("avx2"), gnu::noinline]] auto withFourLanes(const Act& act) {
  return act();
}
template <class Act>
auto wide(const Act& act) {
  return __builtin_cpu_supports("avx2") ? withFourLanes(act) : act();
}
#else
template <class Act>
auto wide(const Act& act) {
  return act();
}
#endif

}  // namespace pincer::engine
