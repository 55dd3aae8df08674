// Bullet 3.24, double precision, for hands instead of metres: margin of boxes 0.5 mm, contacts kept up to 1 mm,
// split impulse, two friction directions, no sleep, no damping; its implicit gyroscopic term. Fingertips and pads
// are bodies with a linear factor per axis.
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include "pincer/contact/polytope.h"
#include "pincer/tasks/judge/peers/adapters.h"

extern btScalar gContactBreakingThreshold;
extern btScalar gDbvtMargin;

namespace pincer::tasks {
namespace {

constexpr btScalar kBoxMargin = 0.0005, kBreaking = 0.001, kTreeBoxMargin = 0.001;  // [m]
constexpr btScalar kHullMargin = 1e-5;  // is added to a hull: not so much that it touches from afar [m]
constexpr int kIterations = 50, kGameIterations = 10;

btVector3 fromEigen(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
btQuaternion fromEigen(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
Vec3 toEigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btDefaultCollisionConstructionInfo largePools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 32768;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 32768;
  return info;
}

std::unique_ptr<btCollisionShape> shapeOf(const BenchBody& body) {
  if (const auto* sphere = std::get_if<contact::Sphere>(&body.shape))
    return std::make_unique<btSphereShape>(sphere->radius);
  if (const auto* box = std::get_if<contact::Box>(&body.shape)) {
    auto shape = std::make_unique<btBoxShape>(fromEigen(box->half));
    shape->setMargin(kBoxMargin);
    return shape;
  }
  if (const auto* capsule = std::get_if<contact::Capsule>(&body.shape)) {
    return std::make_unique<btCapsuleShapeZ>(capsule->radius, 2 * capsule->half_length);
  }
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&body.shape)) {
    auto shape =
        std::make_unique<btCylinderShapeZ>(btVector3(cylinder->radius, cylinder->radius, cylinder->half_length));
    shape->setMargin(kBoxMargin);
    return shape;
  }
  if (const auto* hull = std::get_if<contact::Convex>(&body.shape)) {
    auto shape = std::make_unique<btConvexHullShape>();
    for (const Vec3& corner : hull->hull->vertices()) shape->addPoint(fromEigen(corner), false);
    shape->setMargin(kHullMargin);
    shape->recalcLocalAabb();
    return shape;
  }
  const Vec3 n = body.X_WB.q * Vec3::UnitZ();
  auto plane = std::make_unique<btStaticPlaneShape>(fromEigen(n), n.dot(body.X_WB.p));
  plane->setMargin(0);
  return plane;
}

class BulletEngine : public BenchEngine {
 public:
  BulletEngine(const BenchWorld& world, double h, bool dantzig, int iterations) : world_(world), h_(h) {
    tuneGlobals();
    if (dantzig) {
      solver_ = std::make_unique<btMLCPSolver>(&lcp_);
    } else {
      solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    }
    dynamics_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broad_phase_, solver_.get(), &configuration_);
    dynamics_->setGravity(fromEigen(world.gravity_W));
    btContactSolverInfo& info = dynamics_->getSolverInfo();
    info.m_numIterations = iterations;
    info.m_splitImpulse = 1;
    info.m_splitImpulsePenetrationThreshold = 0;
    info.m_leastSquaresResidualThreshold = 0;
    info.m_restitutionVelocityThreshold = 0;
    info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    for (const BenchBody& body : world_.bodies) add(body);
  }
  BulletEngine(const BulletEngine&) = delete;
  BulletEngine& operator=(const BulletEngine&) = delete;
  ~BulletEngine() override {
    for (const auto& hinge : hinges_) dynamics_->removeConstraint(hinge.get());
    for (const auto& body : bodies_) dynamics_->removeRigidBody(body.get());
  }

  void step() override {
    tuneGlobals();  // pincer's own broad phase has another margin
    const double t = h_ * static_cast<double>(steps_++);
    for (const int i : guided_) {
      const auto k = static_cast<std::size_t>(i);
      bodies_[k]->applyCentralForce(fromEigen(guidingForce(world_.bodies[k], motion(i), t, h_)));
    }
    dynamics_->stepSimulation(h_, 0);
  }

