// device_emulator: runs an unmodified program that finds emulated arms and displays on its USB ports.
//
//   device_emulator [--arms N] [--displays N] [--hand] [--unplug SECONDS] PROGRAM ARGUMENTS...
//
// The same firmware as in the tests, in a process of its own. --hand: a simulated participant wears them and picks up the sphere.
// --unplug: pulls the first arm out after so many seconds and plugs it in again half a second later.
#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <umockdev.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>

#include "tests/emulation/emulated_hand.h"
#include "tests/emulation/usbfs_device.h"

namespace pincer::emulation {
namespace {

constexpr const char* kDescriptors =
    "120100020000004009120100000101020301"
    "09022000010100C032"
    "0904000002FF000000"
    "07050103400001"
    "07058103400001";

struct Options {
  int arms = 2, displays = 2;
  bool hand = false;
  double unplug = 0;
  char** program = nullptr;
};

// One device: its node in /dev is a FIFO that shows readiness, its ioctls come through umockdev.
struct Port {
  std::shared_ptr<Firmware> firmware;
  std::unique_ptr<UsbfsDevice> device;
  std::mutex mutex;  // of `device` itself, which changes when plugged in again
  std::string path, node;
};

gboolean answer(UMockdevIoctlClient* client, long result) {
  umockdev_ioctl_client_complete(client, result < 0 ? -1 : result, result < 0 ? static_cast<int>(-result) : 0);
  return TRUE;
}

gboolean submit(UsbfsDevice& device, UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
  auto* urb = reinterpret_cast<usbdevfs_urb*>(data->data);
  if (urb->buffer_length > 0) {  // the parent keeps the buffer
    g_object_unref(
        umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_urb, buffer), static_cast<std::size_t>(urb->buffer_length), nullptr));
  }
  const int result = device.submit({urb, data->client_addr, data});
  if (result < 0) g_object_unref(data);
  return answer(client, result);
}

gboolean reap(UsbfsDevice& device, UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  Urb urb;
  const int result = device.reap(urb);
  if (result < 0) return answer(client, result);
  g_autoptr(UMockdevIoctlData) place = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr);
  umockdev_ioctl_data_set_ptr(place, 0, static_cast<UMockdevIoctlData*>(urb.cookie));
  g_object_unref(urb.cookie);
  return answer(client, 0);
}

gboolean handleIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer user) {
  auto& port = *static_cast<Port*>(user);
  const std::lock_guard lock(port.mutex);
  UsbfsDevice& device = *port.device;
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_GET_CAPABILITIES: {
      g_autoptr(UMockdevIoctlData) data = umockdev_ioctl_data_resolve(argument, 0, 4, nullptr);
      const guint32 can =
          USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      std::memcpy(data->data, &can, sizeof can);
      return answer(client, 0);
    }
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_RESET:
      return answer(client, device.gone() ? -ENODEV : 0);
    case USBDEVFS_GETDRIVER:
      return answer(client, -ENODATA);
    case USBDEVFS_CLEAR_HALT: {
      g_autoptr(UMockdevIoctlData) data = umockdev_ioctl_data_resolve(argument, 0, 4, nullptr);
      unsigned endpoint;
      std::memcpy(&endpoint, data->data, sizeof endpoint);
      return answer(client, device.clearHalt(endpoint));
    }
    case USBDEVFS_SUBMITURB:
      return submit(device, client, argument);
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY:
      return reap(device, client, argument);
    case USBDEVFS_DISCARDURB: {
      std::uint64_t key;
      std::memcpy(&key, argument->data, sizeof key);
      return answer(client, device.discard(key));
    }
    default:
      return FALSE;
  }
}

class Emulator {
 public:
  explicit Emulator(const Options& options) : testbed_(umockdev_testbed_new()) {
    for (int i = 0; i < options.arms; ++i) arms_.push_back(std::make_shared<ArmFirmware>(fmt::format("ARM{}", i + 1)));
    for (int i = 0; i < options.displays; ++i) displays_.push_back(std::make_shared<DisplayFirmware>(fmt::format("CLD{}", i + 1)));
    for (const auto& arm : arms_) ports_.push_back(newPort(arm));
    for (const auto& display : displays_) ports_.push_back(newPort(display));
    for (const auto& port : ports_) plug(*port, false);
    if (options.hand && options.arms == 2 && options.displays == 2) hand_ = std::make_unique<EmulatedHand>(arms_, displays_);
  }
  ~Emulator() {
    running_ = false;
    if (thread_.joinable()) thread_.join();
    g_object_unref(testbed_);
  }
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;

  void start() {
    thread_ = std::thread([this] {
      using Time = std::chrono::steady_clock;
      for (auto last = Time::now(), due = last; running_;) {
        due += std::chrono::milliseconds(1);
        std::this_thread::sleep_until(due);
        const auto now = Time::now();
        due = std::max(due, now - std::chrono::milliseconds(5));
        advance(std::chrono::duration<double>(now - last).count());
        last = now;
      }
    });
  }
  void unplug(std::size_t i) {
    Port& port = *ports_[i];
    {
      const std::lock_guard lock(port.mutex);
      port.device->unplug();
    }
    umockdev_testbed_uevent(testbed_, ("/sys" + port.path).c_str(), "remove");
    umockdev_testbed_remove_device(testbed_, ("/sys" + port.path).c_str());
    umockdev_testbed_detach_ioctl(testbed_, port.node.c_str(), nullptr);
  }
  void plugAgain(std::size_t i) { plug(*ports_[i], true); }

