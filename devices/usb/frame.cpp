#include "pincer/devices/usb/frame.h"

#include <algorithm>

#include "pincer/devices/usb/byte_order.h"

namespace pincer::devices::usb {
namespace {

// [bytes] from the begin, as frame.h lists them.
constexpr std::size_t kTypeAt = 3, kSequenceAt = 4, kTimeAt = 8, kPayloadAt = 16, kCrcAt = 62;

bool isFrameType(std::uint8_t type) { return (type >= 0x01 && type <= 0x06) || (type >= 0x81 && type <= 0x87); }

constexpr std::array<std::uint16_t, 256> crcTable() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned i = 0; i < 256; ++i) {
    unsigned value = i << 8;
    for (int bit = 0; bit < 8; ++bit) value = (value & 0x8000u) != 0 ? (value << 1) ^ 0x1021u : value << 1;
    table[i] = static_cast<std::uint16_t>(value);
  }
  return table;
}

}  // namespace

std::string describe(FrameError error) {
  switch (error) {
    case FrameError::kNone:
      return "a frame";
    case FrameError::kLength:
      return "not 64 bytes long";
    case FrameError::kMagic:
      return "doesn't begin with \"PN\"";
    case FrameError::kVersion:
      return "of another protocol version";
    case FrameError::kCrc:
      return "garbled (checksum)";
    case FrameError::kType:
      return "of an unknown type";
    case FrameError::kPayload:
      return "with a value out of range";
  }
  return "unknown";
}

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  static constexpr auto kTable = crcTable();  // of the steps of eight bits at once
  std::uint16_t crc = 0xffff;
  for (const std::uint8_t byte : bytes) crc = static_cast<std::uint16_t>((crc << 8) ^ kTable[(crc >> 8) ^ byte]);
  return crc;
}

FrameBytes encode(const Frame& frame) {
  FrameBytes bytes{'P', 'N', kProtocolVersion, static_cast<std::uint8_t>(frame.type)};
  store(bytes, kSequenceAt, frame.sequence);
  store(bytes, kTimeAt, frame.time_us);
  std::copy(frame.payload.begin(), frame.payload.end(), bytes.begin() + kPayloadAt);
  store(bytes, kCrcAt, crc16(std::span(bytes).first(kCrcAt)));
  return bytes;
}

FrameError decode(std::span<const std::uint8_t> bytes, Frame& frame) {
  if (bytes.size() != kFrameSize) return FrameError::kLength;
  if (bytes[0] != 'P' || bytes[1] != 'N') return FrameError::kMagic;
  if (bytes[2] != kProtocolVersion) return FrameError::kVersion;
  if (load<std::uint16_t>(bytes, kCrcAt) != crc16(bytes.first(kCrcAt))) return FrameError::kCrc;
  if (!isFrameType(bytes[kTypeAt])) return FrameError::kType;
  frame.type = static_cast<FrameType>(bytes[kTypeAt]);
  frame.sequence = load<std::uint32_t>(bytes, kSequenceAt);
  frame.time_us = load<std::uint64_t>(bytes, kTimeAt);
  std::copy_n(bytes.begin() + kPayloadAt, kPayloadSize, frame.payload.begin());
  return FrameError::kNone;
}

}  // namespace pincer::devices::usb
