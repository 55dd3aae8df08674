// device_emulator: runs an unmodified program that finds emulated arms and displays on its USB ports.
//
//   device_emulator [--arms N] [--displays N] [--falcons N] [--hand] [--unplug
//   SECONDS] [--stop SECONDS] PROGRAM ARGUMENTS...
//
// The same firmware as in the tests, in a process of its own. Falcons take any image of 1,000 bytes. --hand: a
// simulated participant wears them and picks up the sphere.
// --unplug: pulls the first arm out after so many seconds and plugs it in again half a second later.
// --stop: so many seconds after the first force of a motor the program is stopped (SIGSTOP) for half a
// second; says when the motors had no force any more.
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>

#include "pincer/tests/emulation/emulated_hand.h"
#include "pincer/tests/emulation/falcon_gadget.h"
#include "pincer/tests/emulation/remote_port.h"

namespace pincer::emulation {
namespace {

using Time = std::chrono::steady_clock;
constexpr std::size_t kFalconImage = 1000;  // [bytes]
constexpr std::chrono::milliseconds kPeriod(1);
constexpr std::chrono::milliseconds kAway(500);  // unplugged, or stopped

struct Options {
  int arms = 2, displays = 2, falcons = 0;
  bool hand = false;
  double unplug = 0, stop = 0;
  char** program = nullptr;
};

[[noreturn]] void giveUp(const char* what) {
  fmt::print(stderr, "device_emulator: can't set up the {}\n", what);
  std::exit(3);
}

// Where the program finds this emulator.
std::string addressOfThis() { return fmt::format("pincer-emulator-{}", getpid()); }

int listening(const std::string& name) {
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, name.data(), name.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (socket < 0 || bind(socket, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(socket, 16) != 0)
    giveUp("socket");
  return socket;
}

// The ports as sysfs and udev show them.
class ShownPorts {
 public:
  ShownPorts() : testbed_(umockdev_testbed_new()) {}
  ~ShownPorts() { g_object_unref(testbed_); }
  ShownPorts(const ShownPorts&) = delete;
  ShownPorts& operator=(const ShownPorts&) = delete;

  // The node of the device now at the port.
  std::string add(std::size_t port, const std::string& descriptors) {
    const int address = next_address_++;
    const std::string description = fmt::format(
        "P: {}\nN: bus/usb/001/{:03}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM={:03}\nE: "
        "DEVNAME=/dev/bus/usb/001/{:03}\n"
        "E: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum={}\\n\nA: speed=12\\n\n"
        "H: descriptors={}\n",
        pathOf(port), address, address, address, address, descriptors);
    if (umockdev_testbed_add_from_string(testbed_, description.c_str(), nullptr) == 0) giveUp("device");
    return fmt::format("/dev/bus/usb/001/{:03}", address);
  }
  void tell(std::size_t port, const char* what) {
    umockdev_testbed_uevent(testbed_, ("/sys" + pathOf(port)).c_str(), what);
  }
  void remove(std::size_t port) { umockdev_testbed_remove_device(testbed_, ("/sys" + pathOf(port)).c_str()); }

 private:
  static std::string pathOf(std::size_t port) {
    return fmt::format("/devices/pci0000:00/0000:00:14.0/usb1/1-{}", port + 1);
  }
  UMockdevTestbed* testbed_;
  int next_address_ = 2;
};

// One thread does everything that the devices do.
class Emulator {
 public:
  explicit Emulator(const Options& options) : options_(options), listener_(listening(addressOfThis())) {
    for (int i = 0; i < options.arms; ++i) arms_.push_back(std::make_shared<ArmFirmware>(fmt::format("ARM{}", i + 1)));
    for (int i = 0; i < options.displays; ++i)
      displays_.push_back(std::make_shared<DisplayFirmware>(fmt::format("CLD{}", i + 1)));
    for (const auto& arm : arms_) ports_.push_back(std::make_unique<RemotePort>(arm));
    for (const auto& display : displays_) ports_.push_back(std::make_unique<RemotePort>(display));
    for (int i = 0; i < options.falcons; ++i)
      ports_.push_back(
          std::make_unique<RemotePort>(std::make_shared<FalconGadget>(fmt::format("FALCON{}", i + 1), kFalconImage)));
    nodes_.resize(ports_.size());
    for (std::size_t i = 0; i < ports_.size(); ++i) plug(i, false);
    if (options.hand && options.arms == 2 && options.displays == 2)
      hand_ = std::make_unique<EmulatedHand>(arms_, displays_);
  }
  ~Emulator() {
    running_ = false;
    if (thread_.joinable()) thread_.join();
    close(listener_);
  }
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;

  void start(pid_t program) {
    program_ = program;
    thread_ = std::thread([this] { run(); });
  }

 private:
  void run() {
    begun_ = Time::now();
    for (auto due = begun_ + kPeriod; running_;) {
      serveUntil(due);
      if (Time::now() < due) continue;
      due += kPeriod;
      for (const auto& port : ports_) {
        if (port->plugged()) port->catchUp();
      }
      if (hand_) hand_->act();
      if (options_.unplug > 0) unplugWhenDue();
      if (options_.stop > 0) stopWhenDue();
    }
  }
  void serveUntil(Time::time_point due) {
    std::vector<pollfd> fds{{listener_, POLLIN, 0}};
    for (const auto& port : ports_) fds.push_back({port->connection(), POLLIN, 0});  // negative: not looked at
    const auto left =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::max(due - Time::now(), Time::duration(0)));
    const timespec wait{0, static_cast<long>(std::min<std::int64_t>(left.count(), 999'999'999))};
    if (ppoll(fds.data(), fds.size(), &wait, nullptr) <= 0) return;
    if (fds[0].revents != 0) accept();
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (fds[i + 1].revents != 0) ports_[i]->serve();
    }
  }
  void accept() {
    const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) return;
    std::array<char, 128> node{};
    const auto got = recv(connection, node.data(), node.size() - 1, 0);
    const auto found =
        std::find(nodes_.begin(), nodes_.end(), std::string(node.data(), got > 0 ? static_cast<std::size_t>(got) : 0));
    if (found == nodes_.end()) return void(close(connection));
    ports_[static_cast<std::size_t>(found - nodes_.begin())]->opened(connection);
  }
  // `tells`: a program may be listening for plugs.
  void plug(std::size_t i, bool tells) {
    ports_[i]->plug();
    nodes_[i] = shown_.add(i, ports_[i]->descriptors());
    if (tells) shown_.tell(i, "add");
  }
  void unplugWhenDue() {
    const auto when =
        begun_ + std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(options_.unplug));
    if (unplugs_ == 0 && Time::now() >= when) {
      ++unplugs_;
      ports_[0]->unplug();
      shown_.tell(0, "remove");
      shown_.remove(0);
    }
    if (unplugs_ == 1 && Time::now() >= when + kAway) {
      ++unplugs_;
      plug(0, true);
    }
  }
  bool anyForce() const {
    return std::any_of(arms_.begin(), arms_.end(), [](const auto& arm) { return !arm->force().isZero(0); });
  }
  void stopWhenDue() {
    const auto now = Time::now();
    const auto since = [&](Time::time_point t) { return std::chrono::duration<double>(now - t).count(); };
    if (stop_ == Stop::kNoForce && anyForce()) {
      first_force_ = now;
      stop_ = Stop::kForce;
    } else if (stop_ == Stop::kForce && since(first_force_) >= options_.stop && anyForce()) {
      kill(program_, SIGSTOP);
      stopped_ = now;
      stop_ = Stop::kStopped;
    } else if (stop_ == Stop::kStopped && !anyForce()) {
      fmt::print("stopped: every motor without force after {:.2f} ms\n", 1e3 * since(stopped_));
      std::fflush(stdout);
      stop_ = Stop::kLimp;
    } else if (stop_ == Stop::kLimp && now >= stopped_ + kAway) {
      kill(program_, SIGCONT);
      stop_ = Stop::kDone;
    }
  }

  const Options& options_;
  ShownPorts shown_;
  int listener_;
  std::vector<std::shared_ptr<ArmFirmware>> arms_;
  std::vector<std::shared_ptr<DisplayFirmware>> displays_;
  std::vector<std::unique_ptr<RemotePort>> ports_;
  std::vector<std::string> nodes_;
  std::unique_ptr<EmulatedHand> hand_;
  std::atomic<bool> running_{true};
  std::thread thread_;
  pid_t program_ = 0;
  Time::time_point begun_, first_force_, stopped_;
  int unplugs_ = 0;
  enum class Stop : std::uint8_t { kNoForce, kForce, kStopped, kLimp, kDone } stop_ = Stop::kNoForce;
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
    if (name == "--stop") options.stop = value();
    if (name == "--falcons") options.falcons = static_cast<int>(value());
    if (name == "--hand") options.hand = true;
  }
  options.program = argv + i;
  return options;
}

