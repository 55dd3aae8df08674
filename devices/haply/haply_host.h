// haply_host: one connection to Haply's service with one or two arms on it, and the
// thread that alone reads and writes its texts.
//
// The thread sends both arms' newest forces every half millisecond, zeros at once; it reconnects, after 0.25 to 2 s,
// while no arm is armed. Its end is 0.1 s of answered zeros and a close frame. The service has no deadline of its
// own that is documented: a program that is stopped as a whole may leave the last force on; keep a hand at the
// device's power switch (docs/devices/haply.md).
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "pincer/devices/haply/haply_arm.h"
#include "pincer/devices/haply/haply_port.h"

namespace pincer::devices::haply {

struct HaplyHostOptions {
  ServicePlace service;
  std::vector<HaplyArmSettings> arms;
  std::optional<double> gate_gain = {};  // sets the service's force gate; absent: as it is
  double timeout = 2;                    // of a connection's parts [s]
};

// The reason why the program at the port can't be used as Haply's service, as a sentence; its version where it can.
struct ServiceCheck {
  std::string problem;
  ServiceVersion version;
};
ServiceCheck checkService(const ServicePlace& place, double timeout);

class HaplyHost {
 public:
  // Checks the service and connects. Throws std::runtime_error with a sentence and the remedy.
  explicit HaplyHost(HaplyHostOptions options, const OpenHaplyPort& open = openHaplyPort);
  ~HaplyHost();
  HaplyHost(const HaplyHost&) = delete;
  HaplyHost& operator=(const HaplyHost&) = delete;

  // Until all arms are ready. Throws std::runtime_error with the session's complaint, or after `timeout` [s].
  void waitReady(double timeout);
  HaplyArm& arm(std::size_t index) { return *arms_[index]; }
  std::size_t arms() const { return arms_.size(); }
  void setEpoch(std::int64_t ns);
  // The last complaint of the service or about it, even if the operator armed since; empty: none.
  std::string complaint();
  const ServiceVersion& version() const { return version_; }
  // Of this connection and those before it.
  SessionCounts counts();
  const RoundTrips& roundTrips() const { return trips_; }

 private:
  class Life;  // one connection's

  void run(std::unique_ptr<HaplyPort> port);
  void live(HaplyPort& port);
  std::unique_ptr<HaplyPort> reconnect();
  SessionOptions sessionOptions();
  void wake() const noexcept;
  void tell(const HaplySession& session, bool open);
  void note(const std::string& complaint);
  void sleepUntilWoken(std::int64_t until);
  bool anyArmed() const;
  void leave(HaplyPort& port, HaplySession& session, Life& life);

  HaplyHostOptions options_;
  OpenHaplyPort open_;
  ServiceVersion version_;
  std::vector<std::unique_ptr<HaplyArm>> arms_;
  int wake_fd_;
  std::atomic<bool> end_{false};
  std::mutex slow_;  // of the next two
  std::string complaint_;
  SessionCounts counts_;
  RoundTrips trips_{};
  std::thread thread_;
};

}  // namespace pincer::devices::haply