  BenchMotion motion(int i) override {
    const btRigidBody& body = *bodies_[static_cast<std::size_t>(i)];
    const btQuaternion q = body.getCenterOfMassTransform().getRotation();
    return {{Quat(q.w(), q.x(), q.y(), q.z()), toEigen(body.getCenterOfMassPosition())},
            toEigen(body.getLinearVelocity()),
            toEigen(body.getAngularVelocity())};
  }

 private:
  static void tuneGlobals() {
    gContactBreakingThreshold = kBreaking;
    gDbvtMargin = kTreeBoxMargin;
  }

  void add(const BenchBody& body) {
    shapes_.push_back(shapeOf(body));
    const bool moves = body.kind != BenchKind::kFixed, guided = body.kind == BenchKind::kGuided;
    btVector3 inertia(0, 0, 0);
    if (moves && !guided) inertia = inertiaOf(body, *shapes_.back());
    btRigidBody::btRigidBodyConstructionInfo info(moves ? body.mass : 0, nullptr, shapes_.back().get(), inertia);
    // of planes the place is in the shape
    if (!std::holds_alternative<contact::HalfSpace>(body.shape))
      info.m_startWorldTransform = btTransform(fromEigen(body.X_WB.q), fromEigen(body.X_WB.p));
    info.m_friction = std::sqrt(world_.mu);  // Bullet multiplies the two bodies'
    info.m_restitution = std::sqrt(world_.restitution);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& b = *bodies_.back();
    if (moves) {
      b.setActivationState(DISABLE_DEACTIVATION);
      b.setLinearVelocity(fromEigen(body.v_W));
      b.setAngularVelocity(fromEigen(body.w_W));
    }
    if (guided) {
      guided_.push_back(static_cast<int>(bodies_.size()) - 1);
      b.setLinearFactor(btVector3(!body.locked[0], !body.locked[1], !body.locked[2]));
      b.setAngularFactor(0);
    }
    dynamics_->addRigidBody(&b);
    if (guided) b.setGravity(btVector3(0, 0, 0));
    if (body.kind == BenchKind::kHinged) hinge(body, b);
  }

  // Of a box exactly: Bullet counts the margin in.
  static btVector3 inertiaOf(const BenchBody& body, const btCollisionShape& shape) {
    btVector3 inertia;
    shape.calculateLocalInertia(body.mass, inertia);
    if (const auto* box = std::get_if<contact::Box>(&body.shape)) {
      const Vec3 s = box->half.cwiseAbs2();
      inertia = body.mass / 3 * btVector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
    }
    return inertia;
  }

  void hinge(const BenchBody& body, btRigidBody& b) {
    const Vec3 pivot_B = body.X_WB.inverse() * body.hinge_W, axis_B = body.X_WB.q.conjugate() * Vec3::UnitY();
    hinges_.push_back(std::make_unique<btHingeConstraint>(b, fromEigen(pivot_B), fromEigen(axis_B)));
    dynamics_->addConstraint(hinges_.back().get());
  }

  BenchWorld world_;
  double h_;
  std::int64_t steps_ = 0;
  std::vector<int> guided_;
  btDefaultCollisionConfiguration configuration_{largePools()};
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btDantzigSolver lcp_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> dynamics_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btHingeConstraint>> hinges_;
};

}  // namespace

std::vector<Contestant> bulletEngines() {
  std::vector<Contestant> settings;
  for (const bool dantzig : {false, true}) {
    Contestant c;
    c.engine = "Bullet";
    c.setting = dantzig ? "Dantzig" : "SI50";
    c.lacks = [=](const BenchWorld& world) {
      return dantzig && world.bodies.size() > 60 ? std::string("not run with more than 60 bodies, for its cost")
                                                 : std::string();
    };
    c.make = [=](const BenchWorld& world, const BenchStep& step) -> std::unique_ptr<BenchEngine> {
      return std::make_unique<BulletEngine>(world, step.h, dantzig, kIterations);
    };
    settings.push_back(std::move(c));
  }
  return settings;
}

std::vector<Contestant> familyPeers() {
  Contestant games;
  games.engine = "Bullet";
  games.setting = fmt::format("SI{}", kGameIterations);
  games.make = [](const BenchWorld& world, const BenchStep& step) -> std::unique_ptr<BenchEngine> {
    return std::make_unique<BulletEngine>(world, step.h, false, kGameIterations);
  };
  return {games};
}

}  // namespace pincer::tasks
