#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>

#include "pincer/devices/usb/byte_order.h"
#include "pincer/devices/usb/frame.h"
#include "pincer/devices/usb/frame_order.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::devices::usb {
namespace {

FrameBytes resigned(FrameBytes bytes) {
  store<std::uint16_t>(bytes, 62, crc16(std::span(bytes).first(62)));
  return bytes;
}

TEST(UsbFrame, ChecksumOfTheStandardStringIsThePublishedOne) {
  const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc16(digits), 0x29b1);
  EXPECT_EQ(crc16({}), 0xffff);
}

// docs/usb-protocol.md prints this frame; made by hand, not by encode().
TEST(UsbFrame, ReadsTheExampleOfTheDocumentation) {
  FrameBytes bytes{0x50, 0x4e, 0x01, 0x01, 0x07, 0x00, 0x00, 0x00, 0x40, 0xe2, 0x01};
  bytes[62] = 0x00, bytes[63] = 0x00;
  const std::uint16_t crc = crc16(std::span(bytes).first(62));
  bytes[62] = static_cast<std::uint8_t>(crc & 0xff), bytes[63] = static_cast<std::uint8_t>(crc >> 8);
  Frame frame;
  ASSERT_EQ(decode(bytes, frame), FrameError::kNone);
  EXPECT_EQ(frame.type, FrameType::kIdentify);
  EXPECT_EQ(frame.sequence, 7u);
  EXPECT_EQ(frame.time_us, 123456u);
  EXPECT_EQ(encode(frame), bytes);
}

TEST(UsbFrame, TakesEveryTypeThatThereIs) {
  for (const int type : {0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87}) {
    Frame frame, sent;
    sent.type = static_cast<FrameType>(type);
    EXPECT_EQ(decode(encode(sent), frame), FrameError::kNone) << type;
    EXPECT_EQ(frame.type, sent.type);
  }
}

TEST(UsbFrame, NamesWhyBytesAreNoFrame) {
  Frame frame;
  const FrameBytes good = encode(frame);
  const auto with = [&](std::size_t at, std::uint8_t value) {
    FrameBytes bytes = good;
    bytes[at] = value;
    return resigned(bytes);
  };
  EXPECT_EQ(decode(good, frame), FrameError::kNone);
  EXPECT_EQ(decode(std::span(good).first(63), frame), FrameError::kLength);
  EXPECT_EQ(decode({}, frame), FrameError::kLength);
  EXPECT_EQ(decode(with(0, 'p'), frame), FrameError::kMagic);
  EXPECT_EQ(decode(with(1, 0), frame), FrameError::kMagic);
  EXPECT_EQ(decode(with(2, 2), frame), FrameError::kVersion);
  FrameBytes garbled = good;
  garbled[40] ^= 1;
  EXPECT_EQ(decode(garbled, frame), FrameError::kCrc);
  for (const int type : {0x00, 0x07, 0x7f, 0x80, 0x88, 0xff}) {
    EXPECT_EQ(decode(with(3, static_cast<std::uint8_t>(type)), frame), FrameError::kType) << type;
  }
  std::set<std::string> words;
  for (int e = 0; e <= static_cast<int>(FrameError::kPayload); ++e) words.insert(describe(static_cast<FrameError>(e)));
  EXPECT_EQ(words.size(), 7u);
  EXPECT_FALSE(words.contains(describe(static_cast<FrameError>(200)))) << "a number that is none of them";
}

// A CRC of 16 bits finds every error of one or two bits in 62 bytes.
TEST(UsbFrame, NoFlippedBitOrPairOfBitsPasses) {
  tests::RandomNumbers draw(1);
  Frame frame;
  frame.type = FrameType::kArmState;
  for (auto& byte : frame.payload) byte = static_cast<std::uint8_t>(draw.below(256));
  const FrameBytes good = encode(frame);
  for (std::size_t i = 0; i < 512; ++i) {
    for (std::size_t j = i; j < 512; ++j) {
      FrameBytes bytes = good;
      bytes[i / 8] ^= static_cast<std::uint8_t>(1u << (i % 8));
      if (j != i) bytes[j / 8] ^= static_cast<std::uint8_t>(1u << (j % 8));
      ASSERT_NE(decode(bytes, frame), FrameError::kNone) << i << ", " << j;
    }
  }
}