[[noreturn]] void become(char** program, const std::string& address) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  setenv("LD_PRELOAD", ((self.parent_path() / "usbfs_preload.so").string() + ":libumockdev-preload.so.0").c_str(), 1);
  setenv(kUsbfsAddress, address.c_str(), 1);
  execvp(program[0], program);
  _exit(127);
}

int run(int argc, char** argv) {
  const Options options = optionsOf(argc, argv);
  if (options.program[0] == nullptr) {
    fmt::print(stderr,
               "device_emulator [--arms N] [--displays N] [--falcons N] [--hand] [--unplug SECONDS] [--stop SECONDS] "
               "PROGRAM ARGUMENTS...\n");
    return 2;
  }
  // A device doesn't wait for this computer: its thread goes first, if that is permitted.
  const sched_param first{.sched_priority = 82}, usual{.sched_priority = 0};
  sched_setscheduler(0, SCHED_FIFO, &first);
  Emulator emulator(options);
  const std::string address = addressOfThis();
  const pid_t child = fork();
  if (child == 0) {
    sched_setscheduler(0, SCHED_OTHER, &usual);
    become(options.program, address);
  }
  emulator.start(child);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace
}  // namespace pincer::emulation

int main(int argc, char** argv) { return pincer::emulation::run(argc, argv); }
