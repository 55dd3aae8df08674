#include <algorithm>
#include <cmath>
#include <optional>

#include "pincer/devices/usb/frame.h"
#include "pincer/devices/usb/messages.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

using namespace devices::usb;

template <class Message>
void demandSameAgain(const Frame& frame, const std::optional<Message>& message) {
  if (!message) return;
  const Frame again = toFrame(*message);
  demand(again.payload == frame.payload && again.type == frame.type, "a message that is told again is the same bytes");
}

// A gimbal may be told by a quaternion that isn't of unit length to the last step, and is read as one that is: it is
// the same turn again, all else the same bytes.
void demandSameArmAgain(const Frame& frame) {
  constexpr std::size_t kGimbal = 26, kGimbalBytes = 8;  // docs/usb-protocol.md
  const std::optional<ArmState> state = armStateIn(frame);
  if (!state) return;
  Frame again = toFrame(*state);
  const std::optional<ArmState> second = armStateIn(again);
  demand(second && second->q_DF.has_value() == state->q_DF.has_value(), "a state that is told again is read again");
  if (state->q_DF)
    demand(std::abs(second->q_DF->dot(*state->q_DF)) > 1 - 1e-6, "a gimbal is told again as the same turn");
  std::copy_n(frame.payload.begin() + kGimbal, kGimbalBytes, again.payload.begin() + kGimbal);
  demand(again.payload == frame.payload, "a state that is told again is the same bytes but for the gimbal's length");
}

void readPayload(const Frame& frame) {
  demandSameAgain(frame, identityIn(frame));
  demandSameAgain(frame, armCommandIn(frame));
  demandSameArmAgain(frame);
  demandSameAgain(frame, displayCommandIn(frame));
  demandSameAgain(frame, displayStateIn(frame));
  demandSameAgain(frame, statusIn(frame));
  armCapabilitiesIn(frame);
  displayCapabilitiesIn(frame);
  const auto entry = calibrationIn(frame);
  demand(!entry || toFrame(*entry, frame.type).payload == frame.payload,
         "a calibration that is told again is the same bytes");
}

}  // namespace

// The bytes as they come; then with a sound head and checksum, which no fuzzer guesses.
void usb_frame(Bytes input) {
  Frame frame;
  if (decode(input, frame) == FrameError::kNone) {
    const FrameBytes again = encode(frame);
    demand(std::equal(again.begin(), again.end(), input.begin(), input.end()),
           "a frame that is told again is the same bytes");
    readPayload(frame);
  }
  if (input.size() < 4) return;
  frame.type = static_cast<FrameType>(input[3]);
  const Bytes payload = input.subspan(std::min<std::size_t>(input.size(), 16));
  frame.payload = {};
  std::copy_n(payload.begin(), std::min(payload.size(), kPayloadSize), frame.payload.begin());
  Frame decoded;
  if (decode(encode(frame), decoded) == FrameError::kNone)
    demand(decoded.payload == frame.payload, "a payload arrives as it was sent");
  readPayload(frame);
}

}  // namespace pincer::fuzz
