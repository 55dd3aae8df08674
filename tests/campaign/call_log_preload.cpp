// A library to be preloaded (LD_PRELOAD) into pincer: keeps every write and every fsync, with its
// bytes, in their order. So a test can make the file that a power cut would have left at any
// moment (tests/process/durability_test.cpp).
//
//   PINCER_CALL_LOG=FILE   records, one after the other:
//     write INODE OFFSET SIZE PATH\n and the bytes     cut INODE LENGTH PATH\n     sync INODE PATH\n     unlink PATH\n
//
// Only of files below the folder of FILE, and not of FILE itself.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace {

// The system's own calls: the library's are those below.
class Log {
 public:
  Log() {
    const char* path = std::getenv("PINCER_CALL_LOG");
    const char* slash = path == nullptr ? nullptr : std::strrchr(path, '/');
    if (slash == nullptr || std::strcmp(program_invocation_short_name, "pincer") != 0) return;
    folder_ = path;
    folder_length_ = static_cast<std::size_t>(slash - path) + 1;
    file_ = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644));
  }

  bool keeps(const char* path) const {
    return file_ >= 0 && std::strncmp(path, folder_, folder_length_) == 0 && std::strcmp(path, folder_) != 0;
  }
  // The path of an open file, where it is to be logged.
  bool keeps(int file, char (&path)[1024], unsigned long& inode) const {
    if (file_ < 0) return false;
    char link[64];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t length = ::readlink(link, path, sizeof path - 1);
    if (length <= 0) return false;
    path[length] = 0;
    struct stat status {};
    if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return false;
    inode = status.st_ino;
    return keeps(path);
  }
  void put(const char* head, const void* bytes = nullptr, std::size_t n = 0) {
    const std::lock_guard lock(mutex_);
    ::syscall(SYS_write, file_, head, std::strlen(head));
    if (n > 0) ::syscall(SYS_write, file_, bytes, n);
  }

 private:
  const char* folder_ = nullptr;
  std::size_t folder_length_ = 0;
  int file_ = -1;
  std::mutex mutex_;
};

Log& log() {
  static Log the_log;
  return the_log;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

void noteWrite(int file, const void* bytes, ssize_t n, long offset) {
  char path[1024], head[1200];
  unsigned long inode = 0;
  if (n <= 0 || !log().keeps(file, path, inode)) return;
  std::snprintf(head, sizeof head, "write %lu %ld %zd %s\n", inode, offset, n, path);
  log().put(head, bytes, static_cast<std::size_t>(n));
}

void noteCut(int file, long length) {
  char path[1024], head[1200];
  unsigned long inode = 0;
  if (!log().keeps(file, path, inode)) return;
  std::snprintf(head, sizeof head, "cut %lu %ld %s\n", inode, length, path);
  log().put(head);
}

void noteSync(int file) {
  char path[1024], head[1200];
  unsigned long inode = 0;
  if (!log().keeps(file, path, inode)) return;
  std::snprintf(head, sizeof head, "sync %lu %s\n", inode, path);
  log().put(head);
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t n) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  const ssize_t written = real(file, bytes, n);
  const int error = errno;
  if (file > 2 && written > 0) noteWrite(file, bytes, written, ::lseek(file, 0, SEEK_CUR) - written);
  errno = error;
  return written;
}
ssize_t pwrite64(int file, const void* bytes, size_t n, off64_t at) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  const ssize_t written = real(file, bytes, n, at);
  const int error = errno;
  noteWrite(file, bytes, written, at);
  errno = error;
  return written;
}
ssize_t pwrite(int file, const void* bytes, size_t n, off_t at) { return pwrite64(file, bytes, n, at); }
int ftruncate64(int file, off64_t size) noexcept {
  static const auto real = next<int (*)(int, off64_t)>("ftruncate64");
  const int result = real(file, size);
  if (result == 0) noteCut(file, size);
  return result;
}
int ftruncate(int file, off_t size) noexcept { return ftruncate64(file, size); }
int fsync(int file) {
  static const auto real = next<int (*)(int)>("fsync");
  const int result = real(file);
  if (result == 0) noteSync(file);
  return result;
}
int fdatasync(int file) {
  static const auto real = next<int (*)(int)>("fdatasync");
  const int result = real(file);
  if (result == 0) noteSync(file);
  return result;
}
int unlink(const char* path) noexcept {
  static const auto real = next<int (*)(const char*)>("unlink");
  const int result = real(path);
  char head[1200];
  std::snprintf(head, sizeof head, "unlink %s\n", path);
  if (result == 0 && log().keeps(path)) log().put(head);
  return result;
}

}  // extern "C"
