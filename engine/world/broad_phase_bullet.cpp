#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/bullet_memory.h"
#include "pincer/engine/world/broad_phase.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {
namespace {

// by which the tree's boxes are larger [m]; Bullet's own 50 mm is for rooms, not for hands
constexpr double kTreeMargin = 5e-4;
constexpr int kPairsPerBody = 16;  // for which memory is there from the start

bool isBounded(const BodyModel& body) { return body.bounding_radius < 1e9; }

struct Box {
  btVector3 low, high;
};

Box boxOf(const WorldModel& model, const WorldScratch& scratch, int body) {
  const BodyScratch& s = scratch.bodies[body];
  const BodyModel& b = model.bodies[body];
  const double reach = b.bounding_radius + 0.5 * b.contact_margin + model.options.h * s.start.v_W.norm();
  const Vec3 low = s.X_WI_mid.p - Vec3::Constant(reach), high = s.X_WI_mid.p + Vec3::Constant(reach);
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

int bodyOf(const btBroadphaseProxy& proxy) { return *static_cast<const int*>(proxy.m_clientObject); }

bool overlap(const btBroadphaseProxy& x, const btBroadphaseProxy& y) {
  for (int k = 0; k < 3; ++k) {
    if (!(x.m_aabbMin[k] <= y.m_aabbMax[k] && y.m_aabbMin[k] <= x.m_aabbMax[k])) return false;
  }
  return true;
}

bool meet(const btBroadphaseProxy& x, const Box& box) {
  for (int k = 0; k < 3; ++k) {
    if (!(x.m_aabbMin[k] <= box.high[k] && box.low[k] <= x.m_aabbMax[k])) return false;
  }
  return true;
}

// By how much `inner` sticks out of `outer`, negative if it doesn't [m]; not finite where one of them isn't.
double excessOf(const Box& inner, const Box& outer) {
  const btVector3 low = outer.low - inner.low, high = inner.high - outer.high;
  const double check = (low.x() + low.y() + low.z()) + (high.x() + high.y() + high.z());
  if (!std::isfinite(check)) return std::numeric_limits<double>::infinity();
  return std::max({low.x(), low.y(), low.z(), high.x(), high.y(), high.z()});
}

Box around(const Box& box, double further) {
  const btVector3 way(further, further, further);
  return {box.low - way, box.high + way};
}

// Bodies found round a place, kept for as long as no box can have come in from further out: most of a look into a
// tree of a thousand bodies is the way down.
class NearMemory {
 public:
  static constexpr double kWider = 4e-3;  // than asked for [m]

  void note(const Box& wide, const std::vector<int>& bodies, double way) {
    is_known_ = bodies.size() <= bodies_.size();
    if (!is_known_) return;
    wide_ = wide;
    way_ = way;
    count_ = bodies.size();
    std::copy(bodies.begin(), bodies.end(), bodies_.begin());
  }
  void forget() { is_known_ = false; }

  // True if it has all bodies whose boxes meet `box`.
  //   way  by how much the boxes' faces have come out since any time before the note, tick by tick the most [m]
  bool holds(const Box& box, double way) const {
    constexpr double kRoundOff = 1e-9;  // of ways and places [m]
    return is_known_ && (way - way_) + kRoundOff <= -excessOf(box, wide_);
  }
  std::span<const int> bodies() const { return {bodies_.data(), count_}; }

 private:
  Box wide_;
  double way_ = 0;
  std::array<int, 12> bodies_;
  std::size_t count_ = 0;
  bool is_known_ = false;
};

// A half-space's far side is all that matters of it.
bool isNear(const WorldModel& model, const WorldScratch& scratch, int unbounded, int body) {
  if (!model.bodies[unbounded].is_plane) return true;
  const BodyScratch &plane = scratch.bodies[unbounded], &s = scratch.bodies[body];
  const double height = plane.R_WB_mid.col(2).dot(s.X_WI_mid.p - plane.X_WB_mid.p);
  const double speed = (s.start.v_W - plane.start.v_W).norm();
  const BodyModel& b = model.bodies[body];
  return height <= b.bounding_radius + b.contact_margin + model.options.h * speed;
}

}  // namespace

struct BroadPhase::Tree {
  btDbvtBroadphase bullet;
  std::vector<btBroadphaseProxy*> proxies;  // per body, null for unbounded ones
  std::vector<int> numbers;                 // of bodies, for proxies to point to
  std::vector<NearMemory> memories;         // of each who asks in turn after candidates(), as fingers do
  std::size_t asked = 0;
  double way = 0;  // see NearMemory::holds

