#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "pincer/devices/emulate/haply_server.h"
#include "pincer/devices/emulate/weart_middleware.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/devices_commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/experiments/haply_wearer.h"
#include "pincer/tasks/run/servo/hand_devices.h"

namespace pincer::tasks {
namespace {

using devices::emulate::DeadMan;
using devices::emulate::HaplyServer;
using devices::emulate::HaplyService;
using devices::emulate::HaplyServiceSettings;

struct EmulateArguments {
  int port = 10001, events_port = 10020, minor = 5;
  bool hand = false;
  double seconds = 0, idle_after = 0.1;
  std::string fault, dead_man = "idle";
};

devices::emulate::HaplyFault faultNamed(const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < devices::emulate::kHaplyFaults; ++i) {
    const auto fault = static_cast<devices::emulate::HaplyFault>(i);
    if (nameOf(fault) == name) return fault;
    known += fmt::format("{}{}", i > 0 ? ", " : "", nameOf(fault));
  }
  refuseUsage(fmt::format("devices emulate: --fault \"{}\" is unknown. They are: {}.", name, known));
}

HaplyServiceSettings settingsOf(const EmulateArguments& arguments) {
  HaplyServiceSettings settings;
  settings.minor = arguments.minor;
  settings.vector = arguments.minor >= 5;
  settings.values = !settings.vector;
  for (auto& arm : settings.arms) {
    arm.dead_man = arguments.dead_man == "keep"    ? DeadMan::kKeepsForEver
                   : arguments.dead_man == "close" ? DeadMan::kZeroOnClose
                                                   : DeadMan::kIdleAfter;
    arm.idle_after = arguments.idle_after;
  }
  return settings;
}

int emulateHaply(const EmulateArguments& arguments) {
  const auto fault = arguments.fault.empty() ? devices::emulate::HaplyFault::kNone : faultNamed(arguments.fault);
  std::optional<HaplyWearer> wearer;
  const auto live = [&wearer](HaplyService& service) {
    if (!wearer) wearer.emplace(service);
    wearer->act(service);
  };
  std::unique_ptr<HaplyServer> server;
  try {
    server = std::make_unique<HaplyServer>(settingsOf(arguments), static_cast<std::uint16_t>(arguments.port),
                                           static_cast<std::uint16_t>(arguments.events_port),
                                           arguments.hand ? std::function<void(HaplyService&)>(live) : nullptr);
  } catch (const std::runtime_error& error) {
    throw DeviceError(error.what());
  }
  server->setFault(fault);
  print("Haply's service, emulated: --service {}   arms 049D, 04BA, grips 1605, 1606. Ctrl-C ends it.\n",
        server->place());
  std::fflush(stdout);
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(arguments.seconds);
  while (!interruptFlag() && (arguments.seconds == 0 || std::chrono::steady_clock::now() < until))
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return kExitOk;
}

// Prints each level that changed, so that a person sees what would be felt.
int emulateWeart(int port, double seconds) {
  std::unique_ptr<devices::emulate::WeartMiddleware> middleware;
  try {
    middleware = std::make_unique<devices::emulate::WeartMiddleware>(static_cast<std::uint16_t>(port));
  } catch (const std::runtime_error& error) {
    throw DeviceError(error.what());
  }
  print("WEART's Middleware, emulated: --pressure 127.0.0.1:{}. Ctrl-C ends it.\n", middleware->port());
  std::fflush(stdout);
  std::array<double, 2> shown{};
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!interruptFlag() && (seconds == 0 || std::chrono::steady_clock::now() < until)) {
    const std::array<double, 2> now{middleware->levelOf("INDEX"), middleware->levelOf("THUMB")};
    if (now != shown) print("index {:.2f}  thumb {:.2f}\n", now[0], now[1]);
    std::fflush(stdout);
    shown = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return kExitOk;
}

void addWeart(CLI::App& emulate, int& exit_code) {
  struct Arguments {
    int port = 13031;
    double seconds = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* weart =
      emulate.add_subcommand("weart", "WEART's Middleware with a TouchDIVER, on this computer; prints what it presses");
  weart->add_option("--port", arguments->port, "0: a free one")->check(CLI::Range(0, 65535))->capture_default_str();
  weart->add_option("--seconds", arguments->seconds, "Ends by itself; 0: never [s]")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  weart->footer("\nExample:\n  pincer devices emulate weart");
  weart->callback([arguments, &exit_code] { exit_code = emulateWeart(arguments->port, arguments->seconds); });
}

}  // namespace

void addDevicesEmulate(CLI::App& devices, int& exit_code) {
  CLI::App* command = devices.add_subcommand("emulate", "Devices that aren't there, for programs that drive them");
  command->require_subcommand(1);
  auto arguments = std::make_shared<EmulateArguments>();
  CLI::App* haply =
      command->add_subcommand("haply", "Haply's service with two Inverse3 and two VerseGrips, on this computer");
  haply->add_option("--port", arguments->port, "Of commands and HTTP; 0: a free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  haply->add_option("--events-port", arguments->events_port, "Of its events; 0: a free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  haply->add_flag("--hand", arguments->hand,
                  "A simulated participant holds both, and picks up the sphere when a session arms");
  haply->add_option("--minor", arguments->minor, "Which service 3.x it is")
      ->check(CLI::Range(1, 9))
      ->capture_default_str();
  haply
      ->add_option("--dead-man", arguments->dead_man,
                   "What becomes of a force when commands end: kept, idle after a time, zero at a closed socket")
      ->check(CLI::IsMember({"keep", "idle", "close"}))
      ->capture_default_str();
  haply->add_option("--idle-after", arguments->idle_after, "That time [s]")
      ->check(CLI::Range(0.001, 60.0))
      ->capture_default_str();
  haply->add_option("--fault", arguments->fault,
                    "Something that goes wrong from the start; an unknown name lists them");
  haply->add_option("--seconds", arguments->seconds, "Ends by itself; 0: never [s]")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  haply->footer("\nExample:\n  pincer devices emulate haply --hand");
  haply->callback([arguments, &exit_code] { exit_code = emulateHaply(*arguments); });
  addWeart(*command, exit_code);
}

}  // namespace pincer::tasks
