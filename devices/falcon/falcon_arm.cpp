#include "pincer/devices/falcon/falcon_arm.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::falcon {
namespace {

// FTDI's vendor requests, and their values as libnifalcon uses them.
enum FtdiRequest : std::uint8_t { kReset = 0, kModem = 1, kFlow = 2, kBaud = 3, kData = 4, kLatency = 9 };
// Values of the requests. Baud rates are divisors of 3 MHz, 0x4000 adds a half: 312.5, 21 and 2. The high byte of a
// modem line tells which it is.
constexpr std::uint16_t kPurgeIn = 1, kPurgeOut = 2;
constexpr std::uint16_t kBaud9600 = 0x4138, kBaud140000 = 0x15, kBaudNormal = 0x2;
constexpr std::uint16_t kEightBits = 8, kNoFlow = 0, kRtsLow = 0x200, kDtrLow = 0x100, kDtrHigh = 0x101;
constexpr std::size_t kChunk = 62;  // of the image: a USB packet without the FTDI's status bytes
constexpr int kTimeout = 1000;      // [ms]
constexpr int kStatus = 2;          // bytes of the chip's before each packet
constexpr int kEmptyPackets = 40;   // without a word: at its latency of 16 ms 0.6 s
constexpr int kAnswerPackets = 8;   // in which an answer comes
constexpr int kGreetings = 8;       // tried at most
// The loader is ready once it answers "\nC\r" by "\nD,\r".
constexpr std::array<std::uint8_t, 3> kHello{0x0a, 0x43, 0x0d};
constexpr std::array<std::uint8_t, 4> kHelloBack{0x0a, 0x44, 0x2c, 0x0d};
constexpr double kCountsPerTorque = 10000;  // [1/(N m)], libnifalcon's
constexpr double kMostCounts = 4096;        // of a torque
constexpr int kLostAnswers = 50;            // in a row: the Falcon is gone

}  // namespace

// A packet that says something, status bytes and all: the chip sends its status alone whenever its latency timer runs
// out. How long it is; at most the status: it says nothing any more.
int FalconSession::hear(std::span<std::uint8_t> bytes) {
  int got = 0;
  for (int i = 0; i < kEmptyPackets && got >= 0 && got <= kStatus; ++i) got = port_.read(bytes, kTimeout);
  return got;
}

// True if `words` come; what else comes before them belongs to an earlier question.
bool FalconSession::hears(std::span<const std::uint8_t> words) {
  std::array<std::uint8_t, 64> bytes{};
  for (int i = 0; i < kAnswerPackets; ++i) {
    const int got = hear(bytes);
    if (got <= kStatus) return false;
    const auto end = bytes.begin() + got;
    if (std::search(bytes.begin() + kStatus, end, words.begin(), words.end()) != end) return true;
  }
  return false;
}

// An answer to a zero order means that a firmware runs already.
bool FalconSession::runs() {
  if (!enterNormalMode()) return false;
  for (int i = 0; i < 5; ++i) {
    if (exchange({})) return true;
  }
  return false;
}

std::string FalconSession::start(std::span<const std::uint8_t> firmware) {
  if (runs()) return "";
  if (firmware.empty()) {
    return "The Falcon has no firmware, and none was given. Take the image from the maker's driver: --firmware FILE "
           "(docs/devices/setup.md).";
  }
  if (!enterLoader())
    return "The Falcon doesn't answer its loader's greeting. Unplug its power for ten seconds and try again.";
  if (!load(firmware))
    return "The Falcon didn't take the firmware. Is the file the maker's image? Unplug its power for ten seconds and "
           "try again.";
  if (!enterNormalMode() || !exchange({}))
    return "The Falcon's firmware doesn't answer. Unplug its power for ten seconds and try again.";
  return "";
}

bool FalconSession::enterLoader() {
  const bool set = port_.control(kReset, kPurgeIn) && port_.control(kReset, kPurgeOut) && port_.control(kLatency, 16) &&
                   port_.control(kBaud, kBaud9600) && port_.control(kData, kEightBits) &&
                   port_.control(kFlow, kNoFlow) && port_.control(kModem, kRtsLow) && port_.control(kModem, kDtrLow) &&
                   port_.control(kModem, kDtrHigh);
  if (!set) return false;
  bool greeted = false;
  for (int i = 0; i < kGreetings && !greeted; ++i) greeted = port_.write(kHello) && hears(kHelloBack);
  // "A", which comes back at the faster rate.
  constexpr std::array<std::uint8_t, 1> kLetter{0x41};
  return greeted && port_.control(kModem, kDtrLow) && port_.control(kBaud, kBaud140000) && port_.write(kLetter) &&
         hears(kLetter);
}

