// family_worlds: worlds by families and sizes: walls of bricks, heaps of hulls, discs and balls, pegs in holes.
// World frame W, z up; body 0 is the floor.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/engine/step.h"
#include "pincer/tasks/judge/bench/engine/bench_world.h"

namespace pincer::tasks {

struct FamilyWorld {
  engine::WorldModel model;
  engine::WorldState state;
  BenchWorld bench;  // the same, as other engines are told it; hulls about their centres of mass
};

// Bricks of 40 x 20 x 20 mm and 50 g, every other row shifted by a quarter of a brick, 1 mm apart along a row.
struct WallSpec {
  int columns = 1, rows = 1;
  double mu = 0.5;         // [-]
  double jitter = 0;       // of every brick's place, at most [m]
  double heading = 0;      // of the wall about the vertical [rad]
  double mass_ratio = 1;   // of the heaviest to the lightest, at most [-]; the mean is 50 g
  double hit_speed = 0;    // of a ball of 10 kg across the wall [m/s]; 0: none
  std::uint64_t seed = 1;  // of jitter and masses
  bool sleep = false;
};
FamilyWorld wallWorld(const WallSpec& spec);

// Hulls of 20 corners in random directions on ellipsoids of half axes 12 to 18 mm, of water's density, fall in layers
// of nine into a box of 120 x 120 mm; mu 0.5.
FamilyWorld hullWorld(int hulls, std::uint64_t seed);

// Discs of 32 x 8 mm, capsules of 16 x 34 mm, cans of 22 x 24 mm, cubes of 20 mm, or balls of 26 mm and all of these by
// turns; 20 g each, turned in any direction, fall in layers of nine into a box of 120 x 120 mm; mu 0.5.
enum class Falling { kDiscs, kCapsules, kCans, kCubes, kMixed };
FamilyWorld heapWorld(Falling what, int count, std::uint64_t seed);

// Balls of 10 mm radius and 50 g fall into a box with room for `side` x `side` of them in a layer; mu 0.5.
FamilyWorld ballWorld(int balls, int side, std::uint64_t seed);

// A cylinder of 10 mm radius, 60 mm long, 100 g, tilted by `tilt` [rad], falls into eight boxes round a hole wider by
// `play` [m]; mu 0.2. The peg is the last body.
FamilyWorld pegWorld(double play, double tilt);

// A cylinder of 6 to 15 mm radius, 1.5 to 4 times as long, tilted by up to 30 mrad in any direction, into six to twelve
// boxes; play 30 to 600 um, evenly in its logarithm, and off the middle by up to .4 of it; mu 0.1 to 0.8.
FamilyWorld randomPegWorld(std::uint64_t seed);

}  // namespace pincer::tasks
