// fingerprint: 64 bits over texts and numbers, to tell whether two lists are the same; no protection against who wants
// them to look the same. Source: G. Fowler, L. C. Noll, P. Vo, FNV-1a (RFC draft draft-eastlake-fnv), 64 bits.
// Departure: a number goes in at one step in place of eight.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace pincer::tasks {

class Fingerprint {
 public:
  // Texts one after the other; their borders count.
  void add(std::string_view text) {
    for (const char c : text) step(static_cast<unsigned char>(c));
    step(0);
  }
  // The product carries bits upwards only; the shift brings them down again.
  void add(std::uint64_t number) {
    step(number);
    hash_ ^= hash_ >> 32;
  }
  std::uint64_t bits() const { return hash_; }
  std::string text() const { return fmt::format("{:016x}", hash_); }  // 16 hexadecimal digits

 private:
  void step(std::uint64_t part) { hash_ = (hash_ ^ part) * 1099511628211u; }  // FNV's prime
  std::uint64_t hash_ = 14695981039346656037u;                                // its offset basis
};

inline std::string fingerprint(std::string_view text) {
  Fingerprint hash;
  hash.add(text);
  return hash.text();
}

}  // namespace pincer::tasks
