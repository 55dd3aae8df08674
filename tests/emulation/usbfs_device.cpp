#include "tests/emulation/usbfs_device.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "devices/usb/byte_order.h"

namespace pincer::emulation {
namespace {

constexpr unsigned kIn = 0x81, kOut = 0x01;

void resign(usb::FrameBytes& bytes) { usb::store<std::uint16_t>(bytes, 62, usb::crc16(std::span(bytes).first(62))); }

// The packet as the fault leaves it; sound to the last bit where the fault isn't one of content.
usb::FrameBytes spoiled(usb::FrameBytes bytes, TransferFault fault, std::int64_t index) {
  if (fault == TransferFault::kGarbled) bytes[static_cast<std::size_t>(index % 64)] ^= static_cast<std::uint8_t>(1 << (index % 8));
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
  [[maybe_unused]] const auto moved = ready ? ::read(read_fd_, drain.data(), drain.size()) : ::write(write_fd_, page.data(), page.size());
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
  if (u.endpoint == kOut) return takeOut(urb);
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

// What nobody could have looked at goes by in one step.
void UsbfsDevice::keepTime() {
  if (!time_ || gone_) return;
  constexpr std::chrono::milliseconds kStep(1), kMost(100);
  const auto now = std::chrono::steady_clock::now();
  if (now - *time_ > kMost) {
    firmware_->advance(std::chrono::duration<double>(now - *time_ - kStep).count());
    time_ = now - kStep;
  }
  bool moved = false;
  for (; now - *time_ >= kStep; *time_ += kStep) firmware_->advance(1e-3), moved = true;
  if (moved) pump();
}

void UsbfsDevice::advance(double dt) {
  const std::lock_guard lock(mutex_);
  time_.reset();
  firmware_->advance(dt);
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

// Whether the transfer ended.
bool UsbfsDevice::completeIn(Urb urb) {
  usb::FrameBytes bytes;
  while (true) {
    if (!held_.empty()) {
      bytes = held_.front();
      held_.pop_front();
    } else if (!firmware_->take(bytes)) {
      return false;
    }
    if (alterIn(bytes, *urb.urb, faultAt(true))) break;
  }
  finish(urb);
  return true;
}

// False: nothing arrives, the transfer waits on.
bool UsbfsDevice::alterIn(usb::FrameBytes& bytes, usbdevfs_urb& urb, TransferFault fault) {
  int length = static_cast<int>(usb::kFrameSize);
  switch (fault) {
    case TransferFault::kLost:
      return false;
    case TransferFault::kLate:
      late_ = bytes;
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
      held_.push_front(bytes);
      break;
    default:
      bytes = spoiled(bytes, fault, in_count_);
  }
  if (has_late_) {
    held_.push_front(late_);
    has_late_ = false;
  }
  length = std::min(length, urb.buffer_length);
  std::memcpy(urb.buffer, bytes.data(), static_cast<std::size_t>(length));
  urb.actual_length = length;
  return true;
}

int UsbfsDevice::takeOut(Urb urb) {
  usbdevfs_urb& u = *urb.urb;
  const TransferFault fault = faultAt(false);
  if (fault == TransferFault::kSubmitFails) return -ENOMEM;
  usb::FrameBytes bytes{};
  const auto length = std::min<std::size_t>(bytes.size(), static_cast<std::size_t>(u.buffer_length));
  std::memcpy(bytes.data(), u.buffer, length);
  u.actual_length = u.buffer_length;
  const auto deliver = [&](std::size_t count) { firmware_->received(std::span(bytes).first(count)); };
  switch (fault) {
    case TransferFault::kStall:
      halted_.insert(kOut);
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

// String descriptors; everything else of the control endpoint Linux answers itself.
void UsbfsDevice::control(usbdevfs_urb& urb) {
  const auto* setup = static_cast<const std::uint8_t*>(urb.buffer);
  if (setup[0] != 0x80 || setup[1] != 6 || setup[3] != 3) {
    urb.status = -EPIPE;
    return;
  }
  const std::array<std::uint8_t, 4> languages{4, 3, 9, 4};
  const auto length = std::min<int>(4, setup[6] | setup[7] << 8);
  std::memcpy(static_cast<std::uint8_t*>(urb.buffer) + 8, languages.data(), static_cast<std::size_t>(length));
  urb.actual_length = length;
}

}  // namespace pincer::emulation
