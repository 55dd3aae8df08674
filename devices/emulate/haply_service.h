// haply_service: Haply's service that isn't there (docs/devices/haply.md), without socket or
// thread: texts in, texts out, time from outside.
//
// Any number of sessions at once; of two that command one device, the later
// counts. What its pages leave open is a setting.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/devices/emulate/haply_faults.h"
#include "pincer/devices/emulate/haply_plant.h"

namespace pincer::devices::emulate {

struct HaplyServiceSettings {
  std::vector<HaplyPlantSettings> arms{{}, {.id = "04BA", .grip = "1606"}};
  int minor = 5;  // it is 3.minor: from 4 on it has events, from 5 on numbers of sessions and whole settings
  bool vector = true, values = false;  // spellings of a force that it takes
  bool one_message_old = true;         // its states
  double force_scale = 1;
  std::string preset = "defaults";  // of its devices, and their damping, before somebody configures them
  double damping = 0;
  double gate_gain = 0.3;  // of their force gate
  double gate_neutral =
      0.3;  // the gain that lets every force through; lower ones let gain / neutral of a force through that oscillates
  bool takes_configuration = true;  // of a session's first message
  bool tells_force = true;          // that it applies
  bool tells_others = true;         // of a device that one session commands, the other sessions
  bool wired_grips = false;         // on a cable: `button` and `hall`, no battery
};

class HaplyService {
 public:
  explicit HaplyService(const HaplyServiceSettings& settings = {});
  ~HaplyService();
  HaplyService(const HaplyService&) = delete;
  HaplyService& operator=(const HaplyService&) = delete;

  // A session begins; its number, and the inventory that it is sent.
  int connected(std::string& inventory);
  void disconnected(int session);
  // Answers of one message: one, but with a fault none or two. A message that isn't JSON has none.
  std::vector<std::string> answer(int session, std::string_view message);
  std::vector<std::string> takeEvents();
  // The body that GET has; empty: 404.
  std::string get(std::string_view target) const;
  void advance(double dt);

  HaplyPlant& plant(std::size_t arm) { return *plants_[arm]; }
  std::size_t arms() const { return plants_.size(); }
  void setFault(HaplyFault fault);
  HaplyFault fault() const { return fault_; }
  std::int64_t messages() const { return messages_; }
  const HaplyServiceSettings& settings() const { return settings_; }

 private:
  struct Texts;  // its grammar
  struct Session {
    bool commanded = false;
    std::string last;  // state, as it was at the last message
  };

  HaplyServiceSettings settings_;
  std::vector<std::unique_ptr<HaplyPlant>> plants_;
  std::map<int, Session> sessions_;
  std::vector<std::string> events_;
  std::vector<Vec3> frozen_H_;
  HaplyFault fault_ = HaplyFault::kNone;
  int last_session_ = 0;
  std::int64_t messages_ = 0;
};

}  // namespace pincer::devices::emulate
