#include <zlib.h>

#include <cstdint>
#include <new>

#include "pincer/tasks/share/packed_text.h"

namespace pincer::tasks {

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";  // by 6 bits: RFC 4648
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text.push_back(i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=');
  }
  return text;
}

std::string packed(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string squeezed(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(squeezed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
  if (result != Z_OK) throw std::bad_alloc();  // the only way in which it fails when the room is compressBound's
  squeezed.resize(size);
  return base64(squeezed);
}

}  // namespace pincer::tasks
