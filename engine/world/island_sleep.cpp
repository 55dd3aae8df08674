#include "pincer/engine/world/island_sleep.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/rest.h"

namespace pincer::engine {
namespace {

template <class F>
void forBodiesOf(const Contact& c, F f) {
  for (const Side& side : {c.a, c.b}) {
    if (side.kind == SideKind::kBody) f(static_cast<std::size_t>(side.index));
  }
}

bool isStill(const WorldScratch& scratch, const Island& island) {
  if (!island.result.converged) return false;
  const int* const order = scratch.islands.order.data() + island.place;
  return std::all_of(order, order + island.contacts,
                     [&](int i) { return scratch.contacts[static_cast<std::size_t>(i)].still; });
}

void putToSleep(const WorldModel& model, const WorldState& state, const Island& island, WorldScratch& scratch) {
  WorldSleep& sleep = scratch.sleep;
  ++sleep.last_group;
  for (int n = 0; n < island.contacts; ++n) {
    const int i = scratch.islands.order[static_cast<std::size_t>(island.place + n)];
    forBodiesOf(scratch.contacts[static_cast<std::size_t>(i)], [&](std::size_t body) {
      if (!model.bodies[body].dynamic || sleep.idle[body]) return;
      sleep.idle[body] = true;
      sleep.group[body] = sleep.last_group;
      sleep.states[body] = state.bodies[body];
      sleep.forces[body] = scratch.forces.empty() ? BodyForce{} : scratch.forces[body];
      ++sleep.bodies;
    });
  }
}

bool isAsleep(const WorldSleep& sleep, const Contact& c) {
  bool asleep = false;
  forBodiesOf(c, [&](std::size_t body) { asleep = asleep || sleep.group[body] > 0; });
  return asleep;
}

// Contacts of those that fell asleep are put aside, with what they remember.
void putContactsAside(const WorldState& state, WorldScratch& scratch) {
  WorldSleep& sleep = scratch.sleep;
  for (const Contact& c : scratch.contacts) {
    if (isAsleep(sleep, c)) sleep.contacts.push_back({c, {}, 0});
  }
  std::erase_if(scratch.contacts, [&](const Contact& c) { return isAsleep(sleep, c); });
  scratch.last.is_solved = false;
  std::sort(sleep.contacts.begin(), sleep.contacts.end(),
            [](const SleepingContact& x, const SleepingContact& y) { return x.contact.id < y.contact.id; });
  sleep.room = scratch.contacts.capacity() - sleep.contacts.size();
  int place = 0;
  for (SleepingContact& c : sleep.contacts) {
    while (state.contacts[static_cast<std::size_t>(place)].id != c.contact.id) ++place;
    PINCER_ASSERT(place < state.contact_count);  // what sleeps was remembered
    c.place = place;
    c.memory = state.contacts[static_cast<std::size_t>(place)];
  }
}

// A body that doesn't move by contacts is idle while it stands.
void noteStanding(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  scratch.sleep.gravity_W = scratch.gravity_W;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (model.bodies[i].dynamic) continue;
    scratch.sleep.idle[i] = scratch.bodies[i].still;
    scratch.sleep.states[i] = state.bodies[i];
  }
}

// True if the driven body is where its input leads it, and stays there.
bool stands(const WorldModel& model, std::size_t body, const WorldState& state, const StepInputs& inputs) {
  const BodyState& s = state.bodies[body];
  const auto motion = static_cast<std::size_t>(model.bodies[body].motion);
  if (!s.v_W.isZero(0) || !state.driven_w_W[motion].isZero(0)) return false;
  return motion >= inputs.motions.size() || same(inputs.motions[motion], MotionInput{s.X_WI, {}});
}

bool sameMemories(const WorldState& state, const WorldSleep& sleep) {
  return std::all_of(sleep.contacts.begin(), sleep.contacts.end(), [&](const SleepingContact& c) {
    return c.place < state.contact_count && same(state.contacts[static_cast<std::size_t>(c.place)], c.memory);
  });
}

void wake(int group, WorldScratch& scratch) {
  PINCER_ASSERT(group > 0);  // 0 is of all that is awake
  WorldSleep& sleep = scratch.sleep;
  std::erase_if(sleep.contacts, [&](const SleepingContact& c) {
    bool is_of_group = false;
    forBodiesOf(c.contact, [&](std::size_t body) { is_of_group = is_of_group || sleep.group[body] == group; });
    return is_of_group;
  });
  sleep.room = scratch.contacts.capacity() - sleep.contacts.size();
  for (std::size_t i = 0; i < sleep.group.size(); ++i) {
    if (sleep.group[i] != group) continue;
    sleep.group[i] = 0;
    sleep.idle[i] = false;
    --sleep.bodies;
  }
  PINCER_ASSERT(sleep.bodies >= 0);
}

// True if beside one of the island's bodies something moves, or changes, by a contact that isn't of the island because
// it can't close (far_contacts.h).
bool isBesideChange(const WorldModel& model, const WorldScratch& scratch, const Island& island) {
  if (scratch.far_contacts == 0) return false;
  for (const Contact& c : scratch.contacts) {
    if (!c.far || c.still) continue;
    for (int n = 0; n < island.contacts; ++n) {
      const Contact& own =
          scratch.contacts[static_cast<std::size_t>(scratch.islands.order[static_cast<std::size_t>(island.place + n)])];
      bool touches = false;
      forBodiesOf(own, [&](std::size_t body) {
        if (!model.bodies[body].dynamic) return;
        forBodiesOf(c, [&](std::size_t other) { touches = touches || other == body; });
      });
      if (touches) return true;
    }
  }
  return false;
}

bool isPushedAsBefore(const WorldScratch& scratch, std::size_t body) {
  const BodyForce& before = scratch.sleep.forces[body];
  const BodyForce* const force = forceOn(scratch, body);
  if (!force) return before.f_W.isZero(0) && before.tau_W.isZero(0);
  return force->f_W == before.f_W && force->tau_W == before.tau_W;
}

}  // namespace

