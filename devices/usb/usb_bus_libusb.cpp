#include <fcntl.h>
#include <libusb.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "pincer/devices/hurry.h"
#include "pincer/devices/usb/port_name.h"
#include "pincer/devices/usb/usb_bus.h"
#include "pincer/devices/usb/usb_endpoints.h"

namespace pincer::devices::usb {
namespace {

// Transfers that wait for the device at any time: the kernel fills them while this program gets no processor, so that
// it loses no frame in a pause of 64 ms of an arm that states its place 1,000 times a second.
constexpr int kInFlight = 64;
constexpr int kFailuresInARow = 8;  // after which a port is given up
constexpr int kWaitMs = 20;         // between looks at what is due, with nothing going on

struct Transfer {
  libusb_transfer* transfer = nullptr;
  std::array<std::uint8_t, 2 * kFrameSize> buffer{};  // longer than a frame, so that a too long packet is seen as one
  bool flying = false;
  struct PortState* port = nullptr;
};

struct PortState {
  libusb_device* device = nullptr;  // null: free
  libusb_device_handle* handle = nullptr;
  Endpoints endpoints;
  std::array<Transfer, kInFlight> in;
  Transfer out;
  FrameBytes packet{};  // being sent
  // Transfers that came back, in the order of their coming, which is that of the frames.
  std::array<Transfer*, kInFlight + 1> done{};
  std::size_t done_count = 0;
  int flying = 0;
  int failures = 0;
  bool closing = false, told_closed = false;
};

void LIBUSB_CALL markDone(libusb_transfer* transfer) {
  auto& t = *static_cast<Transfer*>(transfer->user_data);
  t.port->done[t.port->done_count++] = &t;
}

std::string placeOf(libusb_device* device) { return "USB device " + portName(device); }

std::string openProblem(libusb_device* device, int error) {
  if (error == LIBUSB_ERROR_ACCESS) {
    return placeOf(device) +
           ": no permission to open it. Install the udev rule (docs/devices/setup.md) and join its group: sudo usermod "
           "-aG plugdev $USER; "
           "then "
           "log in "
           "again and replug the device. No need to be root.";
  }
  if (error == LIBUSB_ERROR_BUSY) return placeOf(device) + ": another program uses it. Close that program.";
  return placeOf(device) + ": it can't be opened (" + libusb_error_name(error) + "). Unplug it and plug it in again.";
}

}  // namespace

std::string portName(libusb_device* device) {
  std::array<std::uint8_t, 7> ports{};  // the most that USB allows
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string text = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < depth; ++i) text += (i == 0 ? "-" : ".") + std::to_string(ports[static_cast<std::size_t>(i)]);
  return text;
}

std::int64_t monotonicNs() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

namespace {

class LibusbBus final : public UsbBus {
 public:
  LibusbBus(UsbPorts& ports, Clock clock) : ports_(ports), clock_(std::move(clock)) {
    for (auto* some : {&arrived_, &left_}) some->reserve(kMostPlugs);
    fds_.reserve(kMostFds);
    wake_fd_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_fd_ < 0) throw std::runtime_error("USB: no more file descriptors. Close other programs.");
    if (const int error = libusb_init(&context_); error != 0) {
      ::close(wake_fd_);
      throw std::runtime_error(std::string("USB: libusb can't start (") + libusb_error_name(error) + ").");
    }
    thread_ = std::thread([this] { run(); });
  }
  ~LibusbBus() override {
    stop_ = true;
    wake();
    thread_.join();
    libusb_exit(context_);
    ::close(wake_fd_);
  }
  LibusbBus(const LibusbBus&) = delete;
  LibusbBus& operator=(const LibusbBus&) = delete;

  void wake() noexcept override {
    const std::uint64_t one = 1;
    // it can only be full, and then it wakes anyway
    [[maybe_unused]] const auto written = ::write(wake_fd_, &one, sizeof one);
  }

 private:
  // between two looks; of libusb. A bus has at most 127 devices
  static constexpr std::size_t kMostPlugs = 256, kMostFds = 256;

  void run() noexcept {  // where memory ends, it is as if all devices were unplugged: motors go limp by themselves
    for (const auto part : {&LibusbBus::serveAll, &LibusbBus::closeAll}) {
      try {
        (this->*part)();
      } catch (const std::exception&) {
      }
    }
  }

  void serveAll() {
    // Just below the servo's priority, where the system permits it: a command that
    // waits for this thread waits for nothing else.
    hurryThisThread(kUsbPriority);
    const bool told = watchPlugs();
    if (!told) lookForDevices();
    handleEvents();
    openArrived();
    ports_.searched();
    while (!stop_) {
      wait();
      handleEvents();
      if (!told) lookForDevices();
      closeLeft();
      openArrived();
      for (int i = 0; i < kMaxPorts; ++i) serve(i);
    }
  }

