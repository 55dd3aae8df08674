// A robot in MuJoCo: its file as it is, but for the step and what makes contacts, limits and loops as stiff as
// elsewhere in this comparison (engine_mujoco.cpp).
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "pincer/contact/error.h"
#include "pincer/tasks/judge/peers/mujoco_setting.h"
#include "pincer/tasks/run/files/builtin_files.h"

namespace pincer::tasks {
namespace {

mjModel* modelOf(const BenchRobot& robot) {
  std::array<char, 500> error{};
  mjModel* model = nullptr;
  const auto files = builtinFiles();
  const auto file =
      std::find_if(files.begin(), files.end(), [&](const BuiltinFile& f) { return f.path == robot.file; });
  if (file == files.end()) {
    model = mj_loadXML(robot.file.c_str(), nullptr, error.data(), static_cast<int>(error.size()));
  } else {
    const auto memory = std::make_unique<mjVFS>();
    mj_defaultVFS(memory.get());
    mj_makeEmptyFileVFS(memory.get(), "robot.xml", static_cast<int>(file->text.size()));
    std::memcpy(memory->filedata[mj_findFileVFS(memory.get(), "robot.xml")], file->text.data(), file->text.size());
    model = mj_loadXML("robot.xml", memory.get(), error.data(), static_cast<int>(error.size()));
    mj_deleteVFS(memory.get());
  }
  if (model == nullptr) throw InputError(fmt::format("MuJoCo refuses it: {}", error.data()));
  return model;
}

int integratorOf(std::string_view name) {
  if (name == "RK4") return mjINT_RK4;
  return name == "implicit" ? mjINT_IMPLICIT : mjINT_EULER;
}

// One pair of solref and solimp in each row.
void stiffen(mjtNum* solref, mjtNum* solimp, int rows, double h) {
  constexpr mjtNum kSolimp[mjNIMP] = {0.99, 0.999, 0.0001, 0.5, 2};
  for (int i = 0; i < rows; ++i) {
    solref[mjNREF * i] = 5 * h;
    solref[mjNREF * i + 1] = 1;
    std::copy(std::begin(kSolimp), std::end(kSolimp), solimp + mjNIMP * i);
  }
}

void setOptions(mjModel& m, double h, const MujocoSetting& setting) {
  m.opt.timestep = h;
  m.opt.cone = mjCONE_ELLIPTIC;
  m.opt.solver = mjSOL_NEWTON;
  m.opt.integrator = integratorOf(setting.integrator);
  m.opt.impratio = setting.impratio;
  m.opt.noslip_iterations = setting.noslip;
  m.opt.noslip_tolerance = 1e-14;
  m.opt.tolerance = 1e-8;
  m.opt.iterations = 100;
  stiffen(m.geom_solref, m.geom_solimp, m.ngeom, h);
  stiffen(m.eq_solref, m.eq_solimp, m.neq, h);
  stiffen(m.jnt_solref, m.jnt_solimp, m.njnt, h);
  stiffen(m.dof_solref, m.dof_solimp, m.nv, h);
}

class MujocoRobot : public BenchEngine {
 public:
  MujocoRobot(const BenchRobot& robot, double h, const MujocoSetting& setting)
      : model_(modelOf(robot), mj_deleteModel), data_(mj_makeData(model_.get()), mj_deleteData) {
    setOptions(*model_, h, setting);
    for (const std::string& name : robot.bodies) ids_.push_back(idOf(mjOBJ_BODY, name));
    if (!robot.keyframe.empty()) mj_resetDataKeyframe(model_.get(), data_.get(), idOf(mjOBJ_KEY, robot.keyframe));
    mj_forward(model_.get(), data_.get());
  }

  void step() override { mj_step(model_.get(), data_.get()); }

  BenchMotion motion(int i) override {
    mj_kinematics(model_.get(), data_.get());  // poses of mj_step are those of its start
    const mjtNum *p = data_->xpos + 3 * ids_[static_cast<std::size_t>(i)],
                 *q = data_->xquat + 4 * ids_[static_cast<std::size_t>(i)];
    return {.X_WB = {Quat(q[0], q[1], q[2], q[3]), Vec3(p[0], p[1], p[2])}};
  }

  std::string complaint() override {
    int count = 0;
    for (const mjWarningStat& warning : data_->warning) count += warning.number;
    return count > 0 ? fmt::format("{} warnings", count) : std::string();
  }

 private:
  int idOf(mjtObj kind, const std::string& name) const {
    const int id = mj_name2id(model_.get(), kind, name.c_str());
    if (id < 0) throw InputError(fmt::format("MuJoCo finds no \"{}\"", name));
    return id;
  }

  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  std::vector<int> ids_;
};

}  // namespace

std::unique_ptr<BenchEngine> mujocoRobot(const BenchRobot& robot, double h, const MujocoSetting& setting) {
  return std::make_unique<MujocoRobot>(robot, h, setting);
}

}  // namespace pincer::tasks
