// old_library: what the libraries of Debian 12's emscripten (3.1.6) lack; every source of that build sees it first.
#pragma once
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

// Its strtod knows one locale, and rounds to nearest.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  char* end = nullptr;
  const double read = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  value = read;
  return {first + (end - text.c_str()), errc{}};
}

// Reads back as the same number; not always the shortest that does. The page writes no files.
inline to_chars_result to_chars(char* first, char* last, double value) {
  const int length = snprintf(first, static_cast<size_t>(last - first), "%.17g", value);
  return length < last - first ? to_chars_result{first + length, errc{}} : to_chars_result{last, errc::value_too_large};
}

}  // namespace std

constexpr unsigned RENAME_NOREPLACE = 1;

// A page has no files.
inline int renameat2(int, const char*, int, const char*, unsigned) {
  errno = ENOSYS;
  return -1;
}
