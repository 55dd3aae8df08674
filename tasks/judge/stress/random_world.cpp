#include "pincer/tasks/judge/stress/random_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/pair_query.h"
#include "pincer/contact/polytope.h"
#include "pincer/tasks/judge/stress/random_tree.h"

namespace pincer::tasks {
namespace {

// Each draw is a statement of its own: the order in which arguments are evaluated is the compiler's,
// and a seed must mean the same world to all. It is the order that g++ takes, last arguments first:
// tests hold on to seeds that once failed so.
double logUniform(Random& random, double low, double high) { return low * math::pow(high / low, random.uniform()); }

double friction(Random& random) { return random.below(8) == 0 ? 0 : random.uniform(0, 5); }

Vec3 anyVector(Random& random, double low, double high) {
  Vec3 v;
  for (int i = 2; i >= 0; --i) v[i] = random.uniform(low, high);
  return v;
}

Quat anyRotation(Random& random) {
  const Vec3 a = random.normal3();
  const Vec3 b = random.normal3();
  return Quat(a.x(), a.y(), a.z(), b.x()).normalized();
}

contact::Shape anyShape(Random& random, double size) {
  switch (random.below(3)) {
    case 0:
      return contact::Sphere{size / 2};
    case 1:
      return contact::Box{size / 2 * anyVector(random, 0.3, 1)};
    default:
      return contact::Capsule{size / 4, size / 4};
  }
}

// A flat block with rounded edges, 5 to 40 mm wide.
contact::PadTip anyPad(Random& random) {
  const double width = logUniform(random, 5e-3, 40e-3);
  const Vec3 half = 0.5 * width * anyVector(random, 0.2, 1);
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z()});
  return {contact::Polytope::hullOf(corners, "pad"), 5e-4};
}

// Collects what a class draws, and builds the model from it.
class Draft {
 public:
  Draft(StressClass kind, Random& random) : kind_(kind), random_(random) {
    options.h = kind == StressClass::kTick || kind == StressClass::kCoarse ? logUniform(random, 1e-4, 1e-2) : 1e-3;
    options.max_contacts = 128;
    material.mu_s = friction(random);
    material.mu_d = material.mu_s * random.uniform(0.5, 1);
    material.torsion_radius = random.below(3) == 0 ? random.uniform(0, 5e-3) : 0;
    draw();
  }

  engine::WorldOptions options;
  engine::Material material;
  std::vector<engine::BodySpec> bodies;
  std::vector<engine::BodyStart> starts;
  std::vector<grasp::FingerModel> fingers;
  std::vector<Vec3> devices;
  std::vector<engine::JointModel> joints;
  std::vector<engine::DriveModel> drives;
  double allowed_lift = 0;

 private:
  void draw() {
    addPlane(Pose{});
    switch (kind_) {
      case StressClass::kMassRatio:
        return drawStack();
      case StressClass::kRedundant:
        return drawCorner();
      case StressClass::kOverlap:
        return drawOverlap();
      case StressClass::kSpin:
        return drawFalling(2, 500, logUniform(random_, 1e-2, 0.3));
      case StressClass::kTick:
        return drawFalling(3, 20, logUniform(random_, 1e-2, 0.1));
      case StressClass::kInertia:
        return drawSlivers();
      case StressClass::kHeap:
        return drawFalling(6 + static_cast<int>(random_.below(7)), 10, 0.05);
      case StressClass::kWalls:
        return drawWall(logUniform(random_, 1, 1e3));
      case StressClass::kHulls:
        return drawHulls();
      case StressClass::kHit:
        drawWall(1);
        return drawHit();
      case StressClass::kCompounds:
        return drawCompounds();
      case StressClass::kJoints:
        return drawJoints();
      default:
        return drawHeld();
    }
  }

  void addPlane(const Pose& X) {
    bodies.push_back({fmt::format("plane{}", bodies.size()), contact::HalfSpace{}, false, 0, material});
    starts.push_back({X, Vec3::Zero(), Vec3::Zero()});
  }

  engine::BodyStart& add(contact::Shape shape, double mass, const Pose& X) {
    bodies.push_back({fmt::format("body{}", bodies.size()), std::move(shape), true, mass, material});
    starts.push_back({X, Vec3::Zero(), Vec3::Zero()});
    return starts.back();
  }

