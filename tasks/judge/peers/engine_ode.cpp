// ODE 0.16, double precision: the Dantzig stepper (dWorldStep) and QuickStep with 50 iterations; friction pyramid
// (dContactApprox1), surface layer 1 um, no sleep, no damping, gyroscopic term on. It has no locked axes: fingertips
// and pads are held by motors of infinite force.
#include <ode/ode.h>

#include <cstdarg>

#include "pincer/contact/error.h"
#include "pincer/tasks/judge/peers/adapters.h"

namespace pincer::tasks {
namespace {

constexpr int kMostPoints = 8;          // of a pair
constexpr double kSurfaceLayer = 1e-6;  // [m]

// Its solver prints a line on each step whose factorisation meets a zero; the judge sees what comes of it.
void dropMessage(int, const char*, va_list) {}

class OdeEngine : public BenchEngine {
 public:
  OdeEngine(const BenchWorld& world, double h, bool quick) : description_(world), h_(h), quick_(quick) {
    dInitODE2(0);
    dSetMessageHandler(dropMessage);
    dAllocateODEDataForThread(dAllocateMaskAll);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, world.gravity_W.x(), world.gravity_W.y(), world.gravity_W.z());
    dWorldSetAutoDisableFlag(world_, 0);
    dWorldSetContactSurfaceLayer(world_, kSurfaceLayer);
    if (quick) dWorldSetQuickStepNumIterations(world_, 50);
    for (const BenchBody& body : world.bodies) add(body);
  }
  OdeEngine(const OdeEngine&) = delete;
  OdeEngine& operator=(const OdeEngine&) = delete;
  ~OdeEngine() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void step() override {
    const double t = h_ * static_cast<double>(steps_++);
    for (const int i : guided_) {
      const auto k = static_cast<std::size_t>(i);
      const Vec3 f = guidingForce(description_.bodies[k], motion(i), t, h_);
      dBodyAddForce(bodies_[k], f.x(), f.y(), f.z());
    }
    dSpaceCollide(space_, this, collidePair);
    (quick_ ? dWorldQuickStep : dWorldStep)(world_, h_);
    dJointGroupEmpty(contacts_);
  }

  BenchMotion motion(int i) override {
    const dBodyID body = bodies_[static_cast<std::size_t>(i)];
    const dReal *p = dBodyGetPosition(body), *q = dBodyGetQuaternion(body), *v = dBodyGetLinearVel(body),
                *w = dBodyGetAngularVel(body);
    return {{Quat(q[0], q[1], q[2], q[3]), Vec3(p[0], p[1], p[2])}, Vec3(v[0], v[1], v[2]), Vec3(w[0], w[1], w[2])};
  }

 private:
  static void collidePair(void* engine, dGeomID a, dGeomID b) { static_cast<OdeEngine*>(engine)->collide(a, b); }

  void collide(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (body_a == nullptr && body_b == nullptr) return;
    std::array<dContact, kMostPoints> points{};
    const int n = dCollide(a, b, kMostPoints, &points[0].geom, sizeof(dContact));
    for (int i = 0; i < n; ++i) {
      dContact& c = points[static_cast<std::size_t>(i)];
      c.surface.mode = dContactApprox1;
      c.surface.mu = description_.mu;
      if (description_.restitution > 0) {
        c.surface.mode |= dContactBounce;
        c.surface.bounce = description_.restitution;
        c.surface.bounce_vel = 0;
      }
      dJointAttach(dJointCreateContact(world_, contacts_, &c), body_a, body_b);
    }
  }

