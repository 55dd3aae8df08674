#include "pincer/tests/emulation/remote_port.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace pincer::emulation {
namespace {

// The errno, with a descriptor where it is 0.
void answerOpen(int connection, std::int32_t error, int fd) {
  iovec part{&error, sizeof error};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  if (error == 0) {
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof fd);
    std::memcpy(CMSG_DATA(header), &fd, sizeof fd);
  }
  sendmsg(connection, &message, MSG_NOSIGNAL);
}

}  // namespace

void RemotePort::plug() {
  gadget_->powerUp();
  device_ = std::make_unique<UsbfsDevice>(gadget_);
  device_->catchUp();  // its time begins
}

// First what was under way, then the end: so the program reads all.
void RemotePort::unplug() {
  device_->unplug();
  flush();
  hangUp();
  device_.reset();
}

void RemotePort::opened(int connection) {
  int ends[2] = {-1, -1};
  const bool free = device_ != nullptr && connection_ < 0;
  const int error = !free ? (device_ ? EBUSY : ENODEV) : (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0 ? EMFILE : 0);
  if (error == 0) fcntl(ends[1], F_SETPIPE_SZ, 4096);
  answerOpen(connection, error, ends[1]);
  if (ends[1] >= 0) close(ends[1]);
  if (error != 0) {
    close(connection);
    return;
  }
  connection_ = connection;
  pipe_ = ends[0];
}

void RemotePort::serve() {
  UsbfsRequest request;
  while (connection_ >= 0) {
    const auto got = recv(connection_, &request, sizeof request, MSG_DONTWAIT);
    if (got < 0 && errno == EAGAIN) break;
    if (got < static_cast<ssize_t>(offsetof(UsbfsRequest, data))) {
      hangUp();
      break;
    }
    take(request);
  }
  if (device_) flush();
}

void RemotePort::take(const UsbfsRequest& request) {
  if (request.kind == UsbfsRequestKind::kClearHalt) return void(device_->clearHalt(request.endpoint));
  if (request.kind == UsbfsRequestKind::kDiscard) return void(device_->discard(request.key));
  auto transfer = std::make_unique<Transfer>();
  usbdevfs_urb& urb = *transfer->urb;
  urb.type = static_cast<unsigned char>(request.type);
  urb.endpoint = static_cast<unsigned char>(request.endpoint);
  urb.buffer = transfer->data.data();
  urb.buffer_length = std::clamp(request.length, 0, kMostTransferBytes);
  std::memcpy(transfer->data.data(), request.data, static_cast<std::size_t>(urb.buffer_length));
  transfers_[request.key] = std::move(transfer);
  const int error = device_->submit({&urb, request.key, nullptr});
  if (error == 0) return;
  urb.status = error;
  complete(request.key, urb);
}

void RemotePort::complete(std::uint64_t key, const usbdevfs_urb& urb) {
  UsbfsCompletion completion;
  completion.key = key;
  completion.status = urb.status;
  const bool control = urb.type == USBDEVFS_URB_TYPE_CONTROL, in = (urb.endpoint & 0x80) != 0;
  completion.length = urb.actual_length;
  const auto bytes = static_cast<std::size_t>(control || in ? urb.actual_length : 0);
  std::memcpy(completion.data, static_cast<const std::uint8_t*>(urb.buffer) + (control ? 8 : 0), bytes);
  send(connection_, &completion, offsetof(UsbfsCompletion, data) + bytes, MSG_DONTWAIT | MSG_NOSIGNAL);
  transfers_.erase(key);
}

// Answers go out, and only then the pipe says so.
void RemotePort::flush() {
  if (connection_ < 0) return;
  bool any = false;
  for (Urb urb; device_->reap(urb) == 0; any = true) complete(urb.key, *urb.urb);
  std::array<char, 4096> drain;
  if (any) [[maybe_unused]]
    const auto drained = read(pipe_, drain.data(), drain.size());
}

void RemotePort::catchUp() {
  device_->catchUp();
  flush();
}

void RemotePort::hangUp() {
  if (connection_ >= 0) {
    close(connection_);
    close(pipe_);
  }
  connection_ = pipe_ = -1;
  if (device_) device_->closed();
  transfers_.clear();
}

}  // namespace pincer::emulation
