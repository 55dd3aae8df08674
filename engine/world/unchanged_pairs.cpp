#include "pincer/engine/world/unchanged_pairs.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/budget.h"
#include "pincer/engine/world/island_sleep.h"
#include "pincer/engine/world/room.h"

namespace pincer::engine {
namespace {

// By their bits: zeros of both signs may lead to others.
bool isSame(const BodyCourse& a, const BodyCourse& b) { return std::memcmp(a.data(), b.data(), sizeof a) == 0; }

// Behind its last number there may be anything.
bool isSame(const ContactMemory& a, const ContactMemory& b) {
  return std::memcmp(&a, &b, offsetof(ContactMemory, settling) + sizeof a.settling) == 0;
}

// The run of items, sorted by id, that are of the two bodies whose contacts are numbered from `first` on. Pairs come
// in order as a rule: looked for from `cursor` on, which is left at the run.
template <class Item>
std::span<Item> runOf(std::span<Item> items, int shape_bits, std::uint64_t first, std::size_t& cursor) {
  const auto less = [](const Item& item, std::uint64_t id) { return item.id < id; };
  if (cursor > items.size() || (cursor > 0 && items[cursor - 1].id >= first))
    cursor = static_cast<std::size_t>(std::lower_bound(items.begin(), items.end(), first, less) - items.begin());
  while (cursor < items.size() && items[cursor].id < first) ++cursor;
  std::size_t end = cursor;
  while (end < items.size() && isOfSameTwo(shape_bits, items[end].id, first)) ++end;
  return items.subspan(cursor, end - cursor);
}

// The contacts that are kept so far go where new ones are added.
void leavePlace(WorldScratch& scratch) {
  LastAttempt& last = scratch.last;
  if (!last.in_place) return;
  last.in_place = false;
  scratch.contacts.assign(last.contacts.begin(), last.contacts.begin() + static_cast<std::ptrdiff_t>(last.kept));
}

// Each contact remembers what it did, under its own identity.
bool remembersTheSame(std::span<const Contact> contacts, std::span<const ContactMemory> then,
                      std::span<const ContactMemory> now) {
  if (then.size() != contacts.size() || now.size() != contacts.size()) return false;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (!contacts[k].as_asked || contacts[k].id != now[k].id || !isSame(then[k], now[k])) return false;
  }
  return true;
}

std::span<const ContactMemory> memoriesOf(const WorldState& state) {
  return {state.contacts.data(), static_cast<std::size_t>(state.contact_count)};
}

bool keepUnchanged(const WorldModel& model, const WorldState& state, const BodyPair& pair, WorldScratch& scratch) {
  LastAttempt& last = scratch.last;
  if (!last.serves || !scratch.bodies[pair.a].unchanged || !scratch.bodies[pair.b].unchanged) return false;
  const std::uint64_t first =
      contactId(model.shape_bits, {SideKind::kBody, 0, pair.a}, {SideKind::kBody, 0, pair.b}, 0);
  const auto contacts = runOf(std::span<Contact>(last.contacts), model.shape_bits, first, last.contact);
  const std::size_t so_far = last.in_place ? last.kept : scratch.contacts.size();
  if (so_far + contacts.size() > scratch.sleep.room) return false;
  if (contacts.empty() && (last.something_slept || isSomethingAsleep(scratch))) return false;  // it wasn't looked at
  const auto then = runOf(std::span<const ContactMemory>(last.memories), model.shape_bits, first, last.memory_then);
  const auto now = runOf(memoriesOf(state), model.shape_bits, first, last.memory_now);
  if (!remembersTheSame(contacts, then, now)) return false;
  if (!contacts.empty() && contacts.data() != last.contacts.data() + last.kept) leavePlace(scratch);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    Contact& c = last.in_place ? contacts[k] : scratch.contacts.emplace_back(contacts[k]);
    c.same_as = static_cast<int>(&contacts[k] - last.contacts.data());
    c.memory = &now[k];
    c.settling = now[k].settling;
    c.rest_speed = 0;
    c.yields = c.still = false;
  }
  last.kept += contacts.size();
  return true;
}

}  // namespace

