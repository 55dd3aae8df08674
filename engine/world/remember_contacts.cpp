// Each contact's memory of a tick.
#include <algorithm>
#include <array>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/rest.h"
#include "pincer/engine/world/stick_bias.h"

namespace pincer::engine {
namespace {

// Up to which gap an open contact hovers [m].
double hoveringGap(const WorldModel& model, const Contact& c) {
  constexpr double kHovering = 1e-3;  // of the margin
  double margin = model.options.contact_margin;
  for (const Side* side : {&c.a, &c.b}) {
    if (side->kind == SideKind::kBody)
      margin = std::min(margin, model.bodies[static_cast<std::size_t>(side->index)].contact_margin);
  }
  return kHovering * margin;
}

// How long it has been open by next to nothing, kOpenTicks if by more.
int openTicks(const WorldModel& model, const Contact& c) {
  if (c.active()) return 0;
  if (!(c.phi <= hoveringGap(model, c))) return kOpenTicks;
  return std::min(c.open_ticks + 1, kOpenTicks);
}

// True if an overlap of it that was left (solve_island.cpp) is left further: pressed or not, for as long as nothing
// moves there. Friction that is used up holds a jam as well.
bool keepsOverlap(const Contact& c) {
  if (!(c.offset_C[kNormalRow] < 0)) return false;
  double v_end_C[kMaxContactRows];
  relativeVelocity(c, c.mover_a->end, c.mover_b->end, kPointRows, v_end_C);
  return Vec3(v_end_C[0], v_end_C[1], v_end_C[kNormalRow]).norm() < kClosingSpeed;
}

void remember(const WorldModel& model, const Contact& c, double h, ContactMemory& m) {
  const int open_ticks = openTicks(model, c);
  const bool hovers = open_ticks > 0 && open_ticks < kOpenTicks;
  m.id = c.id;
  m.r = c.r;
  m.t1_W = c.R_WC.col(0);
  m.n_W = c.n_W();
  m.arm_a_W = c.arm_a_W;
  m.arm_b_W = c.arm_b_W;
  m.offset_C.setZero();
  m.active = c.active();
  m.open_ticks = open_ticks;
  m.anchored = m.active ? !c.sliding : hovers && c.stuck;
  m.sliding = c.sliding;
  m.closing = c.closing;
  m.settling = c.settling;
  if (keepsOverlap(c)) m.offset_C[kNormalRow] = c.offset_C[kNormalRow];
  if (!m.anchored) return;
  if (c.a.kind == SideKind::kJoint && !c.stuck) return;  // its anchor is where it came to rest
  withRows(rowsOf(c.material), [&](auto rows) {
    double v_end_C[kMaxContactRows];
    relativeVelocity(c, c.mover_a->end, c.mover_b->end, rows, v_end_C);
    for (int k = 0; k < rows; ++k) {
      const double v_mean = c.closing ? v_end_C[k] : 0.5 * (c.v_start_C[k] + v_end_C[k]);
      m.offset_C[k] = c.offset_C[k] + (k == kNormalRow ? 0 : h * v_mean);
    }
  });
}

constexpr double kAligned = 1e-12;  // of the offsets: round-off

bool sticks(const ContactMemory& m) { return m.active && !m.sliding; }
// Or is as good as closed: then it takes its offset from its face.
bool mayStick(const ContactMemory& m) { return sticks(m) || (m.open_ticks > 0 && m.open_ticks < kOpenTicks); }

bool isStuckAlike(int shape_bits, const ContactMemory& x, const ContactMemory& y) {
  return isOfSameTwo(shape_bits, x.id, y.id) && mayStick(y) && x.n_W.dot(y.n_W) > kSamePlane;
}

// True if all contacts of a face stick in one frame, and some rigid motion of its plane gives their offsets, but for D:
// then least squares leave no more than N D^2 of all N. Seen from the first contact, without a frame for each.
bool haveMovedRigidly(std::span<const ContactMemory> face) {
  constexpr double kRigid = 0.25 * kAligned * kAligned;
  const ContactMemory& first = face.front();
  const Vec3 t2_W = first.n_W.cross(first.t1_W);
  const auto rho = [&](const ContactMemory& m) {
    const Vec3 way_W = m.arm_a_W - first.arm_a_W;
    return Vec2(first.t1_W.dot(way_W), t2_W.dot(way_W));
  };
  constexpr std::size_t kMost = 8;  // corners of a face, as a rule fewer; beyond, places are found again
  std::array<Vec2, kMost> places;
  double turn = 0, spread = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const ContactMemory& m = face[k];
    if (!sticks(m) || m.t1_W != first.t1_W || m.n_W != first.n_W) return false;
    const Vec2 at = rho(m);
    if (k < kMost) places[k] = at;
    turn += at.x() * (m.offset_C[1] - first.offset_C[1]) - at.y() * (m.offset_C[0] - first.offset_C[0]);
    spread += at.squaredNorm();
  }
  const double theta = spread > 0 ? turn / spread : 0;
  double left = 0, largest = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const ContactMemory& m = face[k];
    const Vec2 at = k < kMost ? places[k] : rho(m), offset = m.offset_C.head<2>();
    left = std::max(left, (offset - first.offset_C.head<2>() - theta * Vec2(-at.y(), at.x())).squaredNorm());
    largest = std::max(largest, offset.squaredNorm());
  }
  return static_cast<double>(face.size()) * left <= kRigid * largest;
}

