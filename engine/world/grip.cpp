#include "pincer/engine/world/grip.h"

#include <algorithm>

#include "pincer/engine/world/contact_sides.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {
namespace {

bool isFreeBody(const WorldModel& model, const Side& side) {
  if (side.kind != SideKind::kBody) return false;
  const BodyModel& body = model.bodies[static_cast<std::size_t>(side.index)];
  return body.dynamic && !isJoined(body);
}

bool stands(const WorldModel& model, const Side& side) {
  return side.kind == SideKind::kBody && !model.bodies[static_cast<std::size_t>(side.index)].dynamic;
}

class GripReader {
 public:
  GripReader(const WorldModel& model, const WorldScratch& scratch, GripProblem& grip)
      : model_(model), scratch_(scratch), grip_(grip) {
    grip.points = grip.contacts = 0;
  }

  bool read(std::span<const int> order) {
    const Contact* before = nullptr;
    for (const int i : order) {
      const Contact& c = scratch_.contacts[static_cast<std::size_t>(i)];
      if (before && isOfSameTwo(*before, c))
        addAsBefore(c);
      else if (!add(c))
        return false;
      before = &c;
    }
    const auto body = static_cast<std::size_t>(body_);
    grip_.root_inverse_mass = model_.bodies[body].root_inverse_mass;
    grip_.F = scratch_.islands.root_inertia[body];
    return std::any_of(count_.begin(), count_.begin() + grip_.points, [](int n) { return n > 1; });
  }

 private:
  bool add(const Contact& c) {
    is_a_ = isFreeBody(model_, c.a);
    const Side &own = is_a_ ? c.a : c.b, &other = is_a_ ? c.b : c.a;
    if (!is_a_ && !isFreeBody(model_, own)) return false;
    if (body_ >= 0 && own.index != body_) return false;
    body_ = own.index;
    point_ = -1;
    if (other.kind == SideKind::kPoint ? !findPoint(other.index, point_) : !stands(model_, other)) return false;
    put(c);
    return true;
  }

  void put(const Contact& c) {
    grip_.contact[static_cast<std::size_t>(grip_.contacts++)] = {&c.R_WC, is_a_ ? &c.arm_a_W : &c.arm_b_W,
                                                                 is_a_ ? 1.0 : -1.0, point_};
  }
  void addAsBefore(const Contact& c) {
    put(c);
    if (point_ >= 0) ++count_[static_cast<std::size_t>(point_)];
  }

  // Its place among the grip's points.
  bool findPoint(int index, int& place) {
    const PointScratch& point = scratch_.points[static_cast<std::size_t>(index)];
    if (point.turned || point.inverse_turn > 0) return false;
    const auto end = index_.begin() + grip_.points, found = std::find(index_.begin(), end, index);
    place = static_cast<int>(found - index_.begin());
    if (place == kMostGripPoints) return false;
    if (found == end) {
      index_[static_cast<std::size_t>(place)] = index;
      count_[static_cast<std::size_t>(place)] = 0;
      grip_.point_root[static_cast<std::size_t>(place)] = point.root_inverse_mass;
      ++grip_.points;
    }
    ++count_[static_cast<std::size_t>(place)];
    return true;
  }

  const WorldModel& model_;
  const WorldScratch& scratch_;
  GripProblem& grip_;
  int body_ = -1, point_ = -1;                      // of the contact before; point_ as GripContact's
  bool is_a_ = false;                               // the body is its a
  std::array<int, kMostGripPoints> index_, count_;  // of each point: which it is; its contacts
};

}  // namespace

bool mayBeGrip(const IslandScratch& s, const Island& island, const std::vector<Contact>& contacts) {
  const int n = island.contacts;
  if (n < kFewestGripContacts || n > kMostGripContacts || island.rows != kPointRows * n) return false;
  if (s.sides_per_contact > 2) return false;
  const auto at = [&](int k) -> const Contact& {
    return contacts[static_cast<std::size_t>(s.order[static_cast<std::size_t>(island.place + k)])];
  };
  bool has_face = false;
  for (int k = n - 1; k > 0 && at(k).a.kind == SideKind::kPoint && !has_face; --k)
    has_face = isOfSameTwo(at(k), at(k - 1));
  return has_face;
}

bool readGrip(const WorldModel& model, const WorldScratch& scratch, std::span<const int> order, GripProblem& grip) {
  return GripReader(model, scratch, grip).read(order);
}

}  // namespace pincer::engine
