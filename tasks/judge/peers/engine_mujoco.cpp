// MuJoCo 2.2.2 (Debian): elliptic cones, Newton, tolerance 1e-8, contacts as stiff as its time constant allows
// (solref 5 steps, solimp .99 .999 .0001), impratio 1e4 without noslip, or 100 with 30 noslip iterations: the
// settings that its documentation gives against slip. RK4 with the first for what moves smoothly. And, in the scene
// of its issue 3328 alone, the recipe given there: soft contacts, impratio 10. Fingertips and pads are bodies on
// slide joints, whose dampers are its own.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>

#include "pincer/contact/error.h"
#include "pincer/tasks/judge/peers/adapters.h"
#include "pincer/tasks/judge/peers/mujoco_setting.h"

namespace pincer::tasks {
namespace {

// Settings that are compared: stiff friction (impratio) or slip taken out afterwards (noslip), rigid and soft.
constexpr MujocoSetting kMujocoSettings[] = {
    {"impratio 1e4", 1e4, 0, "Euler"},           {"impratio 100 noslip 30", 100, 30, "Euler"},
    {"impratio 1e4 RK4", 1e4, 0, "RK4"},         {"impratio 1e4 implicit", 1e4, 0, "implicit"},
    {"impratio 10, soft", 10, 0, "Euler", true}, {"impratio 10 noslip 10, soft", 10, 10, "Euler", true}};

std::string text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
std::string text(const Quat& q) { return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z()); }

// Restitution of x'' = -x - 2 z x' that only pushes: from x' = -1 it lets go where x + 2 z x' = 0, at w t = 2 atan2(w,
// z), w = sqrt(1 - z^2), with x' = exp(-z t).
double restitutionOf(double z) {
  const double w = std::sqrt(1 - z * z);
  return std::exp(-z / w * 2 * std::atan2(w, z));
}

double dampingRatioFor(double restitution) {
  double low = 0, high = 0.999;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (restitutionOf(middle) > restitution ? low : high) = middle;
  }
  return low;
}

// Contact parameters. A bounce needs a spring that a few steps resolve
// (frequency 0.2 per step) and hardly any softening.
std::string contactText(const BenchWorld& world, double h, bool soft) {
  const std::string friction = fmt::format("condim='3' friction='{} 0 0' ", std::max(world.mu, 1e-5));
  if (soft) return friction;
  if (world.restitution > 0) {
    const double w = 0.2 / h, z = dampingRatioFor(world.restitution);
    return friction + fmt::format("solref='{} {}' solimp='0.9999 0.9999 0.001 0.5 2'", -w * w, -2 * z * w);
  }
  return friction + fmt::format("solref='{} 1' solimp='0.99 0.999 0.0001 0.5 2'", 5 * h);
}

std::string geometryText(const BenchBody& body, const std::string& contact) {
  const std::string tail = fmt::format("mass='{}' {}/>", body.mass, contact);
  if (const auto* sphere = std::get_if<contact::Sphere>(&body.shape))
    return fmt::format("<geom type='sphere' size='{}' {}", sphere->radius, tail);
  if (const auto* capsule = std::get_if<contact::Capsule>(&body.shape)) {
    return fmt::format("<geom type='capsule' size='{} {}' {}", capsule->radius, capsule->half_length, tail);
  }
  return fmt::format("<geom type='box' size='{}' {}", text(std::get<contact::Box>(body.shape).half), tail);
}

std::string jointText(const BenchBody& body) {
  if (body.kind == BenchKind::kFree) return "<freejoint/>";
  if (body.kind == BenchKind::kHinged) {
    return fmt::format("<joint type='hinge' pos='{}' axis='{}'/>", text(Vec3(body.X_WB.inverse() * body.hinge_W)),
                       text(Vec3(body.X_WB.q.conjugate() * Vec3::UnitY())));
  }
  std::string joints;
  for (int k = 0; k < 3; ++k) {
    if (body.locked[static_cast<std::size_t>(k)]) continue;
    joints += fmt::format("<joint type='slide' axis='{}' damping='{}'/>", text(Vec3(Vec3::Unit(k))), body.damping[k]);
  }
  return joints;
}

std::string modelText(const BenchWorld& world, double h, const MujocoSetting& setting) {
  const std::size_t n = world.bodies.size();
  std::string xml = fmt::format(
      "<mujoco><compiler boundmass='0' angle='radian'/><option timestep='{}' gravity='{}' cone='elliptic' "
      "solver='Newton' integrator='{}' "
      "impratio='{}' noslip_iterations='{}' noslip_tolerance='1e-14' tolerance='1e-8' iterations='100'/><size "
      "njmax='{}' "
      "nconmax='{}'/><worldbody>",
      h, text(world.gravity_W), setting.integrator, setting.impratio, setting.noslip, n > 100 ? 12 * n : 60 * n + 500,
      n > 100 ? 4 * n : 15 * n + 100);
  const std::string contact = contactText(world, h, setting.soft);
  for (std::size_t i = 0; i < n; ++i) {
    const BenchBody& body = world.bodies[i];
    if (body.kind == BenchKind::kFixed) {
      xml += fmt::format("<geom type='plane' size='2 2 .1' pos='{}' quat='{}' {}/>", text(body.X_WB.p),
                         text(body.X_WB.q), contact);
      continue;
    }
    xml += fmt::format("<body name='b{}' pos='{}' quat='{}'>{}{}</body>", i, text(body.X_WB.p), text(body.X_WB.q),
                       jointText(body), geometryText(body, contact));
  }
  return xml + "</worldbody></mujoco>";
}

