// packed_text: bytes as text of a page: compressed (zlib's format, RFC 1950), then in base64 (RFC 4648).
#pragma once
#include <string>
#include <string_view>

namespace pincer::tasks {

std::string base64(std::string_view bytes);
std::string packed(std::string_view bytes);

}  // namespace pincer::tasks
