// emulated_falcon: a Novint Falcon that isn't there: its FTDI chip, its loader, its firmware and its
// three motors, as libnifalcon finds them. Its grip stays where it is, unless somebody lets it go:
//
//   I d2q/dt2 = tau - d dq/dt      of each motor's angle q, from one order's torque tau to the next
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "pincer/devices/falcon/falcon_arm.h"

namespace pincer::tests {

class EmulatedFalcon {
 public:
  // `image_size` of the firmware that it runs [bytes].
  explicit EmulatedFalcon(std::size_t image_size) : image_size_(image_size) {}

  bool control(std::uint8_t request, std::uint16_t value) {
    if (request == 3) baud_ = value;
    if (request == 3 && value == 2 && loaded_ == image_size_) runs_ = true;
    if (request == 0) answers_.clear();
    return true;
  }
  void write(std::span<const std::uint8_t> bytes) {
    if (baud_ == 0x4138) {
      if (bytes.size() == 3 && bytes[1] == 0x43) say({0x0a, 0x44, 0x2c, 0x0d});
    } else if (baud_ == 0x15 && !ready_) {
      ready_ = bytes[0] == 0x41;
      say({0x41});
    } else if (baud_ == 0x15) {
      echo(bytes);
    } else if (runs_ && bytes.size() == 16) {
      obey(bytes);
    }
  }
  // A packet for the host: two bytes of status, and what the chip has to say; how long it is.
  std::size_t read(std::span<std::uint8_t> packet) {
    packet[0] = 0x01, packet[1] = 0x60;
    if (answers_.empty()) return 2;
    const auto answer = answers_.front();
    answers_.pop_front();
    std::copy(answer.begin(), answer.end(), packet.begin() + 2);
    return answer.size() + 2;
  }

  // A grip that is free moves, for `dt` [s]. Positive torque counts turn a motor towards smaller angles.
  void advance(double dt) {
    if (!free) return;
    constexpr double kCountsPerTorque = 10000;         // [1/(N m)]
    constexpr double kInertia = 1.2e-4, kDrag = 4e-4;  // 100 g of grip on three thighs of 60 mm [kg m^2, N m s]
    for (int i = 0; i < 3; ++i) {
      const double torque = -torques_[i] / kCountsPerTorque;
      speeds_[i] += dt * (torque - kDrag * speeds_[i]) / kInertia;
      turned_[i] += dt * speeds_[i];
    }
  }

  std::atomic<bool> spoils_image{false};
  std::atomic<bool> free{false};
  std::atomic<int> torque0{0};    // of the first motor, as ordered [counts]
  std::atomic<int> counts{-150};  // of all three encoders, before the grip moved

 private:
  void say(std::vector<std::uint8_t> bytes) { answers_.push_back(std::move(bytes)); }
  void echo(std::span<const std::uint8_t> bytes) {
    std::vector<std::uint8_t> back(bytes.begin(), bytes.end());
    if (spoils_image) back[0] ^= 1;
    loaded_ += bytes.size();
    // In two pieces, as it may come.
    const auto half = static_cast<std::ptrdiff_t>(back.size() / 2);
    if (half > 0) say({back.begin(), back.begin() + half});
    say({back.begin() + half, back.end()});
  }
  void obey(std::span<const std::uint8_t> bytes) {
    devices::falcon::Packet packet;
    std::copy_n(bytes.begin(), packet.size(), packet.begin());
    const auto order = devices::falcon::answerIn(packet);
    if (!order) return;
    torques_ = order->counts;
    torque0 = torques_[0];
    const bool homing = (packet[13] - 'A') & 1;
    devices::falcon::Packet answer = devices::falcon::packetOf({places(), false, 0});
    if (homing) answer[13] = static_cast<std::uint8_t>('A' + 0x70);
    say({answer.begin(), answer.end()});
  }

  std::array<int, 3> places() const {
    std::array<int, 3> all;
    for (int i = 0; i < 3; ++i) {
      const double start = devices::falcon::angleOf(counts);
      all[i] = turned_[i] == 0 ? counts.load() : devices::falcon::countOf(start + turned_[i]);
    }
    return all;
  }

  std::array<int, 3> torques_{};
  std::array<double, 3> speeds_{}, turned_{};  // [rad/s, rad]
  std::size_t image_size_, loaded_ = 0;
  int baud_ = 0;
  bool ready_ = false, runs_ = false;
  std::deque<std::vector<std::uint8_t>> answers_;
};

}  // namespace pincer::tests
