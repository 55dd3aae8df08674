#include "pincer/contact/mesh/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pincer/contact/error.h"

namespace pincer::contact {

namespace {

constexpr std::size_t kBetweenReports = std::size_t{1} << 20;  // bytes; some milliseconds of reading

}  // namespace

MeshFile::MeshFile(std::string_view bytes, std::string name, const std::function<void(double)>& progress)
    : bytes_(bytes),
      name_(std::move(name)),
      progress_(progress),
      next_report_(progress ? kBetweenReports : std::numeric_limits<std::size_t>::max()) {}

void MeshFile::fail(const std::string& message) const { throw InputError(fmt::format("{}: {}", name_, message)); }

void MeshFile::failAt(std::int32_t place, const std::string& message) const {
  throw InputError(places_ == Places::lines ? fmt::format("{}:{}: {}", name_, place, message)
                                            : fmt::format("{}: byte {}: {}", name_, place, message));
}

void MeshFile::report(std::size_t byte) {
  progress_(static_cast<double>(byte) / static_cast<double>(bytes_.size()));
  next_report_ = byte + kBetweenReports;
}

std::string inQuotes(std::string_view word) {
  constexpr std::size_t kLongest = 40;  // characters that a message quotes
  std::string text(word.substr(0, kLongest));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return "\"" + text + (word.size() > kLongest ? "...\"" : "\"");
}

}  // namespace pincer::contact