  void drawStack() {
    const double edge = logUniform(random_, 0.01, 0.1);
    const int count = 2 + static_cast<int>(random_.below(4));
    double z = 0;
    for (int i = 0; i < count; ++i) {
      const double x = edge * random_.uniform(-0.1, 0.1);
      const double y = edge * random_.uniform(-0.1, 0.1);
      const double mass = logUniform(random_, 1e-4, 100);
      add(contact::Box{Vec3::Constant(edge / 2)}, mass, {Quat::Identity(), {x, y, z + edge / 2}});
      z += edge;
    }
  }

  // A trihedral corner whose planes lean by up to 0.3 rad.
  void drawCorner() {
    for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
      const Vec3 leaning = (n + 0.3 * Vec3(0, 0, random_.uniform(0, 1))).normalized();
      addPlane({Quat(frameFromNormal(leaning)).normalized(), Vec3::Zero()});
    }
    const double size = logUniform(random_, 0.01, 0.1);
    const int count = 1 + static_cast<int>(random_.below(2));
    for (int i = 0; i < count; ++i) {
      const double mass = logUniform(random_, 1e-3, 1);
      const double height = random_.uniform(0.5, 1);
      const double depth = random_.uniform(0.5, 1);
      engine::BodyStart& start = add(contact::Box{size / 2 * Vec3(1, depth, height)}, mass,
                                     {Quat::Identity(), size * Vec3(0.9, 0.9, 0.7 + 1.3 * i)});
      start.v_W = Vec3(-1, -1, -1) * random_.uniform(0, 1);
    }
  }

  void drawOverlap() {
    const int count = 1 + static_cast<int>(random_.below(4));
    for (int i = 0; i < count; ++i) {
      const double size = logUniform(random_, 5e-3, 0.2);
      const double mass = logUniform(random_, 1e-4, 100);
      const Quat q = anyRotation(random_);
      const double z = random_.uniform(0, 0.6);
      const double y = random_.uniform(0, 0.5);
      const double x = random_.uniform(0, 0.5);
      add(anyShape(random_, size), mass, {q, size * Vec3(x, y, z)});
    }
    double mass = 0, reach = 0;
    for (std::size_t i = 1; i < bodies.size(); ++i) {
      mass += bodies[i].mass;
      reach += 2 * contact::boundingRadius(bodies[i].shape);
    }
    allowed_lift = mass * options.gravity_W.norm() * reach;
  }

  void drawFalling(int count, double spin, double size) {
    double z = size;
    for (int i = 0; i < count; ++i) {
      const double y = 0.3 * size * random_.uniform(-1, 1);
      const double x = 0.3 * size * random_.uniform(-1, 1);
      const Quat q = anyRotation(random_);
      const double mass = logUniform(random_, 1e-3, 1);
      const double own_size = size * random_.uniform(0.5, 1);
      engine::BodyStart& start = add(anyShape(random_, own_size), mass, {q, Vec3(x, y, z)});
      start.v_W = 0.5 * random_.normal3();
      start.w_W = anySpin(spin);
      z += 1.8 * size;
    }
  }

  // Shapes about a body's origin, which overlap or leave gaps; they reach 0.95 sizes from it at most.
  std::vector<engine::ColliderSpec> anyParts(double size) {
    std::vector<engine::ColliderSpec> parts;
    const int count = 2 + static_cast<int>(random_.below(4));
    for (int i = 0; i < count; ++i) {
      const Quat q = anyRotation(random_);
      const Vec3 p = 0.25 * size * anyVector(random_, -1, 1);
      parts.push_back({fmt::format("part{}", i), anyShape(random_, size * random_.uniform(0.2, 0.6)), Pose{q, p}});
    }
    return parts;
  }

  void drawCompounds() {
    constexpr double kSize = 0.06;  // [m]
    drawFalling(3 + static_cast<int>(random_.below(4)), 10, kSize);
    // so that no two overlap at the start
    for (std::size_t i = 1; i < bodies.size(); ++i) bodies[i].shapes = anyParts(0.75 * kSize);
  }

  void drawSlivers() {
    double z = 0;
    for (int i = 0; i < 2; ++i) {
      const double length = logUniform(random_, 0.02, 0.5);
      const double a = length * logUniform(random_, 1e-3, 1);
      const double b = length * logUniform(random_, 1e-3, 1);
      const double reach = 0.5 * Vec3(length, a, b).norm();
      const Quat q = anyRotation(random_);
      const double mass = logUniform(random_, 1e-3, 1);
      engine::BodyStart& start = add(contact::Box{Vec3(length, a, b) / 2}, mass, {q, Vec3(0, 0, z + 1.1 * reach)});
      z += 2.2 * reach;
      start.w_W = anySpin(50);
    }
  }

  // Up to five bricks by eight, each row shifted.
  void drawWall(double mass_ratio) {
    options.max_contacts = 0;  // as many as there may be
    material.mu_s = material.mu_d = random_.uniform(0.3, 0.9);
    material.torsion_radius = 0;
    bodies.front().material = material;
    const int columns = 1 + static_cast<int>(random_.below(5)), rows = 1 + static_cast<int>(random_.below(8));
    const double height = logUniform(random_, 5e-3, 0.1),
                 jitter = random_.below(3) == 0 ? 0 : logUniform(random_, 1e-7, 1e-4);
    heading_ = quatFromRotationVector(random_.uniform(0, M_PI) * Vec3::UnitZ());
    for (int row = 0; row < rows; ++row) {
      double x = height * random_.uniform(0, 0.5);
      for (int column = 0; column < columns; ++column) {
        const double length = height * random_.uniform(1.5, 2.5);
        const Vec3 off = jitter * anyVector(random_, 0, 1);
        const double mass = 1e3 * height * height * length * math::pow(mass_ratio, random_.uniform(-0.5, 0.5));
        add(contact::Box{0.5 * Vec3(length, height, height)}, mass,
            {heading_, heading_ * (Vec3(x + 0.5 * length, 0, (row + 0.5) * height) + off)});
        x += length + 0.02 * height;
      }
    }
    allowed_lift = liftOutOf(2 * jitter);
    wall_ = {.length = 2 * columns * height, .height = rows * height, .brick = height};
  }

  // The energy that pushing out an overlap of so much under every body may add, all of them on top of each other [J].
  double liftOutOf(double depth) const {
    double lift = 0, mass = 0;
    for (std::size_t i = bodies.size(); i-- > 1;) {
      mass += bodies[i].mass;
      lift += mass * options.gravity_W.norm() * depth;
    }
    return lift;
  }

  void drawHit() {
    const double radius = wall_.brick * random_.uniform(0.5, 1.5),
                 mass = 4e3 * radius * radius * radius * logUniform(random_, 1, 100);
    const double x = wall_.length * random_.uniform(0, 1), z = std::max(radius, wall_.height * random_.uniform(0, 1));
    const Vec3 from(x, -radius - wall_.brick, z), way(0, logUniform(random_, 0.1, 10), 0);
    add(contact::Sphere{radius}, mass, {heading_, heading_ * from}).v_W = heading_ * way;
  }

  void drawHulls() {
    constexpr int kCorners = 14;  // points that a hull is made of; chosen
    options.max_contacts = 0;
    const double size = logUniform(random_, 5e-3, 0.05);
    for (const Vec3& n : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
      addPlane({Quat::FromTwoVectors(Vec3::UnitZ(), n), -2.5 * size * n});
    const int count = 5 + static_cast<int>(random_.below(8));
    for (int i = 0; i < count; ++i) {
      std::vector<Vec3> corners;
      const Vec3 half = size * anyVector(random_, 0.6, 1);
      for (int k = 0; k < kCorners; ++k) corners.push_back(random_.normal3().normalized().cwiseProduct(half));
      const Quat q = anyRotation(random_);
      const double x = size * (i % 2 == 0 ? 1.1 : -1.1), y = size * (i / 2 % 2 == 0 ? 1.1 : -1.1),
                   z = size * (1.1 + 2.2 * (i / 4));
      add(contact::Convex{contact::Polytope::hullOf(corners, "hull")}, 4e3 * half.prod(), {q, Vec3(x, y, z)});
    }
  }

  Vec3 anySpin(double fastest) {
    const Vec3 axis = random_.normal3().normalized();
    return random_.uniform(0, fastest) * axis;
  }

  void drawHeld() {
    const double size = logUniform(random_, 0.01, 0.1);
    const Quat q = anyRotation(random_);
    const double mass = logUniform(random_, 1e-3, 1);
    add(anyShape(random_, size), mass, {q, Vec3(0, 0, size)});
    const int count = 2 + static_cast<int>(random_.below(3));
    for (int i = 0; i < count; ++i) {
      grasp::FingerModel finger;
      finger.name = fmt::format("finger{}", i);
      finger.coupling.mass = random_.below(2) == 0 ? 0 : logUniform(random_, 1e-3, 0.1);
      finger.coupling.stiffness =
          Vec3::Constant(kind_ == StressClass::kStiffness ? logUniform(random_, 10, 1e6) : 1000);
      finger.coupling.damping = Vec3::Constant(random_.uniform(0, 10));
      if (kind_ == StressClass::kPads || (kind_ == StressClass::kCoarse && random_.below(2) == 0)) {
        finger.coupling.stiffness = Vec3::Constant(logUniform(random_, 10, 1e4));
        finger.shape = anyPad(random_);
      }
      fingers.push_back(finger);
      const double angle = 2 * M_PI * i / count;
      devices.push_back(Vec3(math::cos(angle), math::sin(angle), 0) * (size + 0.01) + Vec3(0, 0, size));
    }
  }

  void drawJoints() {
    options.max_contacts = 0;
    options.h = logUniform(random_, 1e-4, 4e-3);
    const int before = static_cast<int>(bodies.size());
    RandomTree tree = drawTree(random_, material);
    bodies.insert(bodies.end(), tree.bodies.begin(), tree.bodies.end());
    starts.insert(starts.end(), tree.starts.begin(), tree.starts.end());
    joints = std::move(tree.joints);
    for (engine::JointModel& joint : joints) {
      joint.a += before;
      if (joint.b >= 0) joint.b += before;
    }
    drives = std::move(tree.drives);
    if (!drives.empty()) allowed_lift = std::numeric_limits<double>::infinity();
  }

  struct Wall {
    double length, height, brick;  // [m]
  };

  StressClass kind_;
  Random& random_;
  Quat heading_ = Quat::Identity();
  Wall wall_{};
};

}  // namespace

