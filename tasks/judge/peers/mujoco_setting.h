// mujoco_setting: the settings of MuJoCo that are compared, and its robots.
#pragma once
#include <memory>

#include "pincer/tasks/judge/bench/engine/bench_world.h"

namespace pincer::tasks {

struct MujocoSetting {
  const char* name;
  double impratio;
  int noslip;
  const char* integrator;  // Euler, RK4, implicit
  bool soft = false;       // contacts as soft as they come (solref .02), as in the scene of its issue 3328
};

// The robot's file as MuJoCo reads it, with these settings in place of its own. Throws InputError.
std::unique_ptr<BenchEngine> mujocoRobot(const BenchRobot& robot, double h, const MujocoSetting& setting);

}  // namespace pincer::tasks
