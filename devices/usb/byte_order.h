// byte_order: integers in a run of bytes, least significant byte first, whatever the machine.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace pincer::devices::usb {

template <std::integral T>
void store(std::span<std::uint8_t> bytes, std::size_t at, T value) {
  using Unsigned = std::make_unsigned_t<T>;
  const auto bits = static_cast<std::uint64_t>(static_cast<Unsigned>(value));
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[at + i] = static_cast<std::uint8_t>(bits >> (8 * i));
}

template <std::integral T>
T load(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) bits |= static_cast<std::uint64_t>(bytes[at + i]) << (8 * i);
  return static_cast<T>(static_cast<std::make_unsigned_t<T>>(bits));
}

}  // namespace pincer::devices::usb