  explicit Tree(const WorldModel& model)
      : proxies(model.bodies.size(), nullptr), numbers(model.bodies.size()), memories(model.points.size()) {
    gDbvtMargin = kTreeMargin;
    reservePairs(static_cast<int>(model.bodies.size()));
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
      const BodyModel& body = model.bodies[i];
      if (!isBounded(body)) continue;
      constexpr int kDynamic = 1, kStatic = 2;  // Bullet's groups, a bit each
      numbers[i] = static_cast<int>(i);
      const btVector3 apart(1e3 * static_cast<double>(i), 0, 0);  // a pair of all with all would be found otherwise
      proxies[i] = bullet.createProxy(apart, apart, 0, &numbers[i], body.dynamic ? kDynamic : kStatic,
                                      body.dynamic ? kDynamic | kStatic : kDynamic, nullptr);
    }
  }
  ~Tree() {
    for (btBroadphaseProxy* proxy : proxies) {
      if (proxy) bullet.destroyProxy(proxy, nullptr);
    }
  }

  // Called once all boxes are where they are now; a face of one came out by as much as `fastest` [m].
  void noteWay(double fastest) {
    constexpr double kLongWay = 1;  // [m], from which round-off isn't that of NearMemory
    asked = 0;
    way += fastest;
    if (way <= kLongWay) return;
    way = 0;
    for (NearMemory& memory : memories) memory.forget();
  }

 private:
  // Bullet's pair cache grows as pairs come; so many that all overlap make it grow now.
  void reservePairs(int bodies) {
    const int count = 2 + static_cast<int>(std::sqrt(2.0 * kPairsPerBody * bodies));
    std::vector<btBroadphaseProxy*> dummies;
    const btVector3 low(-1, -1, -1), high(1, 1, 1);
    for (int i = 0; i < count; ++i) dummies.push_back(bullet.createProxy(low, high, 0, nullptr, 1, 1, nullptr));
    bullet.calculateOverlappingPairs(nullptr);
    for (btBroadphaseProxy* proxy : dummies) bullet.destroyProxy(proxy, nullptr);
    bullet.calculateOverlappingPairs(nullptr);
  }
};

BroadPhase::BroadPhase(const WorldModel& model) : tree_((contact::letBulletThrow(), std::make_unique<Tree>(model))) {
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (model.bodies[i].dynamic) dynamic_.push_back(static_cast<int>(i));
    if (!isBounded(model.bodies[i])) unbounded_.push_back(static_cast<int>(i));
  }
  for (std::vector<BodyPair>* pairs : {&pairs_, &sorted_})
    pairs->reserve((kPairsPerBody + unbounded_.size()) * model.bodies.size());
  first_.resize(model.bodies.size() + 1);
  near_.reserve(model.bodies.size());
}

BroadPhase::~BroadPhase() = default;

