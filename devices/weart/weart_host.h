// weart_host: WEART's TouchDIVER behind its maker's Middleware: up to three thimbles, each a display of pressure.
//
//   level = min(1, f_n / full_force)      100 times a second, newest only; 0 and stopForce on every way out, on a
//                                         doubt, and 100 ms after the last press()
//
// One thread and one TCP connection of its own; the tick only writes a number. Doubts: the connection is lost,
// the Middleware says that it isn't running. Newtons per level and delay aren't documented by the maker.
// Temperature and texture are never commanded.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "pincer/devices/weart/pressure_display.h"
#include "pincer/devices/weart/weart_messages.h"

namespace pincer::devices::weart {

struct WeartOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 13031;
  HandSide hand = HandSide::kRight;
  std::vector<Thimble> thimbles{Thimble::kIndex, Thimble::kThumb};
  double full_force = 5;  // of level 1 [N], > 0
  double timeout = 2;     // for the Middleware to answer and to run [s]
};

class WeartHost {
 public:
  // Connects, starts the Middleware and waits until it runs. Throws std::runtime_error with a sentence and the remedy.
  explicit WeartHost(const WeartOptions& options);
  ~WeartHost();  // 0, stopForce, StopFromClient
  WeartHost(const WeartHost&) = delete;
  WeartHost& operator=(const WeartHost&) = delete;

  PressureDisplay& display(std::size_t i);
  // Why nothing presses any more, with a remedy; empty: nothing is wrong.
  std::string complaint();

 private:
  class Display;
  void run();
  bool hear(int milliseconds);  // false: the connection is lost
  bool say(std::string_view text);
  bool pressAll(std::int64_t now);
  void doubt(const std::string& why);

  WeartOptions options_;
  int socket_ = -1;
  std::vector<std::unique_ptr<Display>> displays_;
  MessageCutter cutter_;
  bool begun_ = false;  // from then on it never presses again once it stopped
  std::atomic<bool> running_{false}, end_{false};
  std::mutex slow_;
  std::string complaint_;
  std::thread thread_;
};

}  // namespace pincer::devices::weart
