#include "pincer/devices/falcon/falcon_packet.h"

#include <algorithm>

namespace pincer::devices::falcon {
namespace {

constexpr std::size_t kStatusBytes = 2;  // of the FTDI chip, before each packet's text
constexpr int kMostTorque = 4096;        // counts: 12 bits and their sign

}  // namespace

Packet packetOf(const Orders& orders) {
  Packet packet;
  packet.fill('A');
  packet.front() = '<';
  packet.back() = '>';
  for (std::size_t i = 0; i < 3; ++i) {
    const auto bits = static_cast<std::uint16_t>(std::clamp(orders.torques[i], -kMostTorque, kMostTorque));
    for (std::size_t k = 0; k < 4; ++k)
      packet[1 + 4 * i + k] = static_cast<std::uint8_t>('A' + ((bits >> (4 * k)) & 0xf));
  }
  packet[13] = static_cast<std::uint8_t>('A' + ((orders.lamps & 0xe) | (orders.homing ? 1 : 0)));
  return packet;
}

std::optional<Answer> answerIn(const Packet& packet) {
  if (packet.front() != '<' || packet.back() != '>') return std::nullopt;
  Answer answer;
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const unsigned nibble = packet[1 + 4 * i + k] - static_cast<unsigned>('A');
      if (nibble > 0xf) return std::nullopt;
      bits |= nibble << (4 * k);
    }
    answer.counts[i] = static_cast<std::int16_t>(bits);
  }
  const unsigned state = packet[13] - static_cast<unsigned>('A');
  if (state > 0x7f) return std::nullopt;
  answer.buttons = static_cast<std::uint8_t>(state & 0xf);
  answer.homed = static_cast<std::uint8_t>(state >> 4);
  return answer;
}

std::optional<Answer> AnswerReader::read(std::span<const std::uint8_t> usb_packet) {
  std::optional<Answer> newest;
  for (std::size_t i = kStatusBytes; i < usb_packet.size(); ++i) {
    if (const auto answer = take(usb_packet[i])) newest = answer;
  }
  return newest;
}

std::optional<Answer> AnswerReader::take(std::uint8_t byte) {
  if (byte == '<') {
    if (size_ != 0) ++garbled_;
    size_ = 0;
  } else if (size_ == 0) {
    return std::nullopt;  // between packets
  }
  packet_[size_++] = byte;
  if (size_ < packet_.size()) return std::nullopt;
  size_ = 0;
  const auto answer = answerIn(packet_);
  if (!answer) ++garbled_;
  return answer;
}

}  // namespace pincer::devices::falcon
