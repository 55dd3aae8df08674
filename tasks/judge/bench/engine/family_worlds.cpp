#include "pincer/tasks/judge/bench/engine/family_worlds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/polytope.h"

namespace pincer::tasks {
namespace {

// Uniform numbers: a linear congruential sequence (D. E. Knuth, The Art of Computer
// Programming 2, 3rd ed., 1997, 3.3.4, line 26).
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : state_(seed) {}
  double operator()(double low, double high) {
    state_ = 6364136223846793005u * state_ + 1442695040888963407u;
    return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  Vec3 within(double half) {
    const double x = (*this)(-half, half), y = (*this)(-half, half), z = (*this)(-half, half);
    return {x, y, z};
  }
  // On the unit sphere, even.
  Vec3 direction() {
    for (;;) {
      const Vec3 v = within(1);
      if (v.squaredNorm() > 1e-2 && v.squaredNorm() <= 1) return v.normalized();
    }
  }

 private:
  std::uint64_t state_;
};

engine::Material rough(double mu) {
  engine::Material material;
  material.mu_s = material.mu_d = mu;
  return material;
}

class WorldMaker {
 public:
  WorldMaker(double mu, bool sleep) {
    options_.sleep = sleep;
    bench_.mu = mu;
    add("floor", contact::HalfSpace{}, 0, Vec3::Zero());
  }
  // Of no mass: it never moves.
  void add(const std::string& name, const contact::Shape& shape, double mass, const Vec3& p,
           const Quat& q = Quat::Identity(), const Vec3& v = Vec3::Zero()) {
    names_.push_back(name);
    bench_.bodies.push_back({shape, mass > 0 ? BenchKind::kFree : BenchKind::kFixed, mass, {q, p}, v});
  }
  // Four walls around the z axis, `half` from it.
  void addCrate(double half) {
    for (const Vec3& n : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
      add(fmt::format("side{}", names_.size()), contact::HalfSpace{}, 0, -half * n,
          Quat::FromTwoVectors(Vec3::UnitZ(), n));
  }
  FamilyWorld make() {
    engine::WorldBuilder builder(options_);
    std::vector<engine::BodyStart> starts;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const BenchBody& body = bench_.bodies[i];
      builder.addBody({names_[i], body.shape, body.mass > 0, body.mass, rough(bench_.mu)});
      starts.push_back({body.X_WB, body.v_W, body.w_W});
    }
    engine::WorldModel model = builder.build();
    engine::WorldState state = engine::makeState(model, starts, {});
    for (std::size_t i = 0; i < names_.size(); ++i) centre(names_[i], model.bodies[i].X_BI.p, bench_.bodies[i]);
    return {std::move(model), std::move(state), std::move(bench_)};
  }

 private:
  // A hull's frame at its centre of mass p_B.
  static void centre(const std::string& name, const Vec3& p_B, BenchBody& body) {
    const auto* hull = std::get_if<contact::Convex>(&body.shape);
    if (!hull) return;
    std::vector<Vec3> corners = hull->hull->vertices();
    for (Vec3& corner : corners) corner -= p_B;
    body.shape = contact::Convex{contact::Polytope::hullOf(corners, name)};
    body.X_WB.p = body.X_WB * p_B;
  }

  engine::WorldOptions options_;
  std::vector<std::string> names_;
  BenchWorld bench_;
};

}  // namespace

FamilyWorld wallWorld(const WallSpec& spec) {
  // Of a brick, and between two [m]; [kg].
  constexpr double kLength = 0.04, kWidth = 0.02, kHeight = 0.02, kApart = 1e-3, kMass = 0.05;
  const Quat q = quatFromRotationVector(spec.heading * Vec3::UnitZ());
  Uniform uniform(spec.seed);
  WorldMaker maker(spec.mu, spec.sleep);
  const contact::Box brick{0.5 * Vec3(kLength, kWidth, kHeight)};
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      const double x = column * (kLength + kApart) + (row % 2 == 1 ? 0.25 * kLength : 0);
      const Vec3 p = Vec3(x, 0, (row + 0.5) * kHeight) + uniform.within(spec.jitter);
      const double mass = kMass * math::pow(spec.mass_ratio, uniform(-0.5, 0.5));
      maker.add(fmt::format("brick{}_{}", row, column), brick, mass, q * p, q);
    }
  }
  if (spec.hit_speed > 0) {
    constexpr double kRadius = 0.05, kBallMass = 10;  // [m], [kg]
    const Vec3 p(0.5 * spec.columns * (kLength + kApart), -0.3, std::max(kRadius, 0.5 * spec.rows * kHeight));
    maker.add("ball", contact::Sphere{kRadius}, kBallMass, q * p, q, q * Vec3(0, spec.hit_speed, 0));
  }
  return maker.make();
}

namespace {

// The i-th of what falls in layers of nine into a crate of half 60 mm.
Vec3 placeAbove(int i) {
  constexpr int kPerRow = 3;
  constexpr double kSpacing = 0.038;
  const int layer = i / (kPerRow * kPerRow), row = i / kPerRow % kPerRow, column = i % kPerRow;
  return {kSpacing * (column - 1), kSpacing * (row - 1), 0.03 + kSpacing * layer};
}

}  // namespace

