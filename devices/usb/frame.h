// frame: the 64 bytes that travel between host and device, in both directions
// (docs/usb-protocol.md). Numbers are little-endian.
//
//   0  magic "PN"     2  version, 1     3  type     4  sequence, of the sender, + 1 per frame
//   8  the sender's clock [us]
//   16 payload, 46 bytes; what a type doesn't use is zero     62  CRC-16 of the bytes before it
//
// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xffff, no reflection, no final xor; "123456789" gives 0x29b1.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace pincer::devices::usb {

inline constexpr std::size_t kFrameSize = 64;        // [bytes]: one full-speed packet
inline constexpr std::size_t kPayloadSize = 46;      // [bytes] between the clock and the checksum
inline constexpr std::uint8_t kProtocolVersion = 1;  // another one is refused
inline constexpr std::uint16_t kVendorId = 0x1209;   // pid.codes, open source devices
inline constexpr std::uint16_t kProductId = 0x0001;  // theirs for private testing; a maker registers an own one

using FrameBytes = std::array<std::uint8_t, kFrameSize>;
using Payload = std::array<std::uint8_t, kPayloadSize>;

enum class FrameType : std::uint8_t {
  kIdentify = 0x01,  // from the host
  kArmCommand = 0x02,
  kDisplayCommand = 0x03,
  kReadCalibration = 0x04,
  kWriteCalibration = 0x05,
  kStop = 0x06,
  kIdentity = 0x81,  // from the device
  kArmState = 0x82,
  kDisplayState = 0x83,
  kCalibration = 0x84,
  kStatus = 0x85,
  kArmCapabilities = 0x86,
  kDisplayCapabilities = 0x87,
};

struct Frame {
  FrameType type = FrameType::kIdentify;
  std::uint32_t sequence = 0;
  std::uint64_t time_us = 0;
  Payload payload{};
};

// Why bytes are no frame, in the order of the checks.
enum class FrameError : std::uint8_t { kNone, kLength, kMagic, kVersion, kCrc, kType, kPayload };
std::string describe(FrameError error);

std::uint16_t crc16(std::span<const std::uint8_t> bytes);

FrameBytes encode(const Frame& frame);

// Fills `frame` only where the answer is kNone. Checks everything but the payload (messages.h).
FrameError decode(std::span<const std::uint8_t> bytes, Frame& frame);

}  // namespace pincer::devices::usb
