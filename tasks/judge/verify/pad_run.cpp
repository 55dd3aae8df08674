#include "pincer/tasks/judge/verify/pad_run.h"

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/lathe.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::tasks {
namespace {

constexpr double kBesideMoment = 1e-4;  // of inertia of the object whose centre of mass is given [kg m^2]

double sideOf(int finger) { return finger == 0 ? -1 : 1; }

grasp::FingerModel fingerOf(const PadGrip& grip, int i) {
  grasp::FingerModel f;
  f.name = i == 0 ? "left" : "right";
  f.shape = grip.tip ? *grip.tip : flatPad(grip.width);
  f.pad.patch_radius = grip.patch_radius;
  f.coupling.turn_stiffness = grip.turn_stiffness;
  f.coupling.turn_damping = 1e-2 * grip.turn_stiffness;
  f.coupling.stiffness = grip.stiffness;
  f.coupling.damping = Vec3::Constant(5);
  f.coupling.locked = grip.locked;
  if (!(grip.stiffness.x() > 0)) f.coupling.mass = 0.05;
  return f;
}

}  // namespace

contact::PadTip flatPad(double width) {
  const double a = 0.5 * width - kRounding, b = kHalfThickness - kRounding;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? b : -b, i & 2 ? a : -a, i & 4 ? a : -a});
  return {contact::Polytope::hullOf(corners, "pad"), kRounding};
}

contact::PadTip roundPad(double width) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 48; ++i) {
    const double a = 2 * M_PI * (i / 2) / 24, r = 0.5 * width - kRounding, b = kHalfThickness - kRounding;
    corners.push_back({i & 1 ? b : -b, r * math::cos(a), r * math::sin(a)});
  }
  return {contact::Polytope::hullOf(corners, "round pad"), kRounding};
}

contact::Shape smooth(const contact::TriangleMesh& mesh) { return contact::Mesh{contact::SmoothMesh::build(mesh)}; }

std::vector<HeldMesh> heldMeshes() {
  using namespace contact;
  const TriangleMesh spool = lathe({{0, -0.008},
                                    {0.02, -0.008},
                                    {0.02, -0.005},
                                    {0.012, -0.002},
                                    {0.012, 0.002},
                                    {0.02, 0.005},
                                    {0.02, 0.008},
                                    {0, 0.008}},
                                   64);
  return {{"torus", smooth(torus(0.013, 0.007, 48, 32))},
          {"spool", smooth(spool)},
          {"round-edged cube", smooth(roundedCube(0.02, 0.006, 4))},
          {"grooved block", smooth(grooveBlock(0.25 * M_PI, 0.01, 0.02, 0.015))},
          {"hilly ball", smooth(bumpySphere(0.02, 0.08, 6, 12))},
          {"scan", smooth(noisy(ellipsoid(Vec3(0.02, 0.019, 0.016), 12), 3e-5, 1))}};
}

PadRun::PadRun(const PadGrip& grip) : grip_(grip) {
  engine::WorldOptions options;
  options.gravity_W = grip.gravity_W;
  engine::WorldBuilder builder(options);
  engine::BodySpec object{"object", grip.shape, true, grip.mass, {grip.mu, grip.mu}};
  object.shapes = grip.shapes;
  if (grip.beside > 0) object.inertia = engine::GivenInertia{Vec3(0, grip.beside, 0), kBesideMoment * Mat3::Identity()};
  builder.addBody(object);
  model = grasp::buildGrasp(std::move(builder), {fingerOf(grip, 0), fingerOf(grip, 1)});
  engine::BodyStart start;
  start.X_WB = {grip.q_WB, Vec3(grip.along, 0, kUp)};
  start.w_W = grip.w_W;
  state = grasp::makeState(model, {start}, {Vec3(0, 0, kUp) + startOf(0, 0), Vec3(0, 0, kUp) + startOf(1, 0)});
  scratch_ = grasp::makeScratch(model);
}

Vec3 PadRun::startOf(int finger, double deep) const {
  return Vec3(sideOf(finger) * (grip_.half + grip_.tip_reach - deep), 0, 0) + grip_.off;
}

void PadRun::tick(const Vec3& d, const Vec3& v, double sign) {
  const bool sprung = grip_.stiffness.x() > 0;
  for (int i = 0; i < 2; ++i) {
    const double way = i == 0 ? 1 : sign, deep = sprung ? grip_.press / grip_.stiffness.x() : 0;
    grasp::FingerInput& in = inputs_[static_cast<std::size_t>(i)];
    in.p_WF = Vec3(sideOf(i) * (grip_.half + grip_.tip_reach - deep), 0, kUp) + grip_.off + way * d;
    in.v_WF = way * v;
    in.f_W = sprung ? Vec3(Vec3::Zero()) : Vec3(-sideOf(i) * grip_.press, 0, 0);
  }
  step();
}

void PadRun::tick(const HandMotion& hand) {
  for (int i = 0; i < 2; ++i) {
    const Vec3 arm = hand.q * startOf(i, grip_.press / grip_.stiffness.x());
    inputs_[static_cast<std::size_t>(i)] = {Vec3(0, 0, kUp) + arm + hand.d, hand.v + hand.w.cross(arm), hand.q};
  }
  step();
}

void PadRun::step() {
  flagged += grasp::step(model, state, *scratch_, inputs_).status != engine::kStepOk;
  ++ticks;
}

}  // namespace pincer::tasks
