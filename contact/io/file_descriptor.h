// file_descriptor: an open file of the system, closed with its owner, and the lock that dies with the process.
//
// The lock is an "open file description" lock (fcntl(2), F_OFD_SETLK): it belongs to this opening of the file and
// not to the process. So a second opening in the same process meets it as another program would, and closing some
// other descriptor of the file leaves it in place (POSIX record locks, SQLite's among them, are lost that way).
// Whatever ends the process frees it, kill -9 too.
#pragma once
#include <utility>

namespace pincer {

class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int file) : file_(file) {}
  FileDescriptor(FileDescriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~FileDescriptor();
  int get() const { return file_; }
  explicit operator bool() const { return file_ >= 0; }

 private:
  int file_ = -1;
};

enum class LockAttempt { kLocked, kHeldByAnother, kFailed };  // kFailed: errno says why

// Locks the whole file for this opening, without waiting. The file must be open for writing.
LockAttempt tryLock(const FileDescriptor& file);

// True if another opening holds the lock. The file may be open for reading only.
bool isLocked(const FileDescriptor& file);

}  // namespace pincer
