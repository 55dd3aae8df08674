// mesh_file: the bytes of a mesh file while it is read: errors that name a place in it,
// progress, and the numbers of binary formats.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>

namespace pincer::contact {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of UTF-8; some editors begin texts with it

// How a message counts places: in lines from 1, or in bytes from 0.
enum class Places : std::uint8_t { lines, bytes };

class MeshFile {
 public:
  // `bytes` and `progress` must outlive this object; `progress` may be empty.
  MeshFile(std::string_view bytes, std::string name, const std::function<void(double)>& progress);

  std::string_view bytes() const { return bytes_; }
  const std::string& name() const { return name_; }
  void countPlacesIn(Places places) { places_ = places; }

  // Throw InputError: "name: message", "name:line: message" or "name: byte 84: message".
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void failAt(std::int32_t place, const std::string& message) const;

  // Tells `progress` from time to time how far reading has come.
  void reached(std::size_t byte) {
    if (byte >= next_report_) report(byte);
  }

 private:
  void report(std::size_t byte);

  std::string_view bytes_;
  std::string name_;
  const std::function<void(double)>& progress_;
  std::size_t next_report_;
  Places places_ = Places::lines;
};

// A word of the file as it may stand in a message: at most 40 characters, unprintable ones as "?".
std::string inQuotes(std::string_view word);

enum class ByteOrder : std::uint8_t { little, big };

// The first bytes as a number of type T. Requires enough of them.
template <typename T>
T readNumber(std::string_view bytes, ByteOrder order) {
  unsigned char raw[sizeof(T)];
  const bool reverse = (order == ByteOrder::little) != (std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    raw[i] = static_cast<unsigned char>(bytes[reverse ? sizeof(T) - 1 - i : i]);
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

}  // namespace pincer::contact
