#include "tests/emulation/usbfs_interpose.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <map>

namespace pincer::emulation {
namespace {

constexpr int kMostFds = 4096;

// The hot path asks one atomic; the shared pointers keep a device alive until its descriptor is closed.
struct Table {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<UsbfsDevice>> nodes;
  std::map<int, std::shared_ptr<UsbfsDevice>> owners;
  std::array<std::atomic<UsbfsDevice*>, kMostFds> fds{};
  std::atomic<bool> any{false}, denied{false};
};
Table& table() {
  static Table the_table;
  return the_table;
}

template <typename F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

UsbfsDevice* deviceAt(int fd) {
  return table().any && fd >= 0 && fd < kMostFds ? table().fds[static_cast<std::size_t>(fd)].load() : nullptr;
}

int failWith(int error) {
  errno = error;
  return -1;
}

int openNode(const char* path) {
  Table& t = table();
  const std::lock_guard lock(t.mutex);
  const auto found = t.nodes.find(path);
  if (found == t.nodes.end() || !found->second) return failWith(ENOENT);
  if (t.denied) return failWith(EACCES);
  int fd = -1;
  if (const int error = found->second->open(fd); error < 0) return failWith(-error);
  t.owners[fd] = found->second;
  t.fds[static_cast<std::size_t>(fd)] = found->second.get();
  return fd;
}

int openAny(const char* name, const char* path, int flags, mode_t mode) {
  if (table().any && std::strncmp(path, "/dev/bus/usb/", 13) == 0) return openNode(path);
  return next<int (*)(const char*, int, ...)>(name)(path, flags, mode);
}

int request(UsbfsDevice& device, unsigned long code, void* argument) {
  const auto answer = [](int result) { return result < 0 ? failWith(-result) : result; };
  switch (code) {
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<std::uint32_t*>(argument) =
          USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      return 0;
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_RESET:
      return answer(device.gone() ? -ENODEV : 0);
    case USBDEVFS_GETDRIVER:
      return answer(-ENODATA);
    case USBDEVFS_CLEAR_HALT:
      return answer(device.clearHalt(*static_cast<unsigned*>(argument)));
    case USBDEVFS_SUBMITURB:
      return answer(device.submit({static_cast<usbdevfs_urb*>(argument), reinterpret_cast<std::uint64_t>(argument), nullptr}));
    case USBDEVFS_REAPURBNDELAY: {
      Urb urb;
      const int error = device.reap(urb);
      if (error < 0) return answer(error);
      *static_cast<void**>(argument) = urb.urb;
      return 0;
    }
    case USBDEVFS_DISCARDURB:
      return answer(device.discard(reinterpret_cast<std::uint64_t>(argument)));
    default:
      return answer(-ENOTTY);
  }
}

mode_t modeOf(int flags, std::va_list arguments) { return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0; }

}  // namespace

void attachUsbfs(const std::string& node, std::shared_ptr<UsbfsDevice> device) {
  Table& t = table();
  const std::lock_guard lock(t.mutex);
  device ? void(t.nodes[node] = std::move(device)) : void(t.nodes.erase(node));
  t.any = true;
}

void denyUsbfs(bool deny) { table().denied = deny; }

}  // namespace pincer::emulation

using namespace pincer::emulation;

extern "C" {
int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = modeOf(flags, arguments);
  va_end(arguments);
  return openAny("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = modeOf(flags, arguments);
  va_end(arguments);
  return openAny("open64", path, flags, mode);
}
// What a fortified open() really calls: Debian's libusb opens the device's node with it.
int __open_2(const char* path, int flags) { return openAny("open", path, flags, 0); }
int __open64_2(const char* path, int flags) { return openAny("open64", path, flags, 0); }

int ioctl(int fd, unsigned long code, ...) noexcept {
  std::va_list arguments;
  va_start(arguments, code);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (UsbfsDevice* device = deviceAt(fd)) return request(*device, code, argument);
  static const auto real = next<int (*)(int, unsigned long, ...)>("ioctl");
  return real(fd, code, argument);
}

int close(int fd) {
  static const auto real = next<int (*)(int)>("close");
  std::shared_ptr<UsbfsDevice> owner;
  if (deviceAt(fd) != nullptr) {
    Table& t = table();
    const std::lock_guard lock(t.mutex);
    t.fds[static_cast<std::size_t>(fd)] = nullptr;
    owner = t.owners[fd];
    t.owners.erase(fd);
  }
  if (owner) owner->closed();
  return real(fd);
}
}