TEST(UsbFrame, ComesBackAsItWentWhateverItHolds) {
  tests::RandomNumbers draw(2);
  for (int i = 0; i < 20000; ++i) {
    Frame frame, back;
    frame.type = static_cast<FrameType>((draw.below(2) == 0 ? 0x81 : 0x01) + draw.below(6));
    frame.sequence = static_cast<std::uint32_t>(draw.bits());
    frame.time_us = draw.bits();
    for (auto& byte : frame.payload) byte = static_cast<std::uint8_t>(draw.below(256));
    ASSERT_EQ(decode(encode(frame), back), FrameError::kNone);
    ASSERT_EQ(back.type, frame.type);
    ASSERT_EQ(back.sequence, frame.sequence);
    ASSERT_EQ(back.time_us, frame.time_us);
    ASSERT_EQ(back.payload, frame.payload);
  }
}

TEST(UsbFrameOrder, TakesOnlyWhatIsNewerAndCountsGaps) {
  FrameOrder order;
  EXPECT_EQ(order.judge(100), FrameVerdict::kNewer) << "the first, whatever its number";
  EXPECT_EQ(order.judge(100), FrameVerdict::kDuplicate);
  EXPECT_EQ(order.judge(99), FrameVerdict::kLate);
  EXPECT_EQ(order.refusedInARow(), 2);
  EXPECT_EQ(order.judge(104), FrameVerdict::kNewer);
  EXPECT_EQ(order.lost(), 3);
  EXPECT_EQ(order.refusedInARow(), 0);
  EXPECT_EQ(order.judge(105), FrameVerdict::kNewer);
  EXPECT_EQ(order.lost(), 0);
}

TEST(UsbFrameOrder, CountsOnBeyondTheLargestNumber) {
  FrameOrder order;
  order.judge(0xffffffffu);
  EXPECT_EQ(order.judge(0), FrameVerdict::kNewer);
  EXPECT_EQ(order.lost(), 0);
  EXPECT_EQ(order.judge(0xffffffffu), FrameVerdict::kDuplicate);
}

TEST(UsbFrameOrder, AFrameThatComesLateIsNoLongerLost) {
  FrameOrder order;
  order.judge(7);
  order.judge(10);
  EXPECT_EQ(order.lost(), 2);
  EXPECT_EQ(order.judge(8), FrameVerdict::kLate);
  EXPECT_EQ(order.lost(), -1);
  EXPECT_EQ(order.judge(8), FrameVerdict::kDuplicate);
  EXPECT_EQ(order.lost(), 0);
  EXPECT_EQ(order.judge(6), FrameVerdict::kLate) << "before the first: it was never missed";
  EXPECT_EQ(order.lost(), 0);
  order.judge(11 + 100);
  EXPECT_EQ(order.judge(9), FrameVerdict::kLate) << "too long ago to know";
  EXPECT_EQ(order.lost(), 0);
}

TEST(UsbClockMap, SeesHowOldAFrameIsThatWasHeldUp) {
  ClockMap map;
  for (int i = 0; i < 100; ++i)
    EXPECT_LE(map.sentAt(static_cast<std::uint64_t>(1000 * i), 5'000'000'000 + 1'000'000 * i),
              5'000'000'000 + 1'000'000 * i);
  EXPECT_NEAR(static_cast<double>(map.sentAt(100'000, 5'110'000'000)), 5.1e9, 1e4)
      << "10 ms under way; 10 us: the allowance for drift";
}

// A sender's clock 40 ppm slower than ours, for ten minutes.
TEST(UsbClockMap, FollowsASlowClock) {
  ClockMap map;
  for (int i = 0; i < 600'000; i += 10) {
    const std::int64_t now = 1'000'000LL * i;
    const std::int64_t sent = map.sentAt(static_cast<std::uint64_t>(1000.0 * i * (1 - 40e-6)), now);
    EXPECT_LE(sent, now);
    EXPECT_GE(sent, now - 10'000);
  }
}

// Who isn't root can open what these lines name, and nothing else of ours.
TEST(UsbFrame, TheUdevRuleNamesTheProtocolsVendorAndProduct) {
  std::ifstream file(PINCER_SOURCE_DIR "/devices/usb/70-pincer.rules");
  const std::string rules{std::istreambuf_iterator<char>(file), {}};
  std::array<char, 64> match{};
  std::snprintf(match.data(), match.size(), "ATTR{idVendor}==\"%04x\", ATTR{idProduct}==\"%04x\"", kVendorId,
                kProductId);
  EXPECT_NE(rules.find(match.data()), std::string::npos) << match.data();
  EXPECT_NE(rules.find("GROUP=\"plugdev\""), std::string::npos);
}

}  // namespace
}  // namespace pincer::devices::usb
