// falcon_packet: the 16 characters that go to a Falcon's firmware, and the 16 that come back.
//
//   '<' g0 g1 g2 g3 h0 h1 h2 h3 i0 i1 i2 i3 j k '>'
//   each but the ends is a nibble + 'A', least significant nibble first
//
// To the Falcon: g, h, i motor torques (16 bits, two's complement), j lamps and homing. From it: g,
// h, i encoder counts, j buttons (bits 0 to
// 3) and, while homing, which encoders are home (bits 4 to 6: the character then goes beyond 'P').
//    An FTDI chip puts two status bytes before
// each USB packet of up to 64 bytes. Source: libnifalcon (FalconFirmwareNovintSDK.h); the maker published nothing.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace pincer::devices::falcon {

using Packet = std::array<std::uint8_t, 16>;

struct Orders {
  std::array<int, 3> torques{};  // [counts], within +-4096
  bool homing = false;
  std::uint8_t lamps = 0;  // 2 red, 4 green, 8 blue
};

struct Answer {
  std::array<int, 3> counts{};
  std::uint8_t buttons = 0, homed = 0;  // bits
};

Packet packetOf(const Orders& orders);
// Absent unless every character is in its range.
std::optional<Answer> answerIn(const Packet& packet);

// Finds answers in what comes over USB, whatever its pieces.
class AnswerReader {
 public:
  // A whole USB packet, status bytes and all. The newest answer in it, if one ended there.
  std::optional<Answer> read(std::span<const std::uint8_t> usb_packet);
  std::int64_t garbled() const { return garbled_; }

 private:
  std::optional<Answer> take(std::uint8_t byte);

  Packet packet_{};
  std::size_t size_ = 0;
  std::int64_t garbled_ = 0;
};

}  // namespace pincer::devices::falcon
