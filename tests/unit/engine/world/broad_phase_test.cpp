// Many bodies: the tree finds what looking at every pair finds, and a heap behaves.
#include "pincer/engine/world/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pincer/engine/state.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/allocation_guard.h"

namespace pincer::engine {
namespace {

constexpr Material kGlass{0.5, 0.5, 0, 0};

struct Heap {
  WorldModel model;
  WorldState state;
};

// `layers` of 5 x 5 balls over a floor between two walls.
Heap heap(int layers) {
  WorldOptions options;
  options.max_contacts = 600;
  WorldBuilder builder{options};
  std::vector<BodyStart> starts;
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
    builder.addBody({"wall", contact::HalfSpace{}, false, 0, kGlass});
    const double distance = n.z() > 0 ? 0 : 0.055;
    starts.push_back({{Quat::FromTwoVectors(Vec3::UnitZ(), n), -distance * n}, Vec3::Zero(), Vec3::Zero()});
  }
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> jitter(-5e-4, 5e-4);
  for (int k = 0; k < 25 * layers; ++k) {
    builder.addBody({"ball", contact::Sphere{0.01}, true, 0.05, kGlass});
    const double x = 0.0215 * (k % 5 - 2) + jitter(generator), y = 0.0215 * (k / 5 % 5 - 2) + jitter(generator);
    starts.push_back(
        {{Quat::Identity(), Vec3(x, y, 0.0112 + 0.0215 * (k / 25) + jitter(generator))}, Vec3::Zero(), Vec3::Zero()});
  }
  Heap h{builder.build(), {}};
  h.state = makeState(h.model, starts, {});
  return h;
}

// Pairs that touch or nearly do, by looking at all.
std::vector<std::pair<int, int>> closePairs(const Heap& h) {
  std::vector<std::pair<int, int>> pairs;
  const int n = static_cast<int>(h.model.bodies.size());
  for (int a = 5; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      const double gap = (h.state.bodies[a].X_WI.p - h.state.bodies[b].X_WI.p).norm() - 0.02;
      if (gap < 0.5e-3) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

TEST(BroadPhase, FindsWhatLookingAtEveryPairFinds) {
  Heap h = heap(1);
  ASSERT_TRUE(h.model.has_broad_phase);
  EXPECT_TRUE(h.model.pairs.empty());
  WorldScratch scratch(h.model);
  for (int tick = 0; tick < 120; ++tick) {
    const auto expected = closePairs(h);
    step(h.model, h.state, scratch);
    std::vector<std::pair<int, int>> found;
    for (const Contact& c : scratch.contacts) found.emplace_back(c.a.index, c.b.index);
    std::sort(found.begin(), found.end());
    for (const auto& pair : expected) {
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), pair))
          << tick << ": " << pair.first << " " << pair.second;
    }
  }
}

TEST(BroadPhase, DependsOnThePresentOnly) {
  Heap h = heap(1);
  WorldScratch scratch(h.model);
  for (int tick = 0; tick < 60; ++tick) step(h.model, h.state, scratch);
  Heap snapshot = h;
  WorldScratch fresh(h.model);
  for (int tick = 0; tick < 20; ++tick) {
    step(h.model, h.state, scratch);
    step(snapshot.model, snapshot.state, fresh);
  }
  EXPECT_EQ(hashOf(h.state), hashOf(snapshot.state));
}

TEST(BroadPhase, HeapComesToRestWithoutSinking) {
  Heap h = heap(1);
  WorldScratch scratch(h.model);
  for (int tick = 0; tick < 500; ++tick) step(h.model, h.state, scratch);
  double deepest = 0;
  for (const Contact& c : scratch.contacts) deepest = std::min(deepest, c.phi);
  EXPECT_GE(deepest, -22e-6);                        // what the best peer reaches
  EXPECT_LE(kineticEnergy(h.model, h.state), 1e-7);  // 25 balls; 0.4 mm/s each
}

// Two fingers that ask tick by tick, one that stays and one that moves, among balls that creep, drift or jump.
TEST(BroadPhase, RemembersNoBodyTooFewNearAFinger) {
  WorldBuilder builder{WorldOptions{}};
  std::vector<BodyStart> starts;
  for (int k = 0; k < 40; ++k) builder.addBody({"ball", contact::Sphere{0.01}, true, 0.05, kGlass});
  for (int k = 0; k < 2; ++k) builder.addPoint({});
  const WorldModel model = builder.build();
  WorldScratch scratch(model);
  BroadPhase kept(model);
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> way(-1, 1);
  const auto any = [&](double size) {
    return Vec3(size * way(generator), size * way(generator), size * way(generator));
  };
  std::vector<Vec3> speeds;
  for (BodyScratch& body : scratch.bodies) {
    body.X_WI_mid.p = any(0.1);
    speeds.push_back(any(2e-4));
  }
  Vec3 finger = Vec3::Zero();
  int found = 0;
  for (int tick = 0; tick < 600; ++tick) {
    for (std::size_t k = 0; k < scratch.bodies.size(); ++k) {
      Vec3& p = scratch.bodies[k].X_WI_mid.p;
      p += speeds[k];
      if (p.norm() > 0.1) speeds[k] = -2e-4 * p.normalized();
    }
    if (tick % 97 == 0) scratch.bodies[static_cast<std::size_t>(tick) % 40].X_WI_mid.p = any(0.05);
    finger += any(5e-4);
    BroadPhase fresh(model);
    kept.candidates(model, scratch);
    fresh.candidates(model, scratch);
    for (const Vec3& place : {Vec3(Vec3::Zero()), finger}) {
      const std::span<const int> near = kept.bodiesNear(place, 0.01), all = fresh.bodiesNear(place, 0.01);
      EXPECT_TRUE(std::equal(near.begin(), near.end(), all.begin(), all.end())) << tick;
      found += static_cast<int>(all.size());
    }
  }
  EXPECT_GT(found, 600);  // there was something to miss
}

TEST(BroadPhase, ExcludedPairsNeverTouch) {
  WorldBuilder builder{WorldOptions{}};
  std::vector<BodyStart> starts;
  for (int k = 0; k < 20; ++k) {
    builder.addBody({"ball", contact::Sphere{0.01}, true, 0.05, kGlass});
    starts.push_back({{Quat::Identity(), Vec3(0.001 * k, 0, 0)}, Vec3::Zero(), Vec3::Zero()});
    for (int b = 0; b < k; ++b) builder.excludePair(k, b);
  }
  const WorldModel model = builder.build();
  WorldState state = makeState(model, starts, {});
  WorldScratch scratch(model);
  EXPECT_EQ(step(model, state, scratch).contacts, 0);
}

}  // namespace
}  // namespace pincer::engine
