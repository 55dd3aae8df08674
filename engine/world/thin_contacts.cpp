#include "pincer/engine/world/thin_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "pincer/contact/shape/point_choice.h"
#include "pincer/engine/world/stick_bias.h"

namespace pincer::engine {
namespace {

// the tangent of kSamePlane: by which points of one plane may be out of level, over their distance
constexpr double kLevel = 0.0141;
constexpr double kLevelRoundOff = 1e-6;    // [m]: what overlaps by less is level
constexpr std::size_t kMostThinned = 256;  // of more points nothing is thinned

bool isSameMaterial(const Material& x, const Material& y) {
  return x.mu_s == y.mu_s && x.mu_d == y.mu_d && x.restitution == y.restitution &&
         x.torsion_radius == y.torsion_radius && x.rolling_radius == y.rolling_radius &&
         x.stribeck_speed == y.stribeck_speed;
}

bool isInOnePlane(const Contact& x, const Contact& y) {
  const Vec3 way = y.p_W - x.p_W;
  return x.n_W().dot(y.n_W()) > kSamePlane && std::abs(x.n_W().dot(way)) <= kLevel * way.norm() + kLevelRoundOff &&
         isSameMaterial(x.material, y.material);
}

// The contacts of one plane, for PointChoice: a solid's points, and the support under them.
class PlanePoints {
 public:
  explicit PlanePoints(const Vec3& n_W) : n_W_(n_W) {}
  void add(std::size_t index, const Contact& c) {
    points_[count_] = c.p_W;
    gaps_[count_] = c.phi;
    index_[count_++] = index;
  }
  std::size_t count() const { return count_; }
  std::size_t indexOf(int i) const { return index_[static_cast<std::size_t>(i)]; }
  std::span<const Vec3> points() const { return {points_.data(), count_}; }
  double gap(const Vec3& point) const { return gaps_[static_cast<std::size_t>(&point - points_.data())]; }
  const Vec3& normal(const Vec3&) const { return n_W_; }

  // Puts first the outermost of the deepest.
  void beginOutside() {
    const double deepest = *std::min_element(gaps_.begin(), gaps_.begin() + static_cast<std::ptrdiff_t>(count_));
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points()) mean += p / static_cast<double>(count_);
    std::size_t outermost = 0;
    double furthest = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double distance = n_W_.cross(points_[i] - mean).norm();
      if (gaps_[i] > deepest + contact::kSameGap || !(distance > contact::kBetter * furthest)) continue;
      furthest = distance;
      outermost = i;
    }
    std::swap(points_[0], points_[outermost]);
    std::swap(gaps_[0], gaps_[outermost]);
    std::swap(index_[0], index_[outermost]);
  }

 private:
  Vec3 n_W_;
  std::size_t count_ = 0;
  std::array<Vec3, kMostThinned> points_;
  std::array<double, kMostThinned> gaps_;
  std::array<std::size_t, kMostThinned> index_;
};

const ContactMemory* memoryOf(const WorldState& state, std::uint64_t id) {
  const auto less = [](const ContactMemory& m, std::uint64_t other) { return m.id < other; };
  const auto end = state.contacts.begin() + state.contact_count;
  const auto found = std::lower_bound(state.contacts.begin(), end, id, less);
  return found != end && found->id == id ? &*found : nullptr;
}

enum class Fate : unsigned char { kOpen, kKept, kDropped };

// Decides about the plane of the contact `leader` and of those behind it.
void thinPlane(const WorldState& state, std::span<const Contact> contacts, std::size_t leader, std::span<Fate> fates) {
  PlanePoints plane(contacts[leader].n_W());
  for (std::size_t i = leader; i < contacts.size(); ++i) {
    if (fates[i] == Fate::kOpen && isInOnePlane(contacts[leader], contacts[i])) plane.add(i, contacts[i]);
  }
  const bool few = plane.count() <= contact::kMaxChosen;
  for (std::size_t i = 0; i < plane.count(); ++i)
    fates[plane.indexOf(static_cast<int>(i))] = few ? Fate::kKept : Fate::kDropped;
  if (few) return;
  plane.beginOutside();
  const contact::ExtremePoints points{plane.points(), {}, 0};
  contact::LastPoints last;
  for (std::uint32_t i = 0; i < plane.count(); ++i) {
    const ContactMemory* const memory = memoryOf(state, contacts[plane.indexOf(static_cast<int>(i))].id);
    if (memory) last.add(i, memory->active);
  }
  const contact::PointChoice<PlanePoints> choice(points, plane, std::numeric_limits<double>::infinity(), last);
  for (int i = 0; i < choice.count(); ++i) fates[plane.indexOf(choice[i].index)] = Fate::kKept;
}

}  // namespace

void thinContacts(const WorldState& state, std::size_t first, WorldScratch& scratch) {
  std::vector<Contact>& all = scratch.contacts;
  if (scratch.contacts_dropped || all.size() <= first + contact::kMaxChosen || all.size() > first + kMostThinned)
    return;
  const std::span<const Contact> contacts(all.data() + first, all.size() - first);
  std::array<Fate, kMostThinned> fates{};
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (fates[i] == Fate::kOpen) thinPlane(state, contacts, i, fates);
  }
  std::size_t kept = first;
  for (std::size_t i = first; i < all.size(); ++i) {
    if (fates[i - first] == Fate::kDropped) continue;
    if (kept != i) all[kept] = all[i];
    ++kept;
  }
  all.resize(kept);
}

}  // namespace pincer::engine