FamilyWorld hullWorld(int hulls, std::uint64_t seed) {
  constexpr int kCorners = 20;                      // points that a hull is made of, chosen
  constexpr double kDensity = 1000, kFilled = 0.7;  // of the ellipsoid's volume, about
  Uniform uniform(seed);
  WorldMaker maker(0.5, false);
  maker.addCrate(0.06);
  for (int i = 0; i < hulls; ++i) {
    const Vec3 half = Vec3::Constant(0.015) + uniform.within(0.003);
    std::vector<Vec3> corners;
    for (int k = 0; k < kCorners; ++k) corners.push_back(uniform.direction().cwiseProduct(half));
    const Vec3 axis = uniform.direction();
    const Quat q = quatFromRotationVector(uniform(0, 3) * axis);
    const std::string name = fmt::format("hull{}", i);
    maker.add(name, contact::Convex{contact::Polytope::hullOf(corners, name)}, kFilled * kDensity * 4.19 * half.prod(),
              placeAbove(i), q);
  }
  return maker.make();
}

namespace {

contact::Shape shapeOf(Falling what, int i) {
  constexpr Falling kByTurns[] = {Falling::kDiscs, Falling::kCapsules, Falling::kCans, Falling::kCubes};
  if (what == Falling::kMixed) return i % 5 == 4 ? contact::Sphere{0.013} : shapeOf(kByTurns[i % 5], i);
  if (what == Falling::kCapsules) return contact::Capsule{0.008, 0.009};
  if (what == Falling::kCans) return contact::Cylinder{0.011, 0.012};
  if (what == Falling::kCubes) return contact::Box{Vec3::Constant(0.01)};
  return contact::Cylinder{0.016, 0.004};
}

}  // namespace

FamilyWorld heapWorld(Falling what, int count, std::uint64_t seed) {
  Uniform uniform(seed);
  WorldMaker maker(0.5, false);
  maker.addCrate(0.06);
  for (int i = 0; i < count; ++i) {
    const Vec3 axis = uniform.direction();
    const Quat q = quatFromRotationVector(uniform(0, 3) * axis);
    maker.add(fmt::format("body{}", i), shapeOf(what, i), 0.02, placeAbove(i) + uniform.within(2e-3), q);
  }
  return maker.make();
}

FamilyWorld ballWorld(int balls, int side, std::uint64_t seed) {
  constexpr double kRadius = 0.01, kSpacing = 0.0215;  // [m]
  Uniform uniform(seed);
  WorldMaker maker(0.5, false);
  maker.addCrate(0.5 * side * kSpacing + 0.001);
  for (int i = 0; i < balls; ++i) {
    const int layer = i / (side * side), row = i / side % side, column = i % side;
    const Vec3 place(column - 0.5 * (side - 1), row - 0.5 * (side - 1), layer + 0.55);
    maker.add(fmt::format("ball{}", i), contact::Sphere{kRadius}, 0.05, kSpacing * place + uniform.within(5e-4));
  }
  return maker.make();
}

namespace {

struct Peg {
  int boxes = 8;
  double radius = 0.01, half_length = 0.03;  // [m]
  double play = 1e-4;                        // [m]
  double mu = 0.2;                           // [-]
  double tilt = 0, heading = 0;              // about an axis in the plane, at that angle to x [rad]
  double off = 0;                            // along x [m]
};

FamilyWorld pegWorldOf(const Peg& peg) {
  WorldMaker maker(peg.mu, false);
  constexpr double kBottom = 0.015;  // the floor lies below the hole [m]
  const double hole = peg.radius + 0.5 * peg.play;
  for (int k = 0; k < peg.boxes; ++k) {
    const Quat q = quatFromRotationVector(2 * M_PI / peg.boxes * k * Vec3::UnitZ());
    maker.add(fmt::format("rim{}", k), contact::Box{{0.01, 0.02, 0.02}}, 0, q * Vec3(hole + 0.01, 0, kBottom + 0.02),
              q);
  }
  const Vec3 axis(math::cos(peg.heading), math::sin(peg.heading), 0);
  maker.add("peg", contact::Cylinder{peg.radius, peg.half_length}, 0.1,
            Vec3(peg.off, 0, kBottom + 0.04 + peg.half_length + 0.001), quatFromRotationVector(peg.tilt * axis));
  return maker.make();
}

}  // namespace

FamilyWorld pegWorld(double play, double tilt) { return pegWorldOf({.play = play, .tilt = tilt}); }

FamilyWorld randomPegWorld(std::uint64_t seed) {
  Uniform uniform(seed);
  Peg peg;
  peg.boxes = 6 + static_cast<int>(uniform(0, 7));
  peg.radius = uniform(0.006, 0.015);
  peg.half_length = peg.radius * uniform(1.5, 4);
  peg.play = 3e-5 * math::pow(20, uniform(0, 1));
  peg.mu = uniform(0.1, 0.8);
  peg.tilt = uniform(0, 0.03);
  peg.heading = uniform(0, 2 * M_PI);
  peg.off = peg.play * uniform(-0.4, 0.4);
  return pegWorldOf(peg);
}

}  // namespace pincer::tasks
