// usbfs_symbols: open, ioctl and close as an unmodified libusb calls them, answered here for /dev/bus/usb and passed on
// for all else. Included by one source of a binary, which defines before, in pincer::emulation:
//
//   bool answersUsbfs()                  whether any node is answered
//   int openUsbfs(const char* node)      a descriptor, or a negative errno
//   Port* usbfsAt(int fd)                null: not one of ours. Port has gone, submit, reap,
//                                        discard and clearHalt as UsbfsDevice has them
//   void closeUsbfs(int fd)              the descriptor is about to be closed
#pragma once
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstring>

namespace pincer::emulation {
namespace {

template <typename F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

int answer(int result) {
  if (result >= 0) return result;
  errno = -result;
  return -1;
}

int openAny(const char* name, const char* path, int flags, mode_t mode) {
  if (answersUsbfs() && std::strncmp(path, "/dev/bus/usb/", 13) == 0) return answer(openUsbfs(path));
  return next<int (*)(const char*, int, ...)>(name)(path, flags, mode);
}

template <typename Port>
int request(Port& port, unsigned long code, void* argument) {
  switch (code) {
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<std::uint32_t*>(argument) = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
                                               USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      return 0;
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_RESET:
      return port.gone() ? -ENODEV : 0;
    case USBDEVFS_GETDRIVER:
    case USBDEVFS_IOCTL:  // to take its driver away, or give it one: it has none
      return -ENODATA;
    case USBDEVFS_CLEAR_HALT:
      return port.clearHalt(*static_cast<unsigned*>(argument));
    case USBDEVFS_SUBMITURB:
      return port.submit({static_cast<usbdevfs_urb*>(argument), reinterpret_cast<std::uint64_t>(argument), nullptr});
    case USBDEVFS_REAPURBNDELAY: {
      Urb urb;
      const int error = port.reap(urb);
      if (error == 0) *static_cast<void**>(argument) = urb.urb;
      return error;
    }
    case USBDEVFS_DISCARDURB:
      return port.discard(reinterpret_cast<std::uint64_t>(argument));
    default:
      return -ENOTTY;
  }
}

mode_t modeOf(int flags, std::va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace
}  // namespace pincer::emulation

extern "C" {
int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = pincer::emulation::modeOf(flags, arguments);
  va_end(arguments);
  return pincer::emulation::openAny("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = pincer::emulation::modeOf(flags, arguments);
  va_end(arguments);
  return pincer::emulation::openAny("open64", path, flags, mode);
}
// The function that a fortified open() really calls: Debian's libusb opens the device's node with it.
int __open_2(const char* path, int flags) { return pincer::emulation::openAny("open", path, flags, 0); }
int __open64_2(const char* path, int flags) { return pincer::emulation::openAny("open64", path, flags, 0); }

int ioctl(int fd, unsigned long code, ...) noexcept {
  std::va_list arguments;
  va_start(arguments, code);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (auto* port = pincer::emulation::usbfsAt(fd))
    return pincer::emulation::answer(pincer::emulation::request(*port, code, argument));
  static const auto real = pincer::emulation::next<int (*)(int, unsigned long, ...)>("ioctl");
  return real(fd, code, argument);
}

int close(int fd) {
  static const auto real = pincer::emulation::next<int (*)(int)>("close");
  if (pincer::emulation::usbfsAt(fd) != nullptr) pincer::emulation::closeUsbfs(fd);
  return real(fd);
}
}