std::span<const BodyPair> BroadPhase::candidates(const WorldModel& model, const WorldScratch& scratch) {
  pairs_.clear();
  double fastest = 0;
  for (std::size_t i = 0; i < tree_->proxies.size(); ++i) {
    btBroadphaseProxy* const proxy = tree_->proxies[i];
    if (!proxy) continue;
    const Box box = boxOf(model, scratch, static_cast<int>(i));
    fastest = std::max(fastest, excessOf(box, {proxy->m_aabbMin, proxy->m_aabbMax}));
    tree_->bullet.setAabb(proxy, box.low, box.high, nullptr);
  }
  tree_->noteWay(fastest);
  tree_->bullet.calculateOverlappingPairs(nullptr);
  const btBroadphasePairArray& found = tree_->bullet.getOverlappingPairCache()->getOverlappingPairArray();
  for (int i = 0; i < found.size(); ++i) {
    const btBroadphaseProxy &x = *found[i].m_pProxy0, &y = *found[i].m_pProxy1;
    if (overlap(x, y)) pairs_.push_back({std::min(bodyOf(x), bodyOf(y)), std::max(bodyOf(x), bodyOf(y))});
  }
  for (const int wall : unbounded_) {
    for (const int body : dynamic_) {
      if (isNear(model, scratch, wall, body)) pairs_.push_back({std::min(wall, body), std::max(wall, body)});
    }
  }
  const auto excluded = [&](const BodyPair& p) {
    return std::binary_search(model.excluded_pairs.begin(), model.excluded_pairs.end(), std::pair(p.a, p.b));
  };
  if (!model.excluded_pairs.empty()) pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), excluded), pairs_.end());
  sortBy(&BodyPair::b);
  sortBy(&BodyPair::a);
  PINCER_ASSERT(isAscending(pairs_, [](const BodyPair& p) { return std::pair(p.a, p.b); }));
  return pairs_;
}

namespace {

struct NearBodies final : btBroadphaseAabbCallback {
  explicit NearBodies(std::vector<int>& all) : bodies(all) {}
  bool process(const btBroadphaseProxy* proxy) override {
    bodies.push_back(bodyOf(*proxy));
    return true;
  }
  std::vector<int>& bodies;
};

}  // namespace

// The tree's boxes lie about the present ones and depend on the past; what is looked at beyond reach
// changes nothing but trackers that are reset.
std::span<const int> BroadPhase::bodiesNear(const Vec3& p_W, double reach) {
  const auto keep_meeting = [&](const Box& box) {
    const auto is_far = [&](int body) {
      const btBroadphaseProxy* const proxy = tree_->proxies[static_cast<std::size_t>(body)];
      return proxy && !meet(*proxy, box);
    };
    near_.erase(std::remove_if(near_.begin(), near_.end(), is_far), near_.end());
  };
  const btVector3 centre(p_W.x(), p_W.y(), p_W.z());
  const Box box = around({centre, centre}, reach);
  NearMemory* const memory = tree_->asked < tree_->memories.size() ? &tree_->memories[tree_->asked++] : nullptr;
  if (!memory || !memory->holds(box, tree_->way)) {
    const Box wide = around(box, memory ? NearMemory::kWider : 0);
    near_.assign(unbounded_.begin(), unbounded_.end());
    NearBodies found(near_);
    tree_->bullet.aabbTest(wide.low, wide.high, found);
    keep_meeting(wide);
    std::sort(near_.begin(), near_.end());
    if (memory) memory->note(wide, near_, tree_->way);
  } else {
    near_.assign(memory->bodies().begin(), memory->bodies().end());
  }
  keep_meeting(box);
  return near_;
}

// Counts and places, keeping the order of equals: a third of the time of comparing.
void BroadPhase::sortBy(int BodyPair::*key) {
  PINCER_ASSERT(
      std::all_of(pairs_.begin(), pairs_.end(), [&](const BodyPair& p) { return isIndex(p.*key, first_.size() - 1); }));
  std::fill(first_.begin(), first_.end(), 0);
  for (const BodyPair& pair : pairs_) ++first_[static_cast<std::size_t>(pair.*key) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  sorted_.resize(pairs_.size());
  for (const BodyPair& pair : pairs_)
    sorted_[static_cast<std::size_t>(first_[static_cast<std::size_t>(pair.*key)]++)] = pair;
  pairs_.swap(sorted_);
}

}  // namespace pincer::engine
