// usbfs_preload: a library for LD_PRELOAD. The USB devices of the program that it is loaded into are those of an
// emulator in another process (usbfs_wire.h).
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "pincer/tests/emulation/usbfs_device.h"
#include "pincer/tests/emulation/usbfs_wire.h"

namespace pincer::emulation {
namespace {

void closeQuietly(int fd) { syscall(SYS_close, fd); }

class PreloadedPort {
 public:
  PreloadedPort(int socket, int fd) : socket_(socket), fd_(fd) {}
  void shut() { closeQuietly(socket_); }

  bool gone() const { return gone_; }
  int submit(Urb urb) {
    UsbfsRequest request;
    request.type = urb.urb->type;
    request.endpoint = urb.urb->endpoint;
    request.length = urb.urb->buffer_length;
    request.key = urb.key;
    if (request.length > kMostTransferBytes) return -EINVAL;
    const auto bytes = static_cast<std::size_t>((request.endpoint & 0x80) != 0 ? 0 : request.length);
    std::memcpy(request.data, urb.urb->buffer, bytes);
    return send(request, bytes);
  }
  int discard(std::uint64_t key) {
    UsbfsRequest request;
    request.kind = UsbfsRequestKind::kDiscard;
    request.key = key;
    return send(request, 0);
  }
  int clearHalt(unsigned endpoint) {
    UsbfsRequest request;
    request.kind = UsbfsRequestKind::kClearHalt;
    request.endpoint = endpoint;
    return send(request, 0);
  }
  // Nothing there: the pipe is filled, and asked for once more, because something may have come in between.
  int reap(Urb& urb) {
    for (int round = 0; round < 2; ++round) {
      UsbfsCompletion completion;
      const auto got = recv(socket_, &completion, sizeof completion, MSG_DONTWAIT);
      if (got >= static_cast<ssize_t>(offsetof(UsbfsCompletion, data))) return take(completion, urb);
      if (got == 0 || (got < 0 && errno != EAGAIN)) {
        gone_ = true;
        return -ENODEV;
      }
      if (round == 0) fill();
    }
    return -EAGAIN;
  }

 private:
  int send(const UsbfsRequest& request, std::size_t bytes) {
    return ::send(socket_, &request, offsetof(UsbfsRequest, data) + bytes, MSG_NOSIGNAL) < 0 ? -ENODEV : 0;
  }
  static int take(const UsbfsCompletion& completion, Urb& urb) {
    auto* own = reinterpret_cast<usbdevfs_urb*>(completion.key);
    own->status = completion.status;
    own->actual_length = completion.length;
    const bool control = own->type == USBDEVFS_URB_TYPE_CONTROL;
    if ((own->endpoint & 0x80) != 0 || control) {
      std::memcpy(static_cast<std::uint8_t*>(own->buffer) + (control ? 8 : 0), completion.data,
                  static_cast<std::size_t>(completion.length));
    }
    urb.urb = own;
    return 0;
  }
  // The device may be unplugged at this very moment: a pipe without a reader mustn't end the program.
  void fill() {
    static thread_local const bool quiet = [] {
      sigset_t broken_pipe;
      sigemptyset(&broken_pipe);
      sigaddset(&broken_pipe, SIGPIPE);
      return pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr) == 0;
    }();
    const char byte = 0;
    if (quiet) [[maybe_unused]]
      const auto written = write(fd_, &byte, 1);
  }

  int socket_, fd_;
  bool gone_ = false;
};

std::array<std::atomic<PreloadedPort*>, 4096> g_ports{};

bool answersUsbfs() {
  static const bool any = std::getenv(kUsbfsAddress) != nullptr;
  return any;
}

PreloadedPort* usbfsAt(int fd) {
  return fd >= 0 && fd < static_cast<int>(g_ports.size()) ? g_ports[static_cast<std::size_t>(fd)].load() : nullptr;
}

// Past umockdev, which has an opinion on sockets.
int connected() {
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const char* name = std::getenv(kUsbfsAddress);
  const std::size_t length = std::min(std::strlen(name), sizeof address.sun_path - 1);
  std::memcpy(address.sun_path + 1, name, length);  // abstract: a zero before it
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  if (socket >= 0 && syscall(SYS_connect, socket, &address, size) == 0) return socket;
  if (socket >= 0) closeQuietly(socket);
  return -1;
}

// The errno, and the descriptor that comes with it.
int answerOf(int socket, int& fd) {
  std::int32_t error = ENODEV;
  iovec part{&error, sizeof error};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  if (recvmsg(socket, &message, MSG_CMSG_CLOEXEC) != static_cast<ssize_t>(sizeof error)) return ENODEV;
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (error == 0 && header == nullptr) return ENODEV;
  if (header != nullptr) std::memcpy(&fd, CMSG_DATA(header), sizeof fd);
  return error;
}

int openUsbfs(const char* node) {
  const int socket = connected();
  if (socket < 0) return -ENODEV;
  int fd = -1;
  const bool asked = ::send(socket, node, std::strlen(node), MSG_NOSIGNAL) > 0;
  const int error = asked ? answerOf(socket, fd) : ENODEV;
  if (error != 0 || fd < 0 || fd >= static_cast<int>(g_ports.size())) {
    closeQuietly(socket);
    return error != 0 ? -error : -EMFILE;
  }
  g_ports[static_cast<std::size_t>(fd)] = new PreloadedPort(socket, fd);
  return fd;
}

void closeUsbfs(int fd) {
  PreloadedPort* port = g_ports[static_cast<std::size_t>(fd)].exchange(nullptr);
  port->shut();
  delete port;
}

}  // namespace
}  // namespace pincer::emulation

#include "pincer/tests/emulation/usbfs_symbols.h"