// Makes the offsets of one face's contacts those of one rigid motion in its plane, d + theta n x rho:
// what no motion can undo would wedge the body against its own friction, and the solver against the
// round-off of it. Least squares, all points alike.
void alignOffsets(std::span<ContactMemory> face) {
  if (haveMovedRigidly(face)) return;
  Vec3 centre = Vec3::Zero(), d = Vec3::Zero();
  const auto offset_W = [](const ContactMemory& m) {
    return Vec3(m.t1_W * m.offset_C[0] + m.n_W.cross(m.t1_W) * m.offset_C[1]);
  };
  const auto count = static_cast<double>(std::count_if(face.begin(), face.end(), sticks));
  if (count == 0) return;
  for (const ContactMemory& m : face) {
    if (!sticks(m)) continue;
    centre += m.arm_a_W / count;
    d += offset_W(m) / count;
  }
  double turn = 0, spread = 0;
  for (const ContactMemory& m : face) {
    if (!sticks(m)) continue;
    const Vec3 way_W = m.n_W.cross(m.arm_a_W - centre);  // of a turn by 1; a face that tilts has places off its plane
    turn += way_W.dot(offset_W(m));
    spread += way_W.squaredNorm();
  }
  const double theta = spread > 0 ? turn / spread : 0;
  const auto fitted_W = [&](const ContactMemory& m) { return Vec3(d + theta * m.n_W.cross(m.arm_a_W - centre)); };
  double largest = 0, change = 0;
  for (const ContactMemory& m : face) {
    if (!sticks(m)) continue;
    largest = std::max(largest, offset_W(m).squaredNorm());
    change = std::max(change, (fitted_W(m) - offset_W(m)).squaredNorm());
  }
  const bool is_aligned = change <= kAligned * kAligned * largest;  // so that what rests does so to the bit
  for (ContactMemory& m : face) {
    if (is_aligned && sticks(m)) continue;
    m.anchored = true;
    const Vec3 offset = fitted_W(m);
    m.offset_C[0] = m.t1_W.dot(offset);
    m.offset_C[1] = m.n_W.cross(m.t1_W).dot(offset);
  }
}

// Contacts of two bodies follow each other, sorted by id; a face is a run of them that stick in one
// plane. Those that sleep stay as they are.
void alignFaces(int shape_bits, std::span<ContactMemory> contacts, std::span<const SleepingContact> sleeping) {
  for (std::size_t first = 0; first < contacts.size();) {
    if (!sleeping.empty() && sleeping.front().place == static_cast<int>(first)) {
      sleeping = sleeping.subspan(1);
      ++first;
      continue;
    }
    std::size_t end = first + 1;
    const bool stuck = mayStick(contacts[first]);
    while (stuck && end < contacts.size() && isStuckAlike(shape_bits, contacts[first], contacts[end])) ++end;
    if (end > first + 1) alignOffsets(contacts.subspan(first, end - first));
    first = end;
  }
}

// Of both bodies nothing changed in this tick: nor may anything of what the contact remembers.
bool standsStill(const WorldScratch& scratch, const Contact& c) {
  const auto is_still = [&](const Side& side) {
    return side.kind == SideKind::kBody && scratch.bodies[static_cast<std::size_t>(side.index)].still;
  };
  return !c.closing && is_still(c.a) && is_still(c.b);
}

// Notes what was remembered of contacts that stand still, which is about to be written over, to compare.
void keepOld(const WorldScratch& scratch, Contact& c, ContactMemory* place, std::vector<KeptMemory>& kept) {
  c.still = false;
  if (c.memory == place && standsStill(scratch, c)) kept.push_back({&c, place, *place});
}

// Puts what sleeping contacts of ids below `id` remember where it belongs, from
// `place` on. Returns the place behind it.
ContactMemory* putSleeping(std::span<SleepingContact>& sleeping, std::uint64_t id, ContactMemory* first,
                           ContactMemory* place) {
  for (; !sleeping.empty() && sleeping.front().contact.id < id; sleeping = sleeping.subspan(1), ++place) {
    const auto now = static_cast<int>(place - first);
    if (sleeping.front().place != now) *place = sleeping.front().memory;
    sleeping.front().place = now;
  }
  return place;
}

std::uint64_t nextId(std::span<const SleepingContact> sleeping) {
  return sleeping.empty() ? ~std::uint64_t{0} : sleeping.front().contact.id;
}

}  // namespace

void rememberContacts(const WorldModel& model, WorldScratch& scratch, WorldState& state) {
  const double h = scratch.h;
  const bool may_sleep = model.options.sleep && scratch.still_bodies > 0;
  std::span<SleepingContact> sleeping = scratch.sleep.contacts;
  PINCER_ASSERT(scratch.contacts.size() + sleeping.size() <= state.contacts.size());
  PINCER_ASSERT(isAscending(sleeping, [](const SleepingContact& c) { return c.contact.id; }));
  std::uint64_t next_id = nextId(sleeping);
  ContactMemory *const first = state.contacts.data(), *place = first;
  scratch.kept.clear();
  for (Contact& c : scratch.contacts) {
    if (next_id < c.id) {
      place = putSleeping(sleeping, c.id, first, place);
      next_id = nextId(sleeping);
    }
    if (may_sleep) keepOld(scratch, c, place, scratch.kept);
    remember(model, c, h, *place++);
  }
  if (!sleeping.empty()) place = putSleeping(sleeping, ~std::uint64_t{0}, first, place);
  state.contact_count = static_cast<int>(place - first);
  PINCER_ASSERT(isAscending(std::span<const ContactMemory>(first, place), &ContactMemory::id));
  alignFaces(model.shape_bits, {first, place}, scratch.sleep.contacts);
  for (const KeptMemory& kept : scratch.kept) kept.contact->still = same(*kept.place, kept.memory);
}

}  // namespace pincer::engine
