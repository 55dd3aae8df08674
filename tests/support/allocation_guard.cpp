#include "pincer/tests/support/allocation_guard.h"

#include <cerrno>
#include <cstddef>

#include "pincer/tests/support/effort.h"

namespace pincer::tests {
namespace {
thread_local std::int64_t count = 0;
}

std::int64_t allocationCount() { return count; }
bool allocationsAreCounted() { return !PINCER_SANITIZED; }

#if !PINCER_SANITIZED
namespace {
void countOne() { ++count; }
}  // namespace
}  // namespace pincer::tests

// The C library lets a program replace its allocator; these count and pass on. operator new calls malloc.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  pincer::tests::countOne();
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  pincer::tests::countOne();
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t size) {
  pincer::tests::countOne();
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  pincer::tests::countOne();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  pincer::tests::countOne();
  *p = __libc_memalign(alignment, size);
  return *p ? 0 : ENOMEM;
}
}
namespace pincer::tests {
#endif
}  // namespace pincer::tests
