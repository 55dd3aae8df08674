#include "pincer/devices/usb/usb_host.h"

#include <chrono>

namespace pincer::devices::usb {
namespace {

constexpr std::int64_t kAskAgain = 50'000'000;  // [ns]
constexpr int kAsksBeforeAProblem = 20;         // unanswered, a second

template <typename Device>
std::vector<Device*> inOrder(const std::map<std::string, std::unique_ptr<Device>>& devices) {
  std::vector<Device*> all;
  for (const auto& [serial, device] : devices) all.push_back(device.get());
  return all;
}

template <typename Device>
std::size_t countReady(const std::map<std::string, std::unique_ptr<Device>>& devices) {
  std::size_t ready = 0;
  for (const auto& [serial, device] : devices) ready += device->linkState() == DeviceState::kReady ? 1 : 0;
  return ready;
}

template <typename Device>
Device& foundOrMade(std::map<std::string, std::unique_ptr<Device>>& devices, const Identity& identity, UsbThread& usb) {
  const auto found = devices.find(identity.serial);
  if (found != devices.end()) return *found->second;
  return *devices.emplace(identity.serial, std::make_unique<Device>(identity, usb)).first->second;
}

}  // namespace

UsbHost::UsbHost(Clock clock, const OpenBus& open) : clock_(std::move(clock)), bus_(open(*this, clock_)) {
  waking_.store(bus_.get(), std::memory_order_release);
  bus_->wake();
}

UsbHost::~UsbHost() {
  waking_.store(nullptr, std::memory_order_release);
  bus_.reset();
}

bool UsbHost::waitFor(std::size_t arms, std::size_t displays, double timeout) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
  std::unique_lock lock(slow_);
  while (!readyNow(arms, displays)) {
    if (searched_ && open_ports_ == 0) return false;
    if (changed_.wait_for(lock, std::chrono::milliseconds(5)), std::chrono::steady_clock::now() > until)
      return readyNow(arms, displays);
  }
  return true;
}

bool UsbHost::readyNow(std::size_t arms, std::size_t displays) const {
  return countReady(arms_) >= arms && countReady(displays_) >= displays && searched_;
}

std::vector<UsbArm*> UsbHost::arms() {
  const std::lock_guard lock(slow_);
  return inOrder(arms_);
}

std::vector<UsbDisplay*> UsbHost::displays() {
  const std::lock_guard lock(slow_);
  return inOrder(displays_);
}

std::vector<std::string> UsbHost::problems() {
  const std::lock_guard lock(slow_);
  return problems_;
}

void UsbHost::setEpoch(std::int64_t ns) {
  const std::lock_guard lock(slow_);
  epoch_ns_ = ns;
  for (const auto& [serial, arm] : arms_) arm->setEpoch(ns);
  for (const auto& [serial, display] : displays_) display->setEpoch(ns);
}

void UsbHost::opened(int port, std::int64_t now) {
  ports_[static_cast<std::size_t>(port)] = {
      .open = true, .link = nullptr, .next_identify = now, .sequence = 0, .asked = 0};
  const std::lock_guard lock(slow_);
  ++open_ports_;
}

void UsbHost::closed(int port, std::int64_t) {
  Port& p = ports_[static_cast<std::size_t>(port)];
  if (p.link != nullptr) p.link->detach();
  p = Port{};
  const std::lock_guard lock(slow_);
  --open_ports_;
  changed_.notify_all();
}

void UsbHost::received(int port, std::span<const std::uint8_t> packet, std::int64_t now) {
  Port& p = ports_[static_cast<std::size_t>(port)];
  Frame frame;
  const bool sound = decode(packet, frame) == FrameError::kNone;
  if (p.link == nullptr) {
    sound ? meet(p, frame, now) : void(++stray_);
  } else {
    sound ? p.link->received(frame, now) : p.link->countBad();
  }
}

// The first identity that a port sends says which device it is.
void UsbHost::meet(Port& port, const Frame& frame, std::int64_t now) {
  if (frame.type != FrameType::kIdentity) return;  // states of a device that streams already
  const auto identity = identityIn(frame);
  if (!identity) {
    ++stray_;
    return;
  }
  DeviceLink* link = linkOf(*identity);
  if (link == nullptr || link->attached()) {
    port.next_identify = INT64_MAX;  // never asked again
    return problem("Two USB devices call themselves " + nameOf(identity->kind) + " " + identity->serial +
                   ". Give each its own serial number (docs/devices/setup.md), or unplug one.");
  }
  port.link = link;
  link->attach(now, port.sequence);
  link->received(frame, now);
  changed_.notify_all();
}

// Null where another kind of device with other properties has the serial number.
DeviceLink* UsbHost::linkOf(const Identity& identity) {
  UsbThread& usb = *this;
  const std::lock_guard lock(slow_);
  DeviceLink& link = identity.kind == DeviceKind::kArm
                         ? static_cast<DeviceLink&>(foundOrMade(arms_, identity, usb))
                         : static_cast<DeviceLink&>(foundOrMade(displays_, identity, usb));
  link.setEpoch(epoch_ns_);
  return link.deviceIdentity() == identity ? &link : nullptr;
}

bool UsbHost::toSend(int port, FrameBytes& packet, std::int64_t now) {
  Port& p = ports_[static_cast<std::size_t>(port)];
  if (!p.open) return false;
  Frame frame;
  if (p.link != nullptr) {
    if (!p.link->nextFrame(frame, now)) return false;
  } else {
    if (now < p.next_identify) return false;
    p.next_identify = now + kAskAgain;
    frame.type = FrameType::kIdentify;
    frame.sequence = ++p.sequence;
    frame.time_us = static_cast<std::uint64_t>(now / 1000);
    if (++p.asked == kAsksBeforeAProblem) {
      problem(
          "A USB device doesn't say who it is. Unplug it and plug it in again; check its firmware "
          "(docs/usb-protocol.md).");
    }
  }
  packet = encode(frame);
  return true;
}

void UsbHost::problem(const std::string& text) {
  const std::lock_guard lock(slow_);
  if (problems_.size() < 32) problems_.push_back(text);
  changed_.notify_all();
}

void UsbHost::searched() {
  const std::lock_guard lock(slow_);
  searched_ = true;
  changed_.notify_all();
}

void UsbHost::wake() noexcept {
  if (UsbBus* bus = waking_.load(std::memory_order_acquire)) bus->wake();
}

}  // namespace pincer::devices::usb
