#include "pincer/contact/io/part_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>

#include "pincer/contact/error.h"

namespace pincer {
namespace {

constexpr std::size_t kDigits = 16;  // of a random number of 64 bits
// of the file's own name that the part's repeats: names may have 255 bytes in all
constexpr std::size_t kLongestName = 200;
constexpr std::string_view kEnding = ".part";

std::string directoryOf(const std::string& path) {
  const std::string directory = std::filesystem::path(path).parent_path().string();
  return directory.empty() ? "." : directory;
}

std::string beginningOf(const std::string& path) {
  return fmt::format(".{}.", std::filesystem::path(path).filename().string().substr(0, kLongestName));
}

std::string randomName(const std::string& path) {
  std::random_device random;
  const std::uint64_t bits = static_cast<std::uint64_t>(random()) << 32 | random();
  const std::string prefix = std::filesystem::path(path).parent_path() / beginningOf(path);
  return fmt::format("{}{:016x}{}", prefix, bits, kEnding);
}

bool isPartOf(const std::string& beginning, const std::string& name) {
  if (name.size() != beginning.size() + kDigits + kEnding.size() || !name.starts_with(beginning) ||
      !name.ends_with(kEnding))
    return false;
  return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(beginning.size()),
                     name.end() - static_cast<std::ptrdiff_t>(kEnding.size()),
                     [](char c) { return std::isxdigit(static_cast<unsigned char>(c)); });
}

std::vector<std::string> partsOf(const std::string& path) {
  const std::string beginning = beginningOf(path);
  std::vector<std::string> parts;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directoryOf(path), ignored)) {
    if (isPartOf(beginning, entry.path().filename().string())) parts.push_back(entry.path().string());
  }
  return parts;
}

// SQLite's files too. The part goes last: while its name is there, the others are found.
void removePart(const std::string& part) {
  for (const char* suffix : {"-wal", "-shm", "-journal", ""}) ::unlink((part + suffix).c_str());
}

// The rename would put a plain file in the place of a device or a pipe.
std::string notSpecial(std::string path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!exists(status) || is_regular_file(status) || is_directory(status)) return path;
  throw InputError(fmt::format("{}: is a device or a pipe, not a file. Choose the name of a file.", path));
}

const char* remedyForFile(int error) {
  switch (error) {
    case EEXIST:
      return "It is never overwritten. Choose another name, or move the old file away.";
    case ENOENT:
      return "Make its directory first, or choose another one.";
    case EISDIR:
      return "A directory of that name is in the way; choose another name.";
    case ENAMETOOLONG:
      return "Choose a shorter name.";
    case EROFS:
      return "The file system is read-only. Choose another directory.";
    case ENOSPC:
    case EDQUOT:
      return "Free some space or choose another disk.";
    case EFBIG:
      return "The file would grow beyond the largest size allowed (`ulimit -f`, or the file system's).";
    default:
      return "Choose a directory that you may write.";
  }
}

}  // namespace

void failOnFile(const std::string& path, const char* doing, int error) {
  throw InputError(fmt::format("{}: can't {}: {}. {}", path, doing, std::strerror(error), remedyForFile(error)));
}

bool hasPart(const std::string& path) { return !partsOf(path).empty(); }

void removeLeftParts(const std::string& path) {
  for (const std::string& part : partsOf(path)) {
    const FileDescriptor file(::open(part.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (file && tryLock(file) == LockAttempt::kLocked) removePart(part);
  }
}

PartFile::PartFile(std::string path) : path_(notSpecial(std::move(path))) {
  removeLeftParts(path_);
  do {
    part_ = randomName(path_);
    file_ = FileDescriptor(::open(part_.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC, 0666));
  } while (!file_ && errno == EEXIST);
  if (!file_) fail("make the file");
  tryLock(file_);  // a file system without locks: then leftovers stay, nothing else
}

PartFile::~PartFile() {
  if (!part_.empty()) removePart(part_);
}

void PartFile::replace() {
  if (::fsync(file_.get()) != 0) fail("write the file");
  if (std::rename(part_.c_str(), path_.c_str()) != 0) fail("put the file in place");
  placed();
}

// One step: a program that is killed leaves one name. A file system that doesn't know the step gets a second name for
// the file, which no old one can be; then the first goes.
void PartFile::placeNew() {
  if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) != 0) {
    const bool is_known = errno != EINVAL && errno != ENOSYS;
    if (is_known || ::link(part_.c_str(), path_.c_str()) != 0) fail("put the file in place");
    ::unlink(part_.c_str());
  }
  placed();
}

// The directory is flushed too: otherwise the name may be gone after a power cut.
void PartFile::placed() {
  part_.clear();
  file_ = FileDescriptor();
  const FileDescriptor directory(::open(directoryOf(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory) ::fsync(directory.get());
}

void PartFile::fail(const char* doing) const { failOnFile(path_, doing, errno); }

}  // namespace pincer