mjModel* compile(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), "scene.xml")], xml.data(), xml.size());
  std::array<char, 500> error{};
  mjModel* model = mj_loadXML("scene.xml", files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteVFS(files.get());
  if (model == nullptr) throw InputError(fmt::format("MuJoCo refuses the scene: {}", error.data()));
  return model;
}

// In place of what MuJoCo does itself: print each and write a log file. The error's ends
// the process, so it is made an exception.
void keepQuiet(const char*) {}
void refuse(const char* message) { throw InputError(fmt::format("MuJoCo gives up: {}", message)); }

class MujocoEngine : public BenchEngine {
 public:
  MujocoEngine(const BenchWorld& world, double h, const MujocoSetting& setting)
      : world_(world), h_(h), model_(compile(modelText(world, h, setting))), data_(mj_makeData(model_)) {
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
      const BenchBody& body = world_.bodies[i];
      const int id = body.kind == BenchKind::kFixed ? 0 : mj_name2id(model_, mjOBJ_BODY, fmt::format("b{}", i).c_str());
      ids_.push_back(id);
      undamped_.push_back(body);
      undamped_.back().damping.setZero();
      if (body.kind == BenchKind::kGuided) guided_.push_back(static_cast<int>(i));
      if (body.kind != BenchKind::kFree) continue;
      mjtNum* v = data_->qvel + firstFreedom(id);
      const Vec3 w_B = body.X_WB.q.conjugate() * body.w_W;
      for (int k = 0; k < 3; ++k) {
        v[k] = body.v_W[k];
        v[3 + k] = w_B[k];
      }
    }
    mj_forward(model_, data_);
  }
  MujocoEngine(const MujocoEngine&) = delete;
  MujocoEngine& operator=(const MujocoEngine&) = delete;
  ~MujocoEngine() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void step() override {
    const double t = h_ * static_cast<double>(steps_++);
    for (const int i : guided_) {
      const auto k = static_cast<std::size_t>(i);
      const BenchBody& body = world_.bodies[k];
      Vec3 f = guidingForce(undamped_[k], motion(i), t, h_) - body.mass * world_.gravity_W;  // weightless
      f += body.damping.cwiseProduct(body.aim(t).v_W);  // the joint's own damper pulls towards rest
      for (int axis = 0; axis < 3; ++axis) data_->xfrc_applied[6 * ids_[k] + axis] = f[axis];
    }
    mj_step(model_, data_);
  }

  BenchMotion motion(int i) override {
    const BenchBody& body = world_.bodies[static_cast<std::size_t>(i)];
    const int id = ids_[static_cast<std::size_t>(i)];
    if (id == 0) return {body.X_WB, Vec3::Zero(), Vec3::Zero()};
    const int joint = model_->body_jntadr[id];
    const mjtNum *q = data_->qpos + model_->jnt_qposadr[joint], *v = data_->qvel + model_->jnt_dofadr[joint];
    if (body.kind == BenchKind::kFree) {
      const Quat turn(q[3], q[4], q[5], q[6]);
      return {{turn, Vec3(q[0], q[1], q[2])}, Vec3(v[0], v[1], v[2]), turn * Vec3(v[3], v[4], v[5])};
    }
    if (body.kind == BenchKind::kHinged) {
      const Quat turn(Eigen::AngleAxisd(q[0], Vec3::UnitY()));
      const Vec3 arm = turn * (body.X_WB.p - body.hinge_W), w = v[0] * Vec3::UnitY();
      return {{turn * body.X_WB.q, body.hinge_W + arm}, w.cross(arm), w};
    }
    BenchMotion m{body.X_WB, Vec3::Zero(), Vec3::Zero()};
    for (int axis = 0, slide = 0; axis < 3; ++axis) {
      if (body.locked[static_cast<std::size_t>(axis)]) continue;
      m.X_WB.p[axis] += q[slide];
      m.v_W[axis] = v[slide++];
    }
    return m;
  }

  std::string complaint() override {
    int count = 0;
    for (const mjWarningStat& warning : data_->warning) count += warning.number;
    return count > 0 ? fmt::format("{} warnings", count) : std::string();
  }

 private:
  int firstFreedom(int body) const { return model_->jnt_dofadr[model_->body_jntadr[body]]; }

  BenchWorld world_;
  double h_;
  std::int64_t steps_ = 0;
  mjModel* model_;
  mjData* data_;
  std::vector<int> ids_, guided_;
  std::vector<BenchBody> undamped_;
};

bool isIssue3328(const BenchWorld& world) {
  return std::any_of(world.bodies.begin(), world.bodies.end(),
                     [](const BenchBody& b) { return std::holds_alternative<contact::Capsule>(b.shape); });
}

}  // namespace

std::vector<Contestant> mujocoEngines() {
  mju_user_warning = keepQuiet;
  mju_user_error = refuse;
  std::vector<Contestant> settings;
  for (const MujocoSetting& setting : kMujocoSettings) {
    Contestant c;
    c.engine = "MuJoCo";
    c.setting = setting.name;
    c.lacks = [](const BenchWorld&) { return std::string(); };
    c.reads_robots = !setting.soft;
    if (setting.soft) c.meant = isIssue3328;
    if (setting.integrator == std::string_view("implicit")) c.meant = [](const BenchWorld& w) { return bool(w.robot); };
    c.make = [&setting](const BenchWorld& world, const BenchStep& step) -> std::unique_ptr<BenchEngine> {
      if (world.robot) return mujocoRobot(*world.robot, step.h, setting);
      return std::make_unique<MujocoEngine>(world, step.h, setting);
    };
    settings.push_back(std::move(c));
  }
  return settings;
}

}  // namespace pincer::tasks
