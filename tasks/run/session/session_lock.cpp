#include "pincer/tasks/run/session/session_lock.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <string_view>

#include "pincer/contact/error.h"
#include "pincer/contact/io/part_file.h"

namespace pincer::tasks {
namespace {

// Links are followed, as SQLite follows them: by whatever name a session is opened, its lock is one file.
std::string lockPathOf(const std::string& session) {
  std::error_code ignored;
  const std::filesystem::path path = std::filesystem::weakly_canonical(session, ignored);
  return (path.empty() ? session : path.string()) + "-lock";
}

std::string holderOf(const FileDescriptor& lock) {
  std::array<char, 256> text{};
  const ssize_t size = ::pread(lock.get(), text.data(), text.size(), 0);
  std::string holder;
  for (const char c : std::string_view(text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, size)))) {
    if (c >= ' ' && c <= '~') holder += c;
  }
  return holder.empty() ? "another program" : holder;
}

std::string thisProcess() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return fmt::format("process {} on {}, since {}", ::getpid(), host.data(), nowUtc());
}

// A writer that ended between open() and the lock removed the name of what was opened.
bool isStill(const std::string& path, const FileDescriptor& file) {
  struct stat open {
  }, named{};
  return ::fstat(file.get(), &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

FileDescriptor lockFile(const std::string& session, const std::string& path) {
  for (;;) {
    FileDescriptor file(::open(path.c_str(), O_CREAT | O_RDWR | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (!file) failOnFile(session, "create the session's lock", errno);
    const LockAttempt attempt = tryLock(file);
    if (attempt == LockAttempt::kHeldByAnother) {
      throw InputError(fmt::format(
          "{}: the session is being written by {}. One program writes a session at a time: wait until that one has "
          "ended, or end it; then go on with --resume.",
          session, holderOf(file)));
    }
    if (attempt == LockAttempt::kFailed) {
      throw InputError(fmt::format(
          "{}: the file system has no locks ({}), so that two programs could write the session at once. Keep "
          "sessions on a local disk.",
          session, std::generic_category().message(errno)));
    }
    if (isStill(path, file)) return file;
  }
}

}  // namespace

SessionLock::SessionLock(const std::string& session) : path_(lockPathOf(session)), file_(lockFile(session, path_)) {
  const std::string holder = thisProcess() + "\n";  // unknown is no reason to stop, so a full disk isn't either
  if (::ftruncate(file_.get(), 0) == 0 && ::pwrite(file_.get(), holder.data(), holder.size(), 0) < 0) return;
}

// Removed while it is locked: who opens it after that makes a new one, who opened it before sees that its name is gone.
SessionLock::~SessionLock() {
  if (file_) ::unlink(path_.c_str());
}

std::string sessionWriterOf(const std::string& session) {
  const FileDescriptor file(::open(lockPathOf(session).c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  return file && isLocked(file) ? holderOf(file) : "";
}

std::string nowUtc() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace pincer::tasks
