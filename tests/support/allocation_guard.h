// allocation_guard: counts heap allocations of this thread, whoever makes them (operator new, Eigen, the C library).
#pragma once
#include <cstdint>

namespace pincer::tests {

// Allocations by this thread since it started. Always 0 under AddressSanitizer and
// ThreadSanitizer, which own the allocator.
std::int64_t allocationCount();

// True if this build can count.
bool allocationsAreCounted();

}  // namespace pincer::tests