 private:
  std::unique_ptr<Port> newPort(std::shared_ptr<Firmware> firmware) {
    auto port = std::make_unique<Port>();
    port->firmware = std::move(firmware);
    port->path = fmt::format("/devices/pci0000:00/0000:00:14.0/usb1/1-{}", ports_.size() + 1);
    return port;
  }
  // `tells`: somebody is listening for plugs.
  void plug(Port& port, bool tells) {
    const int address = next_address_++;
    port.node = fmt::format("/dev/bus/usb/001/{:03}", address);
    {
      const std::lock_guard lock(port.mutex);
      port.firmware->powerUp();
      port.device = std::make_unique<UsbfsDevice>(port.firmware);
    }
    UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
    g_signal_connect(handler, "handle-ioctl", G_CALLBACK(handleIoctl), &port);
    require(umockdev_testbed_attach_ioctl(testbed_, port.node.c_str(), handler, nullptr) != 0, "attach");
    const std::string description = fmt::format(
        "P: {}\nN: bus/usb/001/{:03}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM={:03}\nE: DEVNAME=/dev/bus/usb/001/{:03}\n"
        "E: DEVTYPE=usb_device\nE: PRODUCT=1209/1/100\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum={}\\n\nA: speed=12\\n\n"
        "H: descriptors={}\n",
        port.path, address, address, address, address, kDescriptors);
    require(umockdev_testbed_add_from_string(testbed_, description.c_str(), nullptr) != 0, "device");
    makeFifo(port);
    if (tells) umockdev_testbed_uevent(testbed_, ("/sys" + port.path).c_str(), "add");
  }
  void makeFifo(Port& port) {
    g_autofree char* root = umockdev_testbed_get_root_dir(testbed_);
    const std::string node = root + port.node;
    unlink(node.c_str());
    require(mkfifo(node.c_str(), 0666) == 0, "FIFO");
    const int fd = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    require(fd >= 0, "FIFO");
    fcntl(fd, F_SETPIPE_SZ, 4096);
    const std::lock_guard lock(port.mutex);
    port.device->opened(fd, fd);
  }
  static void require(bool ok, const char* what) {
    if (ok) return;
    fmt::print(stderr, "device_emulator: can't set up the {}\n", what);
    std::exit(3);
  }
  void advance(double dt) {
    for (const auto& port : ports_) {
      const std::lock_guard lock(port->mutex);
      if (!port->device->gone()) port->device->advance(dt);
    }
    if (hand_) act();
  }
  void act() {
    const std::scoped_lock lock(ports_[0]->mutex, ports_[1]->mutex, ports_[2]->mutex, ports_[3]->mutex);
    hand_->act();
  }

  UMockdevTestbed* testbed_;
  std::vector<std::shared_ptr<ArmFirmware>> arms_;
  std::vector<std::shared_ptr<DisplayFirmware>> displays_;
  std::vector<std::unique_ptr<Port>> ports_;
  std::unique_ptr<EmulatedHand> hand_;
  std::atomic<bool> running_{true};
  std::thread thread_;
  int next_address_ = 2;
};

Options optionsOf(int argc, char** argv) {
  Options options;
  int i = 1;
  for (; i < argc && argv[i][0] == '-'; ++i) {
    const std::string name = argv[i];
    const auto value = [&] { return i + 1 < argc ? std::atof(argv[++i]) : 0.0; };
    if (name == "--arms") options.arms = static_cast<int>(value());
    if (name == "--displays") options.displays = static_cast<int>(value());
    if (name == "--unplug") options.unplug = value();
    if (name == "--hand") options.hand = true;
  }
  options.program = argv + i;
  return options;
}

int run(int argc, char** argv) {
  const Options options = optionsOf(argc, argv);
  if (options.program[0] == nullptr) {
    fmt::print(stderr, "device_emulator [--arms N] [--displays N] [--hand] [--unplug SECONDS] PROGRAM ARGUMENTS...\n");
    return 2;
  }
  // A device doesn't wait for this computer: its threads go first, if that is permitted.
  const sched_param first{.sched_priority = 82}, usual{.sched_priority = 0};
  sched_setscheduler(0, SCHED_FIFO, &first);
  Emulator emulator(options);
  const pid_t child = fork();
  if (child == 0) {
    sched_setscheduler(0, SCHED_OTHER, &usual);
    setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
    execvp(options.program[0], options.program);
    _exit(127);
  }
  emulator.start();
  std::thread plugs;
  if (options.unplug > 0) {
    plugs = std::thread([&] {
      std::this_thread::sleep_for(std::chrono::duration<double>(options.unplug));
      emulator.unplug(0);
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      emulator.plugAgain(0);
    });
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (plugs.joinable()) plugs.join();
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace
}  // namespace pincer::emulation

int main(int argc, char** argv) { return pincer::emulation::run(argc, argv); }