  void add(const BenchBody& body) {
    if (body.kind == BenchKind::kFixed) {
      const Vec3 n = body.X_WB.q * Vec3::UnitZ();
      dCreatePlane(space_, n.x(), n.y(), n.z(), n.dot(body.X_WB.p));
      bodies_.push_back(nullptr);
      return;
    }
    dMass mass;
    const dGeomID geom = geometryOf(body, mass);
    const dBodyID b = dBodyCreate(world_);
    dBodySetMass(b, &mass);
    dGeomSetBody(geom, b);
    const Quat& q = body.X_WB.q;
    const dQuaternion rotation = {q.w(), q.x(), q.y(), q.z()};
    dBodySetPosition(b, body.X_WB.p.x(), body.X_WB.p.y(), body.X_WB.p.z());
    dBodySetQuaternion(b, rotation);
    dBodySetLinearVel(b, body.v_W.x(), body.v_W.y(), body.v_W.z());
    dBodySetAngularVel(b, body.w_W.x(), body.w_W.y(), body.w_W.z());
    dBodySetGyroscopicMode(b, 1);
    if (body.kind == BenchKind::kGuided) guide(body, b);
    if (body.kind == BenchKind::kHinged) {
      const dJointID hinge = dJointCreateHinge(world_, nullptr);
      dJointAttach(hinge, b, nullptr);
      dJointSetHingeAnchor(hinge, body.hinge_W.x(), body.hinge_W.y(), body.hinge_W.z());
      dJointSetHingeAxis(hinge, 0, 1, 0);
    }
    bodies_.push_back(b);
  }

  dGeomID geometryOf(const BenchBody& body, dMass& mass) const {
    if (const auto* sphere = std::get_if<contact::Sphere>(&body.shape)) {
      dMassSetSphereTotal(&mass, body.mass, sphere->radius);
      return dCreateSphere(space_, sphere->radius);
    }
    if (const auto* capsule = std::get_if<contact::Capsule>(&body.shape)) {
      dMassSetCapsuleTotal(&mass, body.mass, 3, capsule->radius, 2 * capsule->half_length);
      return dCreateCapsule(space_, capsule->radius, 2 * capsule->half_length);
    }
    const Vec3 size = 2 * std::get<contact::Box>(body.shape).half;
    dMassSetBoxTotal(&mass, body.mass, size.x(), size.y(), size.z());
    return dCreateBox(space_, size.x(), size.y(), size.z());
  }

  void guide(const BenchBody& body, dBodyID b) {
    guided_.push_back(static_cast<int>(bodies_.size()));
    dBodySetGravityMode(b, 0);
    const dJointID turns = dJointCreateAMotor(world_, nullptr);
    dJointAttach(turns, b, nullptr);
    dJointSetAMotorMode(turns, dAMotorUser);
    dJointSetAMotorNumAxes(turns, 3);
    for (int k = 0; k < 3; ++k) dJointSetAMotorAxis(turns, k, 0, k == 0, k == 1, k == 2);
    for (const int limit : {dParamFMax1, dParamFMax2, dParamFMax3}) dJointSetAMotorParam(turns, limit, dInfinity);
    const dJointID slides = dJointCreateLMotor(world_, nullptr);
    dJointAttach(slides, b, nullptr);
    int axes = 0;
    for (const bool locked : body.locked) axes += locked;
    dJointSetLMotorNumAxes(slides, axes);
    // The most force along the first, second and third locked axis.
    constexpr int kLimits[] = {dParamFMax1, dParamFMax2, dParamFMax3};
    for (int k = 0, axis = 0; k < 3; ++k) {
      if (!body.locked[static_cast<std::size_t>(k)]) continue;
      dJointSetLMotorAxis(slides, axis, 0, k == 0, k == 1, k == 2);
      dJointSetLMotorParam(slides, kLimits[axis++], dInfinity);
    }
  }

  BenchWorld description_;
  double h_;
  bool quick_;
  std::int64_t steps_ = 0;
  std::vector<int> guided_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
};

}  // namespace

std::vector<Contestant> odeEngines() {
  std::vector<Contestant> settings;
  for (const bool quick : {false, true}) {
    Contestant c;
    c.engine = "ODE";
    c.setting = quick ? "QuickStep" : "Dantzig";
    c.lacks = [=](const BenchWorld& world) {
      return !quick && world.bodies.size() > 60 ? std::string("not run with more than 60 bodies, for its cost")
                                                : std::string();
    };
    c.make = [=](const BenchWorld& world, const BenchStep& step) -> std::unique_ptr<BenchEngine> {
      return std::make_unique<OdeEngine>(world, step.h, quick);
    };
    settings.push_back(std::move(c));
  }
  return settings;
}

}  // namespace pincer::tasks