LastAttempt::LastAttempt(const WorldModel& model)
    : is_wanted(model.has_broad_phase && !model.has_hollows && model.trees.empty()) {
  if (!is_wanted) return;
  const auto count = static_cast<std::size_t>(model.options.max_contacts);
  makeRoom(contacts, count);
  makeRoom(memories, count);
  first_row.resize(count + 1);
  q.resize(count * kMaxContactRows);
}

void noteCourse(const BodyCourse& before, bool lone, const WorldScratch& scratch, BodyScratch& body) {
  body.unchanged = lone && (scratch.last.is_solved || body.unchanged) && isSame(before, courseOf(body));
}

void beginContacts(const WorldState& state, bool again, WorldScratch& scratch) {
  LastAttempt& last = scratch.last;
  if (last.is_solved) {
    scratch.contacts.swap(last.contacts);
    scratch.first_row.swap(last.first_row);
    scratch.q.swap(last.q);
  }
  std::erase_if(scratch.contacts, [again](const Contact& c) { return !again || c.a.kind != SideKind::kPoint; });
  last.serves = (last.is_solved || last.serves) && scratch.h == last.h && state.h_last == last.h_last &&
                !scratch.flings && !isLimited(scratch);
  last.is_solved = false;
  last.in_place = last.serves && !again && !isSomethingAsleep(scratch);
  last.kept = last.contact = last.memory_then = last.memory_now = 0;
}

void forgetContacts(WorldScratch& scratch) {
  scratch.contacts.clear();
  scratch.last.is_solved = scratch.last.serves = false;
}

bool keepContacts(const WorldModel& model, const WorldState& state, const BodyPair& pair, WorldScratch& scratch) {
  if (keepUnchanged(model, state, pair, scratch)) return true;
  leavePlace(scratch);
  return false;
}

void takeKept(WorldScratch& scratch) {
  LastAttempt& last = scratch.last;
  if (!last.in_place) return;
  last.in_place = false;
  scratch.contacts.swap(last.contacts);
  scratch.contacts.erase(scratch.contacts.begin() + static_cast<std::ptrdiff_t>(last.kept), scratch.contacts.end());
}

void keepRows(double longer, WorldScratch& scratch, int i) {
  Contact& c = scratch.contacts[static_cast<std::size_t>(i)];
  const LastAttempt& last = scratch.last;
  const int to = scratch.first_row[static_cast<std::size_t>(i)],
            from = last.first_row[static_cast<std::size_t>(c.same_as)];
  withRows(rowsOf(c.material), [&](auto rows) {
    for (int k = 0; k < rows; ++k) {
      scratch.q[static_cast<std::size_t>(to + k)] = last.q[static_cast<std::size_t>(from + k)];
      scratch.r[static_cast<std::size_t>(to + k)] = c.r[k] = longer * c.memory->r[k];
    }
  });
  scratch.mu[static_cast<std::size_t>(i)] = c.mu;
}

void noteMemories(const WorldState& state, WorldScratch& scratch) {
  LastAttempt& last = scratch.last;
  if (!last.is_wanted) return;
  const std::span<const ContactMemory> memories = memoriesOf(state);
  const bool all_kept = last.kept == memories.size() && last.kept == last.memories.size();
  if (!all_kept) last.memories.assign(memories.begin(), memories.end());
}

void noteSolved(const WorldState& state, WorldScratch& scratch) {
  LastAttempt& last = scratch.last;
  last.is_solved =
      last.is_wanted && scratch.h > 0 && scratch.impact_pairs.empty() && !scratch.contacts_dropped && !scratch.flings;
  last.serves = false;
  last.something_slept = isSomethingAsleep(scratch);
  last.h = scratch.h;
  last.h_last = state.h_last;
}

}  // namespace pincer::engine