  // True if the system tells of plugs.
  bool watchPlugs() {
    if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) return false;
    const auto events =
        static_cast<libusb_hotplug_event>(LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT);
    return libusb_hotplug_register_callback(context_, events, LIBUSB_HOTPLUG_ENUMERATE, kVendorId, kProductId,
                                            LIBUSB_HOTPLUG_MATCH_ANY, &LibusbBus::plugged, this, nullptr) == 0;
  }
  static int LIBUSB_CALL plugged(libusb_context*, libusb_device* device, libusb_hotplug_event event, void* self) {
    auto& bus = *static_cast<LibusbBus*>(self);
    auto& some = event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED ? bus.arrived_ : bus.left_;
    // nothing may be thrown through libusb, which is C
    if (some.size() < kMostPlugs) some.push_back(libusb_ref_device(device));
    return 0;
  }
  // Where the system doesn't: once a second.
  void lookForDevices() {
    const std::int64_t now = monotonicNs();
    if (now < next_look_) return;
    next_look_ = now + 1'000'000'000;
    libusb_device** list = nullptr;
    const auto count = libusb_get_device_list(context_, &list);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      libusb_device_descriptor d;
      if (libusb_get_device_descriptor(list[i], &d) != 0 || d.idVendor != kVendorId || d.idProduct != kProductId ||
          portOf(list[i]))
        continue;
      arrived_.push_back(libusb_ref_device(list[i]));
    }
    if (count >= 0) libusb_free_device_list(list, 1);
  }

  void wait() {
    fds_.clear();
    fds_.push_back({wake_fd_, POLLIN, 0});
    if (const libusb_pollfd** list = libusb_get_pollfds(context_)) {
      for (const libusb_pollfd** fd = list; *fd != nullptr && fds_.size() < kMostFds; ++fd)
        fds_.push_back({(*fd)->fd, (*fd)->events, 0});
      libusb_free_pollfds(list);
    }
    ::poll(fds_.data(), fds_.size(), kWaitMs);
    std::uint64_t count = 0;
    [[maybe_unused]] const auto read = ::read(wake_fd_, &count, sizeof count);
  }

  void handleEvents() {
    timeval none{0, 0};
    libusb_handle_events_timeout_completed(context_, &none, nullptr);
  }

  PortState* portOf(libusb_device* device) {
    for (PortState& p : states_) {
      if (p.device == device) return &p;
    }
    return nullptr;
  }

  void openArrived() {
    while (!arrived_.empty()) {
      libusb_device* device = arrived_.front();
      arrived_.erase(arrived_.begin());
      open(device);
      libusb_unref_device(device);
    }
  }

  void open(libusb_device* device) {
    const auto free =
        std::find_if(states_.begin(), states_.end(), [](const PortState& p) { return p.device == nullptr; });
    if (free == states_.end())
      return ports_.problem("More than 16 USB devices are plugged in; unplug those that aren't needed.");
    PortState& p = *free;
    if (portOf(device) != nullptr) return;
    libusb_device_handle* handle = nullptr;
    int error = libusb_open(device, &handle);
    if (error != 0) return ports_.problem(openProblem(device, error));
    p.endpoints = endpointsOf(device);
    if (p.endpoints.in == 0 || p.endpoints.out == 0) {
      libusb_close(handle);
      return ports_.problem(placeOf(device) +
                            ": it lacks a 64-byte endpoint in each direction (docs/usb-protocol.md).");
    }
    error = libusb_claim_interface(handle, 0);
    if (error != 0) {
      libusb_close(handle);
      return ports_.problem(openProblem(device, error));
    }
    p.device = libusb_ref_device(device);
    p.handle = handle;
    p.failures = 0;
    p.closing = false;
    start(p);
    ports_.opened(static_cast<int>(free - states_.begin()), clock_());
  }

  void start(PortState& p) {
    for (Transfer& t : p.in) {
      t.port = &p;
      t.transfer = libusb_alloc_transfer(0);
      if (t.transfer == nullptr) return void(p.closing = true);
      libusb_fill_interrupt_transfer(t.transfer, p.handle, p.endpoints.in, t.buffer.data(),
                                     static_cast<int>(t.buffer.size()), markDone, &t, 0);
      t.transfer->type = p.endpoints.in_type;
      submit(p, t);
    }
    p.out.port = &p;
    p.out.transfer = libusb_alloc_transfer(0);
    if (p.out.transfer == nullptr) return void(p.closing = true);
    libusb_fill_interrupt_transfer(p.out.transfer, p.handle, p.endpoints.out, p.packet.data(), kFrameSize, markDone,
                                   &p.out, 0);
    p.out.transfer->type = p.endpoints.out_type;
  }

  void submit(PortState& p, Transfer& t) {
    t.flying = libusb_submit_transfer(t.transfer) == 0;
    p.flying += t.flying ? 1 : 0;
    if (!t.flying && ++p.failures >= kFailuresInARow) p.closing = true;
  }

  void serve(int port) {
    PortState& p = states_[static_cast<std::size_t>(port)];
    if (p.device == nullptr) return;
    takeDone(port, p);
    if (!p.closing) {
      for (Transfer& t : p.in) {
        if (!t.flying && !p.closing) submit(p, t);
      }
      if (!p.out.flying && !p.closing && ports_.toSend(port, p.packet, clock_())) submit(p, p.out);
    }
    if (p.closing) close(port, p);
  }

  void takeDone(int port, PortState& p) {
    bool in_failed = false, out_failed = false;
    for (std::size_t i = 0; i < p.done_count; ++i) {
      Transfer& t = *p.done[i];
      t.flying = false;
      --p.flying;
      if (!finished(p, *t.transfer, &t == &p.out ? out_failed : in_failed) || &t == &p.out || p.told_closed) continue;
      ports_.received(port, std::span(t.buffer).first(static_cast<std::size_t>(std::max(0, t.transfer->actual_length))),
                      clock_());
    }
    p.done_count = 0;
  }

  // True if the transfer brought its packet. A stalled endpoint is cleared; whatever fails too
  // often in a row closes the port. Those that wait behind one that stalls come back with it: that
  // is one failure; `failed`: it has been seen.
  bool finished(PortState& p, libusb_transfer& transfer, bool& failed) {
    switch (transfer.status) {
      case LIBUSB_TRANSFER_COMPLETED:
        p.failures = 0;
        return true;
      case LIBUSB_TRANSFER_NO_DEVICE:
        p.closing = true;
        return false;
      default:
        if (std::exchange(failed, true)) return false;
        if (transfer.status == LIBUSB_TRANSFER_STALL &&
            libusb_clear_halt(p.handle, transfer.endpoint) == LIBUSB_ERROR_NO_DEVICE)
          p.closing = true;
        if (++p.failures >= kFailuresInARow) p.closing = true;
        return false;
    }
  }

  void closeLeft() {
    for (libusb_device* device : left_) {
      if (PortState* p = portOf(device)) p->closing = true;
      std::erase_if(arrived_, [&](libusb_device* d) {  // it left before it was opened
        if (d == device) libusb_unref_device(d);
        return d == device;
      });
      libusb_unref_device(device);
    }
    left_.clear();
  }

  // Once every transfer has come back.
  void close(int port, PortState& p) {
    if (!p.told_closed) ports_.closed(port, clock_());
    p.told_closed = true;
    takeDone(port, p);
    const auto recall = [](Transfer& t) {
      if (t.flying) libusb_cancel_transfer(t.transfer);
    };
    for (Transfer& t : p.in) recall(t);
    recall(p.out);
    if (p.flying > 0) return;
    for (Transfer& t : p.in) libusb_free_transfer(t.transfer), t = Transfer{};
    libusb_free_transfer(p.out.transfer), p.out = Transfer{};
    libusb_release_interface(p.handle, 0);
    libusb_close(p.handle);
    libusb_unref_device(p.device);
    p.device = nullptr;
    p.told_closed = false;
  }

  void closeAll() {
    for (int round = 0; round < 200; ++round) {  // transfers come back at once, or their kernel driver is broken
      bool open = false;
      for (int i = 0; i < kMaxPorts; ++i) {
        PortState& p = states_[static_cast<std::size_t>(i)];
        if (p.device == nullptr) continue;
        p.closing = true;
        close(i, p);
        open = open || p.device != nullptr;
      }
      if (!open) break;
      wait();
      handleEvents();
    }
    for (libusb_device* device : arrived_) libusb_unref_device(device);
    for (libusb_device* device : left_) libusb_unref_device(device);
  }

  UsbPorts& ports_;
  Clock clock_;
  libusb_context* context_ = nullptr;
  int wake_fd_ = -1;
  std::atomic<bool> stop_{false};
  std::vector<libusb_device*> arrived_, left_;
  std::vector<pollfd> fds_;
  std::array<PortState, kMaxPorts> states_;
  std::int64_t next_look_ = 0;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<UsbBus> openUsbBus(UsbPorts& ports, Clock clock) {
  return std::make_unique<LibusbBus>(ports, std::move(clock));
}

}  // namespace pincer::devices::usb
