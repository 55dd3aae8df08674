// A library to be preloaded (LD_PRELOAD): the N-th call of one function of the C library fails, as on a
// full disk or a table of files that is full.
//
//   CAMPAIGN_FAIL_CALL=write      the function; "any": any of those below
//   CAMPAIGN_FAIL_AT=3            the third call fails; with CAMPAIGN_FAIL_FOREVER set, all from there on
//   CAMPAIGN_FAIL_ERROR=28        with this errno; 0: half of what was to be written is
//   CAMPAIGN_FAIL_LOG=FILE        made when a call fails
//   CAMPAIGN_COUNT_CALLS=FILE     at its end, a line "NAME COUNT" for each that was called
//
// Only in the program named pincer, not in what it starts; never on the
// standard streams, which have a row of their own.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>

namespace {

struct Plan {
  const char* call = nullptr;
  long at = 0;
  int error = 0;
  bool forever = false;
  const char* log = nullptr;
};

bool isHere() { return std::strcmp(program_invocation_short_name, "pincer") == 0; }

Plan planned() {
  const char* call = std::getenv("CAMPAIGN_FAIL_CALL");
  const char* at = std::getenv("CAMPAIGN_FAIL_AT");
  const char* error = std::getenv("CAMPAIGN_FAIL_ERROR");
  if (!isHere() || call == nullptr || at == nullptr || error == nullptr) return {};
  return {call, std::atol(at), std::atoi(error), std::getenv("CAMPAIGN_FAIL_FOREVER") != nullptr,
          std::getenv("CAMPAIGN_FAIL_LOG")};
}

const Plan& plan() {
  static const Plan kPlan = planned();
  return kPlan;
}

constexpr const char* kCalls[] = {"write", "close", "read",  "fsync", "rename",    "unlink",
                                  "mkdir", "open",  "start", "mmap",  "ftruncate", "thread"};
std::atomic<long> g_counts[std::size(kCalls)];
std::atomic<long> g_calls{0};

void count(const char* call) {
  for (std::size_t i = 0; i < std::size(kCalls); ++i) {
    if (std::strcmp(kCalls[i], call) == 0) ++g_counts[i];
  }
}

__attribute__((destructor)) void writeCounts() {
  const char* path = std::getenv("CAMPAIGN_COUNT_CALLS");
  if (!isHere() || path == nullptr) return;
  const long file = ::syscall(SYS_openat, AT_FDCWD, path, O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644);
  for (std::size_t i = 0; i < std::size(kCalls); ++i) {
    char line[64];
    const int length = std::snprintf(line, sizeof line, "%s %ld\n", kCalls[i], g_counts[i].load());
    ::syscall(SYS_write, file, line, length);
  }
  ::syscall(SYS_close, file);
}

void note() {
  if (plan().log == nullptr) return;
  const long file = ::syscall(SYS_openat, AT_FDCWD, plan().log, O_CREAT | O_WRONLY | O_CLOEXEC, 0644);
  if (file >= 0) ::syscall(SYS_close, file);
}

// True if this call is the one; errno is set.
bool fails(const char* call) {
  count(call);
  if (plan().call == nullptr || (std::strcmp(plan().call, call) != 0 && std::strcmp(plan().call, "any") != 0))
    return false;
  const long n = ++g_calls;
  if (plan().forever ? n < plan().at : n != plan().at) return false;
  note();
  errno = plan().error;
  return true;
}

bool isStandard(int file) { return file <= 2; }
bool isStandard(FILE* file) { return file == stdout || file == stderr || file == stdin; }

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

mode_t modeIn(int flags, va_list more) { return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0; }

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t n) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (isStandard(file) || !fails("write")) return real(file, bytes, n);
  return plan().error == 0 ? real(file, bytes, (n + 1) / 2) : -1;
}
ssize_t pwrite64(int file, const void* bytes, size_t n, off64_t at) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  if (!fails("write")) return real(file, bytes, n, at);
  return plan().error == 0 ? real(file, bytes, (n + 1) / 2, at) : -1;
}
ssize_t pwrite(int file, const void* bytes, size_t n, off_t at) { return pwrite64(file, bytes, n, at); }
size_t fwrite(const void* bytes, size_t size, size_t n, FILE* file) {
  static const auto real = next<size_t (*)(const void*, size_t, size_t, FILE*)>("fwrite");
  if (isStandard(file) || !fails("write")) return real(bytes, size, n, file);
  return real(bytes, size, (n + 1) / 2, file);
}
int fflush(FILE* file) {
  static const auto real = next<int (*)(FILE*)>("fflush");
  return file == nullptr || isStandard(file) || !fails("write") ? real(file) : EOF;
}
int fclose(FILE* file) {
  static const auto real = next<int (*)(FILE*)>("fclose");
  const bool failing = !isStandard(file) && fails("close");
  const int error = errno;
  const int result = real(file);
  if (failing) errno = error;
  return failing ? EOF : result;
}
ssize_t read(int file, void* bytes, size_t n) {
  static const auto real = next<ssize_t (*)(int, void*, size_t)>("read");
  return isStandard(file) || !fails("read") ? real(file, bytes, n) : -1;
}
ssize_t pread64(int file, void* bytes, size_t n, off64_t at) {
  static const auto real = next<ssize_t (*)(int, void*, size_t, off64_t)>("pread64");
  return fails("read") ? -1 : real(file, bytes, n, at);
}
ssize_t pread(int file, void* bytes, size_t n, off_t at) { return pread64(file, bytes, n, at); }
size_t fread(void* bytes, size_t size, size_t n, FILE* file) {
  static const auto real = next<size_t (*)(void*, size_t, size_t, FILE*)>("fread");
  return isStandard(file) || !fails("read") ? real(bytes, size, n, file) : 0;
}
int fsync(int file) {
  static const auto real = next<int (*)(int)>("fsync");
  return fails("fsync") ? -1 : real(file);
}
int fdatasync(int file) {
  static const auto real = next<int (*)(int)>("fdatasync");
  return fails("fsync") ? -1 : real(file);
}
int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return fails("rename") ? -1 : real(from, to);
}
int unlink(const char* path) noexcept {
  static const auto real = next<int (*)(const char*)>("unlink");
  return fails("unlink") ? -1 : real(path);
}
int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = next<int (*)(const char*, mode_t)>("mkdir");
  return fails("mkdir") ? -1 : real(path, mode);
}
int open64(const char* path, int flags, ...) {
  static const auto real = next<int (*)(const char*, int, ...)>("open64");
  va_list more;
  va_start(more, flags);
  const mode_t mode = modeIn(flags, more);
  va_end(more);
  return fails("open") ? -1 : real(path, flags, mode);
}
int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = modeIn(flags, more);
  va_end(more);
  return open64(path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
  static const auto real = next<int (*)(int, const char*, int, ...)>("openat64");
  va_list more;
  va_start(more, flags);
  const mode_t mode = modeIn(flags, more);
  va_end(more);
  return fails("open") ? -1 : real(folder, path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = modeIn(flags, more);
  va_end(more);
  return openat64(folder, path, flags, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  static const auto real = next<FILE* (*)(const char*, const char*)>("fopen64");
  return fails("open") ? nullptr : real(path, mode);
}
FILE* fopen(const char* path, const char* mode) { return fopen64(path, mode); }
FILE* popen(const char* command, const char* mode) {
  static const auto real = next<FILE* (*)(const char*, const char*)>("popen");
  return fails("start") ? nullptr : real(command, mode);
}
void* mmap64(void* at, size_t n, int protection, int flags, int file, off64_t offset) noexcept {
  static const auto real = next<void* (*)(void*, size_t, int, int, int, off64_t)>("mmap64");
  return fails("mmap") ? MAP_FAILED : real(at, n, protection, flags, file, offset);
}
void* mmap(void* at, size_t n, int protection, int flags, int file, off_t offset) noexcept {
  return mmap64(at, n, protection, flags, file, offset);
}
int ftruncate64(int file, off64_t size) noexcept {
  static const auto real = next<int (*)(int, off64_t)>("ftruncate64");
  return fails("ftruncate") ? -1 : real(file, size);
}
int ftruncate(int file, off_t size) noexcept { return ftruncate64(file, size); }
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*), void* with) noexcept {
  static const auto real = next<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  return fails("thread") ? EAGAIN : real(thread, attributes, work, with);
}

}  // extern "C"
