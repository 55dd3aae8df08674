#include "pincer/tests/emulation/usbfs_device.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "pincer/devices/usb/byte_order.h"

namespace pincer::emulation {
namespace {

namespace usb = devices::usb;

constexpr unsigned kIn = 0x81;

void resign(Packet& bytes) { usb::store<std::uint16_t>(bytes, 62, usb::crc16(std::span(bytes).first(62))); }

// The packet as the fault leaves it; sound to the last bit where the fault isn't one of content.
Packet spoiled(Packet bytes, TransferFault fault, std::int64_t index) {
  if (fault == TransferFault::kGarbled)
    bytes[static_cast<std::size_t>(index % 64)] ^= static_cast<std::uint8_t>(1 << (index % 8));
  if (fault == TransferFault::kWrongMagic) bytes[0] = 'X', resign(bytes);
  if (fault == TransferFault::kWrongVersion) bytes[2] = 2, resign(bytes);
  if (fault == TransferFault::kWrongType) bytes[3] = 0x7f, resign(bytes);
  if (fault == TransferFault::kBadValue) bytes[16] = 0xff, bytes[61] = 0xff, resign(bytes);
  return bytes;
}

}  // namespace

const char* nameOf(TransferFault fault) {
  constexpr const char* kNames[] = {"none",        "stall",         "short",      "empty",          "garbled",
                                    "duplicate",   "late",          "lost",       "protocol error", "overflow",
                                    "wrong magic", "wrong version", "wrong type", "bad value",      "submit fails"};
  return kNames[static_cast<std::size_t>(fault)];
}

UsbfsDevice::~UsbfsDevice() { closed(); }

int UsbfsDevice::open(int& fd) {
  const std::lock_guard lock(mutex_);
  if (gone_) return -ENODEV;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) return -EMFILE;
  fcntl(ends[1], F_SETPIPE_SZ, 4096);
  read_fd_ = ends[0];
  write_fd_ = fd = ends[1];
  raised_ = true;
  show();
  return 0;
}

void UsbfsDevice::opened(int read_fd, int write_fd) {
  const std::lock_guard lock(mutex_);
  read_fd_ = read_fd;
  write_fd_ = write_fd;
  raised_ = true;
  show();
}

// The client closes the write end itself.
void UsbfsDevice::closed() {
  const std::lock_guard lock(mutex_);
  if (read_fd_ >= 0) ::close(read_fd_);
  read_fd_ = write_fd_ = -1;
  waiting_.clear();
  done_.clear();
}

bool UsbfsDevice::gone() const {
  const std::lock_guard lock(mutex_);
  return gone_;
}

std::int64_t UsbfsDevice::faultsDone() const {
  const std::lock_guard lock(mutex_);
  return faults_done_;
}

std::int64_t UsbfsDevice::transfers() const {
  const std::lock_guard lock(mutex_);
  return in_count_ + out_count_;
}

// A pipe of one page, full or empty.
void UsbfsDevice::show() {
  const bool ready = !done_.empty();
  if (ready == raised_ || read_fd_ < 0) return;
  static const std::array<char, 4096> page{};
  std::array<char, 4096> drain;
  [[maybe_unused]] const auto moved =
      ready ? ::read(read_fd_, drain.data(), drain.size()) : ::write(write_fd_, page.data(), page.size());
  raised_ = ready;
}

void UsbfsDevice::finish(Urb urb) {
  done_.push_back(urb);
  show();
}

int UsbfsDevice::submit(Urb urb) {
  const std::lock_guard lock(mutex_);
  if (gone_) return -ENODEV;
  keepTime();
  usbdevfs_urb& u = *urb.urb;
  u.status = 0;
  u.actual_length = 0;
  if (u.type == USBDEVFS_URB_TYPE_CONTROL) {
    control(u);
    finish(urb);
    return 0;
  }
  if (halted_.count(u.endpoint) != 0) {
    u.status = -EPIPE;
    finish(urb);
    return 0;
  }
  if (u.endpoint == gadget_->outEndpoint()) return takeOut(urb);
  waiting_.push_back(urb);
  pump();
  return 0;
}

int UsbfsDevice::reap(Urb& urb) {
  const std::lock_guard lock(mutex_);
  if (done_.empty()) {
    show();
    return gone_ ? -ENODEV : -EAGAIN;
  }
  urb = done_.front();
  done_.pop_front();
  show();
  return 0;
}

int UsbfsDevice::discard(std::uint64_t key) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const Urb& u) { return u.key == key; });
  if (found == waiting_.end()) return -EINVAL;
  const Urb urb = *found;
  waiting_.erase(found);
  urb.urb->status = -ENOENT;
  finish(urb);
  return 0;
}

int UsbfsDevice::clearHalt(unsigned endpoint) {
  const std::lock_guard lock(mutex_);
  halted_.erase(endpoint);
  if (gone_) return -ENODEV;
  pump();
  return 0;
}

void UsbfsDevice::catchUp() {
  const std::lock_guard lock(mutex_);
  if (!time_) time_ = std::chrono::steady_clock::now();
  keepTime();
}

// Time in which nobody could have looked goes by in one step.
void UsbfsDevice::keepTime() {
  if (!time_ || gone_) return;
  constexpr std::chrono::milliseconds kStep(1), kMost(100);
  const auto now = std::chrono::steady_clock::now();
  if (now - *time_ > kMost) {
    gadget_->advance(std::chrono::duration<double>(now - *time_ - kStep).count());
    time_ = now - kStep;
  }
  for (; now - *time_ >= kStep; *time_ += kStep) {
    gadget_->advance(1e-3);
    pump();  // the bus fills waiting transfers whether this computer has a processor for us or not
  }
}

