// usbfs_wire: how a program with usbfs_preload and the emulator's process talk about one opened device: a
// SOCK_SEQPACKET connection to the abstract address in PINCER_USBFS. First the program sends the node's path and gets
// an errno, and with 0 the write end of a pipe, which is the device's descriptor for libusb (readiness:
// usbfs_device.h). Then requests go there and completions come back; nobody waits for anything, so that a transfer
// costs no change of process, and a stopped program doesn't stop the device.
#pragma once
#include <cstdint>

namespace pincer::emulation {

constexpr const char* kUsbfsAddress = "PINCER_USBFS";  // environment variable
constexpr int kMostTransferBytes = 512;

enum class UsbfsRequestKind : std::uint32_t { kSubmit, kDiscard, kClearHalt };

struct UsbfsRequest {
  UsbfsRequestKind kind = UsbfsRequestKind::kSubmit;
  std::uint32_t type = 0, endpoint = 0;
  std::int32_t length = 0;
  std::uint64_t key = 0;  // the URB's address in the program
  std::uint8_t data[kMostTransferBytes];
};

struct UsbfsCompletion {
  std::uint64_t key = 0;
  std::int32_t status = 0, length = 0;
  std::uint8_t data[kMostTransferBytes];
};

}  // namespace pincer::emulation
