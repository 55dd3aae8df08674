// usbfs_device: one plugged-in USB device as Linux shows it to libusb: URBs submitted, reaped and discarded, a
// descriptor to poll, and the faults that a cable and a device can have, each at a chosen transfer.
//
// Readiness for poll: libusb is given the write end of a pipe as the device's descriptor. Full: nothing to reap;
// drained: writable, so something can be reaped; read end closed: POLLERR, so unplugged.
#pragma once
#include <linux/usbdevice_fs.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "pincer/tests/emulation/usb_gadget.h"

namespace pincer::emulation {

enum class TransferFault : std::uint8_t {
  kNone,
  kStall,          // the endpoint halts until it is cleared
  kShort,          // 40 of the 64 bytes
  kEmpty,          // no bytes at all
  kGarbled,        // one bit flipped
  kDuplicate,      // the same packet once more
  kLate,           // after its successor
  kLost,           // never
  kProtocolError,  // EPROTO: noise on the wire
  kOverflow,       // more bytes than a packet has
  kWrongMagic,     // the rest sound, checksum right
  kWrongVersion,
  kWrongType,
  kBadValue,  // a value out of range
  kSubmitFails,
};
constexpr int kTransferFaults = 14;  // but kNone
const char* nameOf(TransferFault fault);

// A URB and what its owner needs to give it back.
struct Urb {
  usbdevfs_urb* urb = nullptr;
  std::uint64_t key = 0;  // address in the client
  void* cookie = nullptr;
};

class UsbfsDevice {
 public:
  explicit UsbfsDevice(std::shared_ptr<UsbGadget> gadget) : gadget_(std::move(gadget)) {}
  ~UsbfsDevice();
  UsbfsDevice(const UsbfsDevice&) = delete;
  UsbfsDevice& operator=(const UsbfsDevice&) = delete;

  // The client's side. Answers are 0 or a negative errno.
  int open(int& fd);
  void opened(int read_fd, int write_fd);  // with a descriptor made elsewhere
  void closed();
  int submit(Urb urb);
  int reap(Urb& urb);
  int discard(std::uint64_t key);
  int clearHalt(unsigned endpoint);
  bool gone() const;

  // The cable's side.
  void advance(double dt);
  // As the wall clock goes, in steps of a millisecond, until advance(); whoever submits a transfer finds the device up
  // to date, however late the thread is that moves it.
  void catchUp();
  void unplug();
  // The `index`-th transfer from now (0: the next) to the host (`in`) or from it suffers `fault`.
  void injectAt(std::int64_t index, bool in, TransferFault fault);
  std::int64_t faultsDone() const;
  std::int64_t transfers() const;
  // Does something with the gadget while nothing else runs in it.
  template <typename F>
  auto with(F&& f) {
    const std::lock_guard lock(mutex_);
    return f();
  }

 private:
  struct HeldPacket {
    Packet bytes{};
    std::size_t size = 0;
  };

  void keepTime();
  void pump();
  bool completeIn(Urb urb);
  bool alterIn(HeldPacket& packet, usbdevfs_urb& urb, TransferFault fault);
  int takeOut(Urb urb);
  void control(usbdevfs_urb& urb);
  void finish(Urb urb);
  void show();  // readiness
  TransferFault faultAt(bool in);

  mutable std::mutex mutex_;
  std::shared_ptr<UsbGadget> gadget_;
  std::deque<Urb> waiting_;  // for packets from the device
  std::deque<Urb> done_;
  std::deque<HeldPacket> held_;
  std::set<unsigned> halted_;
  std::map<std::int64_t, TransferFault> in_faults_, out_faults_;
  std::int64_t in_count_ = 0, out_count_ = 0, faults_done_ = 0;
  int read_fd_ = -1, write_fd_ = -1;
  std::optional<std::chrono::steady_clock::time_point> time_;  // that the device has reached; absent: the caller's time
  bool raised_ = true, gone_ = false, has_late_ = false;
  HeldPacket late_;
};

}  // namespace pincer::emulation
