// Bodies that come to rest on each other.
#include <algorithm>
#include <cmath>
#include <memory>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"

namespace pincer::tasks {
namespace {

constexpr double kCubeHalf = 0.02;  // [m]

BenchWorld columnWorld(const std::vector<double>& masses) {
  BenchWorld world;
  world.bodies = {benchFloor()};
  double z = kCubeHalf;
  for (const double mass : masses) {
    world.bodies.push_back(benchBox(mass, Vec3::Constant(kCubeHalf), {0, 0, z}));
    z += 2 * kCubeHalf;
  }
  return world;
}

double placeInColumn(int body) { return kCubeHalf * (2 * body - 1); }

// True if every cube is near its place.
bool columnStands(int cubes, BenchEngine& e) {
  for (int i = 1; i <= cubes; ++i) {
    if (!((e.motion(i).X_WB.p - Vec3(0, 0, placeInColumn(i))).norm() < kCubeHalf)) return false;
  }
  return true;
}

// How deep two neighbours overlap at most, at any time.
BenchScene ratioScene(const std::string& name, const std::vector<double>& masses, double seconds, double cost_bound) {
  BenchScene s{.name = name,
               .metric = "overlap, largest",
               .unit = "um",
               .duration = seconds,
               .floor = 1e-9,
               .error_bound = 1,
               .cost_bound = cost_bound};
  s.steps = {4e-3, 2e-3, 1e-3, 5e-4};
  s.world = columnWorld(masses);
  const int cubes = static_cast<int>(masses.size());
  s.judge = [=] {
    const auto worst = std::make_shared<double>(0);
    BenchJudge judge;
    judge.look = [=](double, BenchEngine& e) {
      double below = -kCubeHalf;
      for (int i = 1; i <= cubes; ++i) {
        const double z = e.motion(i).X_WB.p.z();
        *worst = std::max(*worst, below + 2 * kCubeHalf - z);
        below = z;
      }
      return columnStands(cubes, e);
    };
    judge.verdict = [=](BenchEngine& e) {
      return columnStands(cubes, e) ? BenchVerdict{1e6 * *worst} : BenchVerdict{.failure = "falls"};
    };
    return judge;
  };
  return s;
}

// How far any cube of ten moves after the first second.
BenchScene columnScene() {
  constexpr int kCubes = 10;  // the stack of ten
  BenchScene s{.name = "more/stack-of-ten",
               .metric = "moved from 1 to 5 s, largest",
               .unit = "um",
               .duration = 5,
               .floor = 1e-10};
  s.steps = {4e-3, 2e-3, 1e-3, 5e-4};
  s.world = columnWorld(std::vector<double>(kCubes, 0.1));
  s.judge = [] {
    const auto settled = std::make_shared<std::vector<Vec3>>();
    BenchJudge judge;
    judge.look = [=](double t, BenchEngine& e) {
      if (t < 1 - 1e-9) return true;
      if (settled->empty()) {
        for (int i = 1; i <= kCubes; ++i) settled->push_back(e.motion(i).X_WB.p);
      }
      return columnStands(kCubes, e);
    };
    judge.verdict = [=](BenchEngine& e) {
      if (!columnStands(kCubes, e)) return BenchVerdict{.failure = "falls"};
      double moved = 0;
      for (int i = 1; i <= kCubes; ++i)
        moved = std::max(moved, (e.motion(i).X_WB.p - (*settled)[static_cast<std::size_t>(i - 1)]).norm());
      return BenchVerdict{1e6 * moved};
    };
    return judge;
  };
  return s;
}

constexpr double kMarble = 0.01, kSpacing = 0.0215;  // [m]

BenchBody wallOfCrate(const Vec3& n_W, const Vec3& p_W) {
  BenchBody wall = benchFloor();
  wall.X_WB = {Quat::FromTwoVectors(Vec3::UnitZ(), n_W), p_W};
  return wall;
}

// Uniform in +-0.5 mm: a linear congruential sequence (D. E. Knuth, The Art of Computer
// Programming 2, 3rd ed., 1997, 3.3.4, line 26).
struct Jitter {
  std::uint64_t state = 7;
  double next() {
    state = 6364136223846793005u * state + 1442695040888963407u;
    return 1e-3 * (static_cast<double>(state >> 11) * 0x1p-53 - 0.5);
  }
};

BenchWorld crateWorld(int marbles, int side) {
  const double length = side * kSpacing + 0.002;
  BenchWorld world;
  world.bodies = {benchFloor(), wallOfCrate(Vec3::UnitX(), Vec3::Zero()), wallOfCrate(-Vec3::UnitX(), {length, 0, 0}),
                  wallOfCrate(Vec3::UnitY(), Vec3::Zero()), wallOfCrate(-Vec3::UnitY(), {0, length, 0})};
  Jitter jitter;
  for (int i = 0; i < marbles; ++i) {
    const int layer = i / (side * side), row = i / side % side, column = i % side;
    const double x = jitter.next(), y = jitter.next(), z = jitter.next();
    const Vec3 p(0.001 + kSpacing * (column + 0.5) + x, 0.001 + kSpacing * (row + 0.5) + y,
                 0.0112 + kSpacing * layer + z);
    world.bodies.push_back(benchBall(0.05, kMarble, p));
  }
  return world;
}

// Deepest overlap at the end [m]; NaN if a marble has left the crate.
double overlapInCrate(int marbles, double length, BenchEngine& e) {
  std::vector<Vec3> p;
  double deepest = 0;
  for (int i = 0; i < marbles; ++i) {
    p.push_back(e.motion(5 + i).X_WB.p);
    const Vec3& q = p.back();
    if (!(q.minCoeff() > 0 && q.x() < length && q.y() < length && q.z() < 2)) return std::nan("");
    for (const double wall : {q.z(), q.x(), length - q.x(), q.y(), length - q.y()})
      deepest = std::max(deepest, kMarble - wall);
    for (int k = 0; k < i; ++k) deepest = std::max(deepest, 2 * kMarble - (q - p[static_cast<std::size_t>(k)]).norm());
  }
  return deepest;
}

BenchScene crateScene(int marbles, int side, const std::vector<double>& steps, double cost_bound) {
  BenchScene s{.name = "s8/spheres-" + std::to_string(marbles),
               .metric = "overlap at 2 s, largest",
               .unit = "um",
               .duration = 2,
               .floor = 1e-9,
               .error_bound = 22,
               .cost_bound = cost_bound,
               .steps = steps};
  s.world = crateWorld(marbles, side);
  s.even = false;  // a heap grows
  s.patience = marbles < 1000 ? 12 : 60;
  s.judge = [=] {
    return judgeOfEnd([=](BenchEngine& e) {
      const double overlap = overlapInCrate(marbles, side * kSpacing + 0.002, e);
      return std::isfinite(overlap) ? BenchVerdict{1e6 * overlap} : BenchVerdict{.failure = "a sphere leaves the box"};
    });
  };
  return s;
}

}  // namespace

std::vector<BenchScene> benchRestingScenes(bool whole) {
  std::vector<BenchScene> scenes = {ratioScene("s6/mass-ratio-1e4", {0.01, 0.1, 1, 10, 100}, 5, 25),
                                    ratioScene("more/mass-ratio-pair", {0.001, 10}, 2, kInfinity),
                                    columnScene(),
                                    crateScene(1, 1, {4e-3, 2e-3, 1e-3, 5e-4}, kInfinity),
                                    crateScene(10, 2, {4e-3, 2e-3, 1e-3, 5e-4}, kInfinity),
                                    crateScene(100, 5, {2e-3, 1e-3}, kInfinity)};
  if (whole) scenes.push_back(crateScene(1000, 10, {1e-3}, 1500));
  return scenes;
}

}  // namespace pincer::tasks
