// DART 6.12 (Debian): the Dantzig boxed LCP solver behind its own collision detector, error reduction 0.2, softening
// 1e-9, slop 1 um. Planes are boxes of 10 m, whose upper face is the plane; the detector knows no capsules.
// Fingertips and pads hang on prismatic joints.
#include <algorithm>
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/ContactConstraint.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include "pincer/tasks/judge/peers/adapters.h"

namespace pincer::tasks {
namespace {

namespace dynamics = dart::dynamics;
namespace constraint = dart::constraint;

constexpr double kPlaneSize = 10;  // [m]

Eigen::Isometry3d isometry(const Pose& X) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = X.q.toRotationMatrix();
  T.translation() = X.p;
  return T;
}

dynamics::ShapePtr shapeForDart(const BenchBody& body) {
  if (const auto* sphere = std::get_if<contact::Sphere>(&body.shape))
    return std::make_shared<dynamics::SphereShape>(sphere->radius);
  if (const auto* box = std::get_if<contact::Box>(&body.shape))
    return std::make_shared<dynamics::BoxShape>(Vec3(2 * box->half));
  return std::make_shared<dynamics::BoxShape>(Vec3(kPlaneSize, kPlaneSize, 1));
}

class DartEngine : public BenchEngine {
 public:
  DartEngine(const BenchWorld& world, double h)
      : description_(world), h_(h), world_(dart::simulation::World::create()) {
    world_->setGravity(world.gravity_W);
    world_->setTimeStep(h);
    world_->setConstraintSolver(std::make_unique<constraint::BoxedLcpConstraintSolver>(
        std::make_shared<constraint::DantzigBoxedLcpSolver>(), std::make_shared<constraint::PgsBoxedLcpSolver>()));
    constraint::ConstraintSolver* solver = world_->getConstraintSolver();
    solver->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
    solver->setTimeStep(h);
    solver->getCollisionOption().maxNumContacts = 20000;
    constraint::ContactConstraint::setErrorReductionParameter(0.2);
    constraint::ContactConstraint::setMaxErrorReductionVelocity(0.1);
    constraint::ContactConstraint::setConstraintForceMixing(1e-9);
    constraint::ContactConstraint::setErrorAllowance(1e-6);
    for (const BenchBody& body : description_.bodies) add(body);
  }

  void step() override {
    const double t = h_ * static_cast<double>(steps_++);
    for (const int i : guided_) {
      const auto k = static_cast<std::size_t>(i);
      bodies_[k]->addExtForce(guidingForce(description_.bodies[k], motion(i), t, h_), Vec3::Zero(), false, true);
    }
    world_->step(true);
  }

  BenchMotion motion(int i) override {
    const dynamics::BodyNode* body = bodies_[static_cast<std::size_t>(i)];
    const Eigen::Isometry3d& T = body->getWorldTransform();
    return {{Quat(T.linear()), T.translation()}, body->getCOMLinearVelocity(), body->getAngularVelocity()};
  }

 private:
  void add(const BenchBody& body) {
    const auto skeleton = dynamics::Skeleton::create("s" + std::to_string(bodies_.size()));
    const dynamics::ShapePtr shape = shapeForDart(body);
    dynamics::BodyNode* node = nullptr;
    if (body.kind == BenchKind::kFixed) node = fix(body, *skeleton);
    if (body.kind == BenchKind::kFree) node = release(body, *skeleton);
    if (body.kind == BenchKind::kGuided) node = guide(body, *skeleton);
    if (body.kind == BenchKind::kHinged) node = hinge(body, *skeleton);
    auto* shape_node = node->createShapeNodeWith<dynamics::CollisionAspect, dynamics::DynamicsAspect>(shape);
    shape_node->getDynamicsAspect()->setFrictionCoeff(description_.mu);
    shape_node->getDynamicsAspect()->setRestitutionCoeff(std::sqrt(description_.restitution));
    if (body.kind == BenchKind::kFixed) {
      skeleton->setMobile(false);
    } else {
      dynamics::Inertia inertia;
      inertia.setMass(body.mass);
      inertia.setMoment(shape->computeInertia(body.mass));
      node->setInertia(inertia);
    }
    skeleton->disableSelfCollisionCheck();
    world_->addSkeleton(skeleton);
    bodies_.push_back(node);
  }

  static dynamics::BodyNode* fix(const BenchBody& body, dynamics::Skeleton& skeleton) {
    const auto [joint, node] = skeleton.createJointAndBodyNodePair<dynamics::WeldJoint>();
    joint->setTransformFromParentBodyNode(isometry(body.X_WB * Pose{Quat::Identity(), Vec3(0, 0, -0.5)}));
    return node;
  }

  static dynamics::BodyNode* release(const BenchBody& body, dynamics::Skeleton& skeleton) {
    const auto [joint, node] = skeleton.createJointAndBodyNodePair<dynamics::FreeJoint>();
    joint->setTransform(isometry(body.X_WB));
    joint->setLinearVelocity(body.v_W);
    joint->setAngularVelocity(body.w_W);
    return node;
  }

  // A chain of one prismatic joint per free axis; the links between them weigh next to nothing.
  dynamics::BodyNode* guide(const BenchBody& body, dynamics::Skeleton& skeleton) {
    guided_.push_back(static_cast<int>(bodies_.size()));
    dynamics::BodyNode* node = nullptr;
    for (int k = 0; k < 3; ++k) {
      if (body.locked[static_cast<std::size_t>(k)]) continue;
      const auto [joint, next] = skeleton.createJointAndBodyNodePair<dynamics::PrismaticJoint>(node);
      joint->setAxis(Vec3::Unit(k));
      if (node == nullptr) {
        joint->setTransformFromParentBodyNode(isometry(body.X_WB));
      } else {
        node->setInertia(dynamics::Inertia(1e-6, Vec3::Zero(), 1e-9 * Mat3::Identity()));
      }
      next->setGravityMode(false);
      node = next;
    }
    return node;
  }

  static dynamics::BodyNode* hinge(const BenchBody& body, dynamics::Skeleton& skeleton) {
    const auto [joint, node] = skeleton.createJointAndBodyNodePair<dynamics::RevoluteJoint>();
    joint->setAxis(Vec3::UnitY());
    joint->setTransformFromParentBodyNode(isometry({Quat::Identity(), body.hinge_W}));
    joint->setTransformFromChildBodyNode(isometry(body.X_WB.inverse() * Pose{Quat::Identity(), body.hinge_W}));
    return node;
  }

  BenchWorld description_;
  double h_;
  std::int64_t steps_ = 0;
  std::shared_ptr<dart::simulation::World> world_;
  std::vector<dynamics::BodyNode*> bodies_;
  std::vector<int> guided_;
};

}  // namespace

std::vector<Contestant> dartEngines() {
  Contestant c;
  c.engine = "DART";
  c.setting = "Dantzig";
  c.lacks = [](const BenchWorld& world) -> std::string {
    const bool capsule = std::any_of(world.bodies.begin(), world.bodies.end(), [](const BenchBody& b) {
      return std::holds_alternative<contact::Capsule>(b.shape);
    });
    if (capsule) return "its collision detector knows no capsules";
    return world.bodies.size() > 60 ? "not run with more than 60 bodies, for its cost" : "";
  };
  c.make = [](const BenchWorld& world, const BenchStep& step) -> std::unique_ptr<BenchEngine> {
    return std::make_unique<DartEngine>(world, step.h);
  };
  return {c};
}

}  // namespace pincer::tasks