void UsbfsDevice::advance(double dt) {
  const std::lock_guard lock(mutex_);
  time_.reset();
  gadget_->advance(dt);
  if (!gone_) pump();
}

// Every transfer under way comes back, then the descriptor is dead.
void UsbfsDevice::unplug() {
  const std::lock_guard lock(mutex_);
  gone_ = true;
  for (const Urb& urb : waiting_) {
    urb.urb->status = -ESHUTDOWN;
    done_.push_back(urb);
  }
  waiting_.clear();
  show();
  if (read_fd_ >= 0) ::close(read_fd_);
  read_fd_ = -1;
}

void UsbfsDevice::injectAt(std::int64_t index, bool in, TransferFault fault) {
  const std::lock_guard lock(mutex_);
  (in ? in_faults_ : out_faults_)[index + (in ? in_count_ : out_count_)] = fault;
}

TransferFault UsbfsDevice::faultAt(bool in) {
  auto& faults = in ? in_faults_ : out_faults_;
  const auto found = faults.find((in ? in_count_ : out_count_)++);
  if (found == faults.end()) return TransferFault::kNone;
  const TransferFault fault = found->second;
  faults.erase(found);
  ++faults_done_;
  return fault;
}

void UsbfsDevice::pump() {
  while (!waiting_.empty() && halted_.count(kIn) == 0 && completeIn(waiting_.front())) waiting_.pop_front();
}

// True if the transfer ended.
bool UsbfsDevice::completeIn(Urb urb) {
  HeldPacket packet;
  while (true) {
    if (!held_.empty()) {
      packet = held_.front();
      held_.pop_front();
    } else if (packet.size = gadget_->take(packet.bytes); packet.size == 0) {
      return false;
    }
    if (alterIn(packet, *urb.urb, faultAt(true))) break;
  }
  finish(urb);
  return true;
}

// False: nothing arrives, the transfer waits on.
bool UsbfsDevice::alterIn(HeldPacket& packet, usbdevfs_urb& urb, TransferFault fault) {
  int length = static_cast<int>(packet.size);
  switch (fault) {
    case TransferFault::kLost:
      return false;
    case TransferFault::kLate:
      late_ = packet;
      has_late_ = true;
      return false;
    case TransferFault::kStall:
      halted_.insert(kIn);
      urb.status = -EPIPE;
      length = 0;
      break;
    case TransferFault::kProtocolError:
    case TransferFault::kSubmitFails:
      urb.status = -EPROTO;
      length = 0;
      break;
    case TransferFault::kOverflow:
      urb.status = -EOVERFLOW;
      break;
    case TransferFault::kShort:
      length = 40;
      break;
    case TransferFault::kEmpty:
      length = 0;
      break;
    case TransferFault::kDuplicate:
      held_.push_front(packet);
      break;
    default:
      packet.bytes = spoiled(packet.bytes, fault, in_count_);
  }
  if (has_late_) {
    held_.push_front(late_);
    has_late_ = false;
  }
  length = std::min(length, urb.buffer_length);
  std::memcpy(urb.buffer, packet.bytes.data(), static_cast<std::size_t>(length));
  urb.actual_length = length;
  return true;
}

int UsbfsDevice::takeOut(Urb urb) {
  usbdevfs_urb& u = *urb.urb;
  const TransferFault fault = faultAt(false);
  if (fault == TransferFault::kSubmitFails) return -ENOMEM;
  Packet bytes{};
  const auto length = std::min<std::size_t>(bytes.size(), static_cast<std::size_t>(u.buffer_length));
  std::memcpy(bytes.data(), u.buffer, length);
  u.actual_length = u.buffer_length;
  const auto deliver = [&](std::size_t count) { gadget_->received(std::span(bytes).first(count)); };
  switch (fault) {
    case TransferFault::kStall:
      halted_.insert(u.endpoint);
      u.status = -EPIPE;
      break;
    case TransferFault::kProtocolError:
    case TransferFault::kOverflow:
      u.status = -EPROTO;
      break;
    case TransferFault::kLost:
      break;
    case TransferFault::kShort:
      deliver(40);
      break;
    case TransferFault::kEmpty:
      deliver(0);
      break;
    case TransferFault::kDuplicate:
    case TransferFault::kLate:  // an old packet once more, after its successor
      deliver(length);
      deliver(length);
      break;
    default:
      bytes = spoiled(bytes, fault, out_count_);
      deliver(length);
  }
  finish(urb);
  pump();
  return 0;
}

// Vendor requests and string descriptors; everything else of the control endpoint Linux answers itself.
void UsbfsDevice::control(usbdevfs_urb& urb) {
  auto* bytes = static_cast<std::uint8_t*>(urb.buffer);
  if (bytes[0] == 0x40) {
    urb.status = gadget_->control(bytes[1], static_cast<std::uint16_t>(bytes[2] | bytes[3] << 8)) ? 0 : -EPIPE;
    return;
  }
  if (bytes[0] != 0x80 || bytes[1] != 6 || bytes[3] != 3) {
    urb.status = -EPIPE;
    return;
  }
  std::vector<std::uint8_t> text{4, 3, 9, 4};  // the languages: English
  if (bytes[2] != 0) {
    text = {0, 3};
    for (const char c : gadget_->serialText()) text.insert(text.end(), {static_cast<std::uint8_t>(c), 0});
    text[0] = static_cast<std::uint8_t>(text.size());
  }
  urb.actual_length = std::min<int>(static_cast<int>(text.size()), bytes[6] | bytes[7] << 8);
  std::memcpy(bytes + 8, text.data(), static_cast<std::size_t>(urb.actual_length));
}

}  // namespace pincer::emulation
