#include "pincer/contact/io/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "pincer/contact/error.h"

namespace pincer {

void AtomicFile::write(std::string_view bytes) {
  constexpr std::size_t kEnough = 1 << 16;  // for a system call to cost nothing beside it
  pending_ += bytes;
  if (pending_.size() >= kEnough) flush();
}

void AtomicFile::flush() {
  for (std::string_view rest = pending_; !rest.empty();) {
    const ssize_t written = ::write(part_.descriptor(), rest.data(), rest.size());
    if (written > 0) rest.remove_prefix(static_cast<std::size_t>(written));
    if (written < 0 && errno != EINTR) failOnFile(path_, "write the file", errno);
  }
  pending_.clear();
}

void AtomicFile::commit() {
  flush();
  part_.replace();
}

void writeAtomically(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void makeDirectory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error && std::filesystem::is_directory(directory, error)) return;
  const std::string cause = error ? error.message() : "a file of that name is in the way";
  throw InputError(
      fmt::format("{}: can't make the directory: {}. Choose a directory that you may write.", directory, cause));
}

}  // namespace pincer
