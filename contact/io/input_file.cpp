#include "pincer/contact/io/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "pincer/contact/io/printable.h"

namespace pincer {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;  // bytes of a read

std::string reasonOf(int error) {
  if (error == ENOENT || error == ENOTDIR) return "there is no such file. Check the path.";
  if (error == EACCES || error == EPERM) return "it can't be opened: you may not read it. Check its permissions.";
  return fmt::format("it can't be opened: {}. Check the path and the disk.", std::strerror(error));
}

std::string_view kindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

void refuseUnlessRegular(const std::string& path, const struct stat& status, std::string_view kind_name) {
  if (S_ISREG(status.st_mode)) return;
  const std::string_view remedy = S_ISFIFO(status.st_mode) ? "Save its content to a file first." : "Check the path.";
  throw InputError(fmt::format("{}: this is {}, not a file; {} is needed here. {}", path, kindOf(status.st_mode),
                               kind_name, remedy));
}

struct stat statusOf(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw InputError(fmt::format("{}: {}", path, reasonOf(errno)));
  return status;
}

}  // namespace

void requireRegularFile(const std::string& path, std::string_view kind_name) {
  refuseUnlessRegular(path, statusOf(path), kind_name);
}

void refuseNul(std::string_view text, const std::string& name, std::int64_t first_line) {
  const std::size_t place = text.find('\0');
  if (place == std::string_view::npos) return;
  const auto line = first_line + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
  throw InputError(
      fmt::format("{}:{}: a NUL byte (byte {} of the text) is no part of a text. The file is damaged or of another "
                  "kind; make it anew.",
                  name, line, place));
}

// Looks before it opens, for opening alone may do something to a device; and looks
// again, for the file may have been exchanged.
InputFile::InputFile(const std::string& path, const InputKind& kind) : path_(path), kind_(kind) {
  requireRegularFile(path, kind.name);
  file_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (file_ < 0) refuse(reasonOf(errno));
  struct stat status {};
  const int result = ::fstat(file_, &status);
  try {
    if (result != 0) refuse(reasonOf(errno));
    refuseUnlessRegular(path, status, kind.name);
    size_ = static_cast<std::size_t>(std::max<off_t>(status.st_size, 0));
    if (size_ > kind_.most_bytes) {
      refuse(fmt::format("the file has {:.1f} MB; {} has at most {:g} MB. {}", static_cast<double>(size_) / kMegabyte,
                         kind_.name, static_cast<double>(kind_.most_bytes) / kMegabyte, kind_.remedy));
    }
  } catch (...) {
    ::close(file_);
    throw;
  }
}

InputFile::~InputFile() { ::close(file_); }

void InputFile::refuse(const std::string& problem) const { throw InputError(fmt::format("{}: {}", path_, problem)); }

bool InputFile::fill() {
  const std::size_t begin = buffer_.size();
  buffer_.resize(begin + kBlock);
  ssize_t got = 0;
  do {
    got = ::read(file_, buffer_.data() + begin, kBlock);
  } while (got < 0 && errno == EINTR);
  const int error = errno;
  buffer_.resize(begin + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got < 0)
    refuse(fmt::format("reading failed after {} bytes: {}. Check the disk and copy the file again.", read_,
                       std::strerror(error)));
  read_ += static_cast<std::size_t>(got);
  if (read_ > kind_.most_bytes) {
    refuse(fmt::format("the file is larger than {:g} MB, the most that {} has. {}",
                       static_cast<double>(kind_.most_bytes) / kMegabyte, kind_.name, kind_.remedy));
  }
  return got > 0;
}

std::string InputFile::readAll() {
  buffer_.reserve(buffer_.size() + size_ + kBlock);
  while (fill()) {
  }
  std::string all = position_ == 0 ? std::move(buffer_) : buffer_.substr(position_);
  buffer_.clear();
  position_ = 0;
  if (kind_.is_text) refuseNul(all, path_, line_ + 1);
  return all;
}

bool InputFile::nextLine(std::string_view& line) {
  std::size_t end = buffer_.find('\n', position_);
  while (end == std::string::npos && buffer_.size() - position_ <= kLongestTableLine) {
    buffer_.erase(0, std::exchange(position_, 0));
    const std::size_t searched = buffer_.size();
    if (!fill()) break;
    end = buffer_.find('\n', searched);
  }
  if (end == std::string::npos && position_ == buffer_.size()) return false;
  ++line_;
  line = std::string_view(buffer_).substr(position_, std::min(end, buffer_.size()) - position_);
  if (line.size() > kLongestTableLine) {
    throw InputError(fmt::format("{}:{}: the line is longer than {} bytes. Is this {}? Make it anew.", path_, line_,
                                 kLongestTableLine, kind_.name));
  }
  position_ = std::min(end, buffer_.size() - 1) + 1;
  if (kind_.is_text) refuseNul(line, path_, line_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return true;
}

std::string readInputFile(const std::string& path, const InputKind& kind) { return InputFile(path, kind).readAll(); }

}  // namespace pincer
