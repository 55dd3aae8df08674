// Bytes over USB, in this process: random and mutated bytes. What is taken for a message must be
// one: it is told again as the same bytes.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/devices/falcon/falcon_packet.h"
#include "pincer/devices/usb/frame.h"
#include "pincer/devices/usb/frame_order.h"
#include "pincer/devices/usb/messages.h"
#include "pincer/tests/campaign/program_run.h"
#include "pincer/tests/campaign/rows.h"

namespace pincer::campaign {
namespace {

using namespace devices::usb;
constexpr int kExecutions = 100'000;  // per case

constexpr FrameType kTypes[] = {
    FrameType::kIdentify,           FrameType::kArmCommand,  FrameType::kDisplayCommand, FrameType::kReadCalibration,
    FrameType::kWriteCalibration,   FrameType::kStop,        FrameType::kIdentity,       FrameType::kArmState,
    FrameType::kDisplayState,       FrameType::kCalibration, FrameType::kStatus,         FrameType::kArmCapabilities,
    FrameType::kDisplayCapabilities};

// Bytes as they come: mostly small and extreme ones, so that ranges are met from both sides.
std::uint8_t someByte(RandomNumbers& random) {
  constexpr std::uint8_t kLikely[] = {0, 0, 0, 0, 1, 2, 0x7f, 0x80, 0xff, 0x20};
  return random.below(2) == 0 ? kLikely[random.below(10)] : static_cast<std::uint8_t>(random.bits());
}

// A sound message's payload, so that mutations of it are nearly sound.
Frame soundFrame(RandomNumbers& random) {
  ArmState arm;
  arm.valid = true;
  arm.p_DF = Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
  if (random.below(2) == 0) arm.v_DF = Vec3(random.uniform(-50, 50), 0, 0);
  DisplayState display;
  display.valid = true;
  display.place_L = Vec2(random.uniform(-0.1, 0.1), 0);
  Identity identity;
  identity.model = "model";
  identity.serial = "serial";
  CalibrationEntry entry;
  entry.index = 1, entry.count = 3, entry.name = "base_x", entry.value = random.uniform(-1, 1);
  switch (random.below(7)) {
    case 0:
      return toFrame(arm);
    case 1:
      return toFrame(display);
    case 2:
      return toFrame(identity);
    case 3:
      return toFrame(entry, FrameType::kCalibration);
    case 4:
      return toFrame(Status{});
    case 5:
      return toFrame(ArmCommand{});
    default:
      return toFrame(DisplayCommand{});
  }
}

Frame mutatedFrame(RandomNumbers& random) {
  Frame frame = soundFrame(random);
  for (int n = random.below(4); n > 0; --n)
    frame.payload[static_cast<std::size_t>(random.below(kPayloadSize))] = someByte(random);
  if (random.below(4) == 0) frame.type = kTypes[random.below(static_cast<int>(std::size(kTypes)))];
  if (random.below(16) == 0)
    std::generate(frame.payload.begin(), frame.payload.end(), [&] { return someByte(random); });
  frame.sequence = static_cast<std::uint32_t>(random.bits());
  frame.time_us = random.bits();
  return frame;
}

// True unless the frame holds the message and telling it again gives other bytes; counts those that hold it.
template <class Message>
bool survives(const Frame& frame, const std::optional<Message>& message, std::int64_t& taken) {
  if (!message) return true;
  ++taken;
  return toFrame(*message).payload == frame.payload && toFrame(*message).type == frame.type;
}

bool allSurvive(const Frame& frame, std::int64_t& taken) {
  const auto entry = calibrationIn(frame);
  taken += entry.has_value();
  const bool entry_ok = !entry || toFrame(*entry, frame.type).payload == frame.payload;
  armCapabilitiesIn(frame);
  displayCapabilitiesIn(frame);
  return entry_ok && survives(frame, identityIn(frame), taken) && survives(frame, armCommandIn(frame), taken) &&
         survives(frame, armStateIn(frame), taken) && survives(frame, displayCommandIn(frame), taken) &&
         survives(frame, displayStateIn(frame), taken) && survives(frame, statusIn(frame), taken);
}

void add(Case& c, std::int64_t taken, double began) {
  c.count(Verdict::kFine, taken);
  c.count(Verdict::kRefused, kExecutions - taken);
  c.spend(now() - began);
}

}  // namespace

void harmFrames(Case& c) {
  const double began = now();
  std::int64_t taken = 0;
  for (int i = 0; i < kExecutions; ++i) {
    FrameBytes bytes = encode(mutatedFrame(c.random));
    for (int n = c.random.below(3); n > 0; --n)
      bytes[static_cast<std::size_t>(c.random.below(kFrameSize))] ^= static_cast<std::uint8_t>(1 << c.random.below(8));
    const std::size_t length =
        c.random.below(8) == 0 ? static_cast<std::size_t>(c.random.below(kFrameSize)) : kFrameSize;
    Frame frame;
    if (decode(std::span(bytes).first(length), frame) != FrameError::kNone) continue;
    ++taken;
    if (encode(frame) != bytes)
      return c.fault(Verdict::kWrong, fmt::format("execution {}: a frame that is told again differs", i), "");
  }
  add(c, taken, began);
}

void harmMessages(Case& c) {
  const double began = now();
  std::int64_t taken = 0;
  FrameOrder order;
  for (int i = 0; i < kExecutions; ++i) {
    const Frame frame = mutatedFrame(c.random);
    order.judge(frame.sequence);
    if (!allSurvive(frame, taken)) {
      return c.fault(Verdict::kWrong,
                     fmt::format("execution {}: a message of type 0x{:02x} that is told again differs", i,
                                 static_cast<int>(frame.type)),
                     "");
    }
  }
  add(c, taken, began);
}

void harmFalconPackets(Case& c) {
  using namespace devices::falcon;
  const double began = now();
  AnswerReader reader;
  std::int64_t taken = 0;
  for (int i = 0; i < kExecutions; ++i) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(c.random.below(66)));
    std::generate(bytes.begin(), bytes.end(), [&] { return someByte(c.random); });
    const Packet packet =
        packetOf({{c.random.below(8192) - 4096, c.random.below(8192) - 4096, 0}, c.random.below(2) == 0, 2});
    if (bytes.size() >= 18)
      std::copy(packet.begin(), packet.end(), bytes.begin() + 2 + c.random.below(static_cast<int>(bytes.size()) - 17));
    if (!bytes.empty() && c.random.below(2) == 0)
      bytes[static_cast<std::size_t>(c.random.below(static_cast<int>(bytes.size())))] = someByte(c.random);
    const auto answer = reader.read(bytes);
    if (!answer) continue;
    ++taken;
    const auto in_range = [](int counts) { return counts >= -32768 && counts <= 32767; };
    if (!std::all_of(answer->counts.begin(), answer->counts.end(), in_range))
      return c.fault(Verdict::kWrong, "counts beyond 16 bits", "");
  }
  add(c, taken, began);
}

}  // namespace pincer::campaign