// The loader sends back every byte of the image.
bool FalconSession::load(std::span<const std::uint8_t> firmware) {
  std::array<std::uint8_t, 64> bytes{};
  for (std::size_t at = 0; at < firmware.size();) {
    const auto chunk = firmware.subspan(at, std::min(kChunk, firmware.size() - at));
    if (!port_.write(chunk)) return false;
    for (std::size_t back = 0; back < chunk.size();) {
      const int got = hear(bytes);
      if (got <= kStatus || back + static_cast<std::size_t>(got - kStatus) > chunk.size()) return false;
      if (!std::equal(bytes.begin() + kStatus, bytes.begin() + got, chunk.begin() + static_cast<std::ptrdiff_t>(back)))
        return false;
      back += static_cast<std::size_t>(got - kStatus);
    }
    at += chunk.size();
  }
  return true;
}

bool FalconSession::enterNormalMode() {
  return port_.control(kLatency, 1) && port_.control(kBaud, kBaudNormal) && port_.control(kReset, kPurgeIn) &&
         port_.control(kReset, kPurgeOut);
}

std::optional<Answer> FalconSession::exchange(const Orders& orders) {
  if (!port_.write(packetOf(orders))) return std::nullopt;
  std::array<std::uint8_t, 64> bytes{};
  for (int i = 0; i < kAnswerPackets; ++i) {  // the answer may come in pieces, or after packets of status bytes only
    const int got = port_.read(bytes, 10);
    if (got < 0) return std::nullopt;
    if (const auto answer = reader_.read(std::span(bytes).first(static_cast<std::size_t>(got)))) return answer;
  }
  return std::nullopt;
}

FalconArm::FalconArm(std::unique_ptr<FalconPort> port, std::vector<std::uint8_t> firmware)
    : port_(std::move(port)), session_(*port_) {
  const std::string problem = session_.start(firmware);
  if (!problem.empty()) throw std::runtime_error("USB port " + port_->place() + ": " + problem);
  capabilities_.peak_force = 9;
  capabilities_.continuous_force = 4;
  capabilities_.resolution = 60e-6;
  capabilities_.stiffness_limit = 2000;
  capabilities_.peak_torque = Vec3::Constant(kMostCounts / kCountsPerTorque);
  capabilities_.workspace_min_D = Vec3(-0.05, -0.05, -0.05);
  capabilities_.workspace_max_D = Vec3(0.05, 0.05, 0.05);
  thread_ = std::thread([this] { run(); });
}

FalconArm::~FalconArm() {
  end_ = true;
  thread_.join();
  session_.exchange({});  // torques off
}

ArmSample FalconArm::sample() {
  readings_.update();
  const Reading& r = readings_.current();
  ArmSample sample;
  sample.time = 1e-9 * static_cast<double>(r.ns - epoch_ns_);
  sample.valid = r.valid && state() == DeviceState::kReady;
  if (!sample.valid) return sample;
  sample.p_DF = r.p_DF;
  sample.J = r.J;
  sample.switches = r.buttons;
  return sample;
}

void FalconArm::commandForce(const Vec3& f_D) {
  wishes_.writable() = {f_D.allFinite() ? f_D : Vec3::Zero(), usb::monotonicNs()};
  wishes_.publish();
}

bool FalconArm::read(const Answer& answer, Reading& reading) const {
  const Vec3 angles(angleOf(answer.counts[0]), angleOf(answer.counts[1]), angleOf(answer.counts[2]));
  const auto p = forward(angles, reading.p_DF + Vec3(0, 0, kCentre));
  const auto J = p ? jacobian(*p, angles) : std::nullopt;
  reading.valid = J.has_value();
  reading.ns = usb::monotonicNs();
  if (!J) {
    reading.p_DF.setZero();  // the next guess
    return false;
  }
  reading.p_DF = *p - Vec3(0, 0, kCentre);
  reading.J = *J;
  reading.buttons = answer.buttons;
  return true;
}

Orders FalconArm::ordersNow(const Reading& last, bool homed) {
  Orders orders;
  orders.homing = !homed;
  orders.lamps = homed ? 4 : 2;
  wishes_.update();
  const Wish& wish = wishes_.current();
  const bool may =
      homed && last.valid && !stopped_.load(std::memory_order_acquire) && usb::monotonicNs() - wish.ns < kForceLife;
  if (!may) return orders;
  const Vec3 torque = last.J.transpose() * wish.f_D;
  const double most = std::max(1.0, kCountsPerTorque / kMostCounts * torque.cwiseAbs().maxCoeff());  // one common scale
  for (std::size_t i = 0; i < 3; ++i) {
    orders.torques[i] = static_cast<int>(-kCountsPerTorque * torque[static_cast<Eigen::Index>(i)] / most);
  }
  return orders;
}

void FalconArm::run() {
  Reading reading;
  bool homed = false;
  int silent = 0;
  state_ = DeviceState::kHoming;
  while (!end_ && silent < kLostAnswers) {
    const auto answer = session_.exchange(ordersNow(reading, homed));
    silent = answer ? 0 : silent + 1;
    if (!answer) continue;
    homed = homed || answer->homed == 7;
    read(*answer, reading);
    reading.valid = reading.valid && homed;
    readings_.writable() = reading;
    readings_.publish();
    if (homed) state_ = DeviceState::kReady;
  }
  if (silent >= kLostAnswers) state_ = DeviceState::kFaulted;
}

}  // namespace pincer::devices::falcon
