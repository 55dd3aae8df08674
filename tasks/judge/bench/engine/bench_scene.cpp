#include "pincer/tasks/judge/bench/engine/bench_scene.h"

#include <iterator>

namespace pincer::tasks {

std::vector<BenchScene> benchScenes(bool whole, const std::string& models) {
  std::vector<BenchScene> all;
  for (std::vector<BenchScene> part :
       {benchFreeScenes(whole), benchSlidingScenes(), benchPinchScenes(whole), benchRestingScenes(whole),
        benchImpactScenes(whole), benchTopplingScenes(), benchRobotScenes(models)}) {
    std::move(part.begin(), part.end(), std::back_inserter(all));
  }
  return all;
}

BenchBody benchFloor() { return {.shape = contact::HalfSpace{}, .kind = BenchKind::kFixed}; }

BenchBody benchBall(double mass, double radius, const Vec3& p_W, const Vec3& v_W, const Vec3& w_W) {
  return {.shape = contact::Sphere{radius}, .mass = mass, .X_WB = {Quat::Identity(), p_W}, .v_W = v_W, .w_W = w_W};
}

BenchBody benchBox(double mass, const Vec3& half, const Vec3& p_W, const Vec3& v_W, const Vec3& w_W) {
  return {.shape = contact::Box{half}, .mass = mass, .X_WB = {Quat::Identity(), p_W}, .v_W = v_W, .w_W = w_W};
}

BenchBody benchFinger(const Vec3& p_W, int axis, const std::function<double(double t)>& force) {
  BenchBody finger = benchBall(0.05, 0.008, p_W);
  finger.kind = BenchKind::kGuided;
  finger.locked = {axis != 0, axis != 1, true};
  finger.aim = [=](double t) { return BenchAim{p_W, Vec3::Zero(), force(t) * Vec3::Unit(axis)}; };
  return finger;
}

BenchJudge judgeOfEnd(std::function<BenchVerdict(BenchEngine&)> verdict) { return {{}, std::move(verdict)}; }

}  // namespace pincer::tasks