void wakeChanged(const WorldModel& model, const WorldState& state, const StepInputs& inputs, WorldScratch& scratch) {
  WorldSleep& sleep = scratch.sleep;
  if (state.h_last != model.options.h || sleep.gravity_W != scratch.gravity_W || !sameMemories(state, sleep))
    return wakeAll(scratch);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    const bool is_idle = body.dynamic ? sleep.idle[i] : !body.driven || stands(model, i, state, inputs);
    if (sleep.idle[i] && is_idle && !same(state.bodies[i], sleep.states[i])) return wakeAll(scratch);
    if (body.dynamic && is_idle && !isPushedAsBefore(scratch, i)) return wakeAll(scratch);
    if (body.dynamic) continue;
    sleep.idle[i] = is_idle;
    sleep.states[i] = state.bodies[i];
  }
}

bool wakeTouched(WorldScratch& scratch) {
  WorldSleep& sleep = scratch.sleep;
  const int before = sleep.bodies;
  if (scratch.contacts_dropped) {
    scratch.contacts_dropped = false;
    wakeAll(scratch);
  }
  const auto touch = [&](std::size_t body) {
    if (sleep.group[body] > 0) wake(sleep.group[body], scratch);
  };
  for (const Contact& c : scratch.contacts) forBodiesOf(c, touch);
  for (const ImpactPair& pair : scratch.fast_pairs) {
    touch(static_cast<std::size_t>(pair.a));
    touch(static_cast<std::size_t>(pair.b));
  }
  return sleep.bodies < before;
}

void wakeAll(WorldScratch& scratch) {
  WorldSleep& sleep = scratch.sleep;
  if (sleep.bodies == 0) return;
  sleep.bodies = 0;
  sleep.contacts.clear();
  sleep.room = scratch.contacts.capacity();
  std::fill(sleep.group.begin(), sleep.group.end(), 0);
  std::fill(sleep.idle.begin(), sleep.idle.end(), false);
}

void fallAsleep(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  WorldSleep& sleep = scratch.sleep;
  if (scratch.still_bodies == 0) return;
  const int before = sleep.bodies;
  for (const Island& island : scratch.islands.islands) {
    if (isStill(scratch, island) && !isBesideChange(model, scratch, island)) putToSleep(model, state, island, scratch);
  }
  if (sleep.bodies == before) return;
  if (before == 0) noteStanding(model, state, scratch);
  putContactsAside(state, scratch);
}

}  // namespace pincer::engine
