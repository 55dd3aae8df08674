#include "tasks/session/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "contact/error.h"

namespace pincer::tasks {
namespace {

// The rename of commit() would put a plain file in the place of a device or a pipe.
std::string notSpecial(std::string path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!exists(status) || is_regular_file(status) || is_directory(status)) return path;
  throw InputError(fmt::format("{}: is a device or a pipe, not a file. Choose the name of a file.", path));
}

}  // namespace

AtomicFile::AtomicFile(std::string path)
    : path_(notSpecial(std::move(path))), part_(path_ + ".part"), file_(std::fopen(part_.c_str(), "wb")) {
  if (!file_) fail("make");
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  std::remove(part_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail("write");
}

void AtomicFile::commit() {
  if (std::fflush(file_.get()) != 0 || ::fsync(::fileno(file_.get())) != 0) fail("write");
  if (std::rename(part_.c_str(), path_.c_str()) != 0) fail("put in place");
  file_.reset();
}

void AtomicFile::fail(const char* doing) const {
  const int error = errno;
  const char* remedy = error == ENOENT   ? "Make its directory first."
                       : error == ENOSPC ? "Free some space or choose another disk."
                       : error == EISDIR ? "A directory of that name is in the way; choose another name."
                                         : "Choose a directory that you may write.";
  throw InputError(fmt::format("{}: can't {} the file: {}. {}", path_, doing, std::strerror(error), remedy));
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
  throw InputError(fmt::format("{}: can't make the directory: {}. Choose a directory that you may write.", directory, cause));
}

}  // namespace pincer::tasks