StressWorld::StressWorld(StressClass kind, std::uint64_t seed, int threads)
    : kind_(kind), random_(seedFor(seed, static_cast<std::uint64_t>(kind))) {
  Draft draft(kind, random_);
  draft.options.threads = threads;
  engine::WorldBuilder builder(draft.options);
  for (const engine::BodySpec& body : draft.bodies) builder.addBody(body);
  for (const engine::JointModel& joint : draft.joints) builder.addJoint(joint);
  for (const engine::DriveModel& drive : draft.drives) builder.addDrive(drive);
  model = grasp::buildGrasp(std::move(builder), std::move(draft.fingers));
  starts = std::move(draft.starts);
  allowed_lift = draft.allowed_lift;
  devices_ = std::move(draft.devices);
  inputs_.resize(devices_.size());
  constexpr double kDeepest = 0.035;  // a pad may begin that deep in the object: half of the widest's diagonal [m]
  reach_.assign(devices_.size(), kind == StressClass::kPads || kind == StressClass::kCoarse ? kDeepest : 0);
  fastest_.resize(devices_.size());
  for (std::size_t i = 0; i < devices_.size(); ++i) inputs_[i].p_WF = devices_[i];
}

std::span<const grasp::FingerInput> StressWorld::nextInputs() {
  drawControls(random_, model.world.drives, controls_);
  const double h = model.world.options.h;
  const Vec3 middle(0, 0, devices_.empty() ? 0 : devices_[0].z());
  const double closing = std::min(1.0, static_cast<double>(++tick_) / 100);
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    Vec3 p = devices_[i] + closing * 0.6 * (middle - devices_[i]);
    if (kind_ == StressClass::kTeleport && random_.below(20) == 0) p += 0.05 * anyVector(random_, -1, 1);
    if (kind_ == StressClass::kNoise || kind_ == StressClass::kCoarse) p += 1e-3 * anyVector(random_, -1, 1);
    inputs_[i].v_WF = (p - inputs_[i].p_WF) / h;
    inputs_[i].p_WF = p;
    reach_[i] = std::max(reach_[i], (p - devices_[i]).norm());
    fastest_[i] = std::max(fastest_[i], inputs_[i].v_WF.norm());
  }
  return inputs_;
}

double StressWorld::mostWork() const {
  double work = 0;
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const engine::DrivenPointModel& c = model.fingers[i].coupling;
    work += reach_[i] * (c.stiffness.maxCoeff() * reach_[i] + c.damping.maxCoeff() * fastest_[i]);
  }
  return work;
}

}  // namespace pincer::tasks
