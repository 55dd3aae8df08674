#include "pincer/tasks/lab/participants/random.h"

#include <bit>
#include <cmath>
#include <numbers>

namespace pincer::tasks {
namespace {

std::uint64_t splitmix(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

std::uint64_t seedFor(std::uint64_t seed, std::uint64_t part) {
  std::uint64_t state = seed;
  state = splitmix(state) ^ part;
  return splitmix(state);
}

Random::Random(std::uint64_t seed) {
  for (auto& word : state_) word = splitmix(seed);
}

std::uint64_t Random::bits() {
  auto& s = state_;
  const std::uint64_t result = std::rotl(s[0] + s[3], 23) + s[0];
  const std::uint64_t t = s[1] << 17;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = std::rotl(s[3], 45);
  return result;
}

double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Random::normal() {
  const double u1 = 1 - uniform();
  const double u2 = uniform();
  return std::sqrt(-2 * math::log(u1)) * math::cos(2 * std::numbers::pi * u2);
}

// One statement per draw: the order in which a call's arguments are evaluated is the compiler's choice.
Vec2 Random::normal2() {
  const double x = normal();
  const double y = normal();
  return {x, y};
}

Vec3 Random::normal3() {
  const double x = normal();
  const double y = normal();
  const double z = normal();
  return {x, y, z};
}

std::uint64_t Random::below(std::uint64_t bound) {
  // 2^64 mod bound: values under it would favour the small results
  const std::uint64_t threshold = (0 - bound) % bound;
  std::uint64_t value = bits();
  while (value < threshold) value = bits();
  return value % bound;
}

}  // namespace pincer::tasks
