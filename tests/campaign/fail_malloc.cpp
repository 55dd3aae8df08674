// fail_malloc: preloaded into pincer (LD_PRELOAD), lets an allocation fail: malloc, calloc, realloc
// and all that call them, operator new too.
//
//   PINCER_FAIL_MALLOC=N      the N-th allocation since the program's libraries were loaded, and no other
//   PINCER_FAIL_MALLOC=N+     it and all that follow, in every thread
//   PINCER_COUNT_MALLOC=FILE  writes to FILE how many there were
//
// Other programs that pincer starts are left alone.
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> g_count{0};  // an allocator has no other place
long g_first = 0;
bool g_on = false, g_active = false;

bool fails() {
  if (!g_active) return false;
  const long number = ++g_count;
  if (g_first == 0 || number < g_first || (number > g_first && !g_on)) return false;
  errno = ENOMEM;
  return true;
}

__attribute__((constructor)) void begin() {
  if (std::strcmp(program_invocation_short_name, "pincer") != 0) return;
  if (const char* which = std::getenv("PINCER_FAIL_MALLOC")) {
    char* rest = nullptr;
    g_first = std::strtol(which, &rest, 10);
    g_on = *rest == '+';
  }
  g_active = true;
}

__attribute__((destructor)) void end() {
  const char* path = std::getenv("PINCER_COUNT_MALLOC");
  if (!g_active || !path) return;
  g_active = false;
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%ld\n", g_count.load());
  const int file = ::open(path, O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644);
  [[maybe_unused]] const auto written = ::write(file, text, static_cast<std::size_t>(length));
  ::close(file);
}

}  // namespace

// The C library lets a program replace its allocator; these pass on.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) { return fails() ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t n, std::size_t size) { return fails() ? nullptr : __libc_calloc(n, size); }
void* realloc(void* p, std::size_t size) { return fails() ? nullptr : __libc_realloc(p, size); }
void* memalign(std::size_t alignment, std::size_t size) { return fails() ? nullptr : __libc_memalign(alignment, size); }
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails() ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  if (fails()) return ENOMEM;
  *p = __libc_memalign(alignment, size);
  return *p ? 0 : ENOMEM;
}
}
