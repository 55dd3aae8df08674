// world_sleep: all that outlives a tick beside the state: which tick would repeat the last one, of the world
// (rest.h) and of its islands (island_sleep.h).
//
// It belongs to the scratch and not to the state, for it is no cause: every use compares state and inputs with those
// that it was noted for, bit by bit, and what it spares would have the same bits. Forget it between any two ticks, or
// step another state with it: the results are the same.
#pragma once
#include <vector>

#include "pincer/engine/step.h"
#include "pincer/engine/world/contact.h"

namespace pincer::engine {

// A tick that ended where it started, to the bit, see rest.h.
struct RestMemory {
  WorldState state;  // where
  std::vector<PointInput> points;
  std::vector<MotionInput> motions;
  std::vector<BodyForce> forces;  // one per body, or none
  std::optional<Vec3> gravity_W;
  bool candidate = false;  // `state` is how the last tick ended
  bool holds = false;      // and how it started, with these inputs
};

// A contact of an island that sleeps, as it was in the last tick that was computed.
struct SleepingContact {
  Contact contact;
  ContactMemory memory;
  int place;  // of that in WorldState::contacts
};

struct WorldSleep {
  explicit WorldSleep(const WorldModel& model);

  RestMemory rest;  // all of the world
  // Islands, see island_sleep.h.
  int bodies = 0;                 // that sleep
  int last_group = 0;             // number of the island that fell asleep last
  std::size_t room;               // for contacts of what is awake
  std::vector<char> idle;         // per body: it sleeps, or is static or driven and stands; only where `bodies` isn't 0
  std::vector<int> group;         // per body: which island it sleeps with, 0: none
  std::vector<BodyState> states;  // of those that are idle
  std::vector<BodyForce> forces;  // on those that sleep
  Vec3 gravity_W = Vec3::Zero();
  std::vector<SleepingContact> contacts;  // sorted by id
};

}  // namespace pincer::engine
