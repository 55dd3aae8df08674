#include "pincer/contact/io/file_descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace pincer {
namespace {

struct flock wholeFile() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (file_ >= 0) ::close(file_);
}

LockAttempt tryLock(const FileDescriptor& file) {
  struct flock lock = wholeFile();
  if (::fcntl(file.get(), F_OFD_SETLK, &lock) == 0) return LockAttempt::kLocked;
  return errno == EAGAIN || errno == EACCES ? LockAttempt::kHeldByAnother : LockAttempt::kFailed;
}

bool isLocked(const FileDescriptor& file) {
  struct flock lock = wholeFile();
  return ::fcntl(file.get(), F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

}  // namespace pincer
