// Circumstances that must not matter: the order of the bodies, how the world is
// turned, how it moves, and that it ran before.
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

// Bodies that meet for half a second without chaos: a sphere slides into rolling, a box slides
// off a push, a sphere is pinched and slips.
Scene sample() {
  Scene scene = readBuiltinScene("s4_pinch_098");
  scene.duration = 0.12;
  engine::BodySpec floor{"floor", contact::HalfSpace{}, false, 0, {}};
  engine::BodySpec ball{"ball", contact::Sphere{0.02}, true, 0.1, {}};
  engine::BodySpec box{"box", contact::Box{{0.02, 0.03, 0.01}}, true, 0.2, {}};
  scene.bodies.push_back(floor);
  scene.starts.push_back({});
  scene.bodies.push_back(ball);
  scene.starts.push_back({{Quat::Identity(), {0.3, 0, 0.02}}, {0.5, 0.1, 0}, {1, 2, 3}});
  scene.bodies.push_back(box);
  scene.starts.push_back({{Quat::Identity(), {0, 0.3, 0.01}}, {0.2, 0.3, 0}, {0, 0, 1}});
  return scene;
}

std::vector<Pose> endPoses(Scene scene) {
  Simulation sim(std::move(scene));
  MeasureContext quiet;
  runThrough(sim, quiet, [] {});
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < sim.scene().bodies.size(); ++i) poses.push_back(sim.bodyPose(static_cast<int>(i)));
  return poses;
}

double largestDistance(const std::vector<Pose>& a, const std::vector<Pose>& b, const std::vector<std::size_t>& order,
                       const Pose& X) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Pose expected = X * a[order[i]];
    constexpr double kSize = 0.02;  // of a body: an angle counts by how far it moves the surface [m]
    worst = std::max({worst, (expected.p - b[i].p).norm(), kSize * angleBetween(expected.q, b[i].q)});
  }
  return worst;
}

std::vector<Record> permutation(MeasureContext&) {
  const Scene scene = sample();
  Scene mixed = scene;
  const std::vector<std::size_t> order = {3, 1, 2, 0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    mixed.bodies[i] = scene.bodies[order[i]];
    mixed.starts[i] = scene.starts[order[i]];
  }
  return {atMost("bodies in another order: largest change",
                 largestDistance(endPoses(scene), endPoses(mixed), order, {}), "m", 1e-10)};
}

// Fingers are driven along world axes, so a turned world turns without them.
std::vector<Record> rotation(MeasureContext&) {
  Scene scene = sample();
  scene.fingers.clear();
  scene.bodies.erase(scene.bodies.begin());
  scene.starts.erase(scene.starts.begin());
  const Pose X{quatFromRotationVector({0.4, -0.8, 1.1}), {0.2, -0.1, 0.3}};
  Scene turned = scene;
  turned.options.gravity_W = X.q * scene.options.gravity_W;
  for (engine::BodyStart& start : turned.starts) {
    start.X_WB = X * start.X_WB;
    start.v_W = X.q * start.v_W;
    start.w_W = X.q * start.w_W;
  }
  return {atMost("world turned and moved: largest change",
                 largestDistance(endPoses(scene), endPoses(turned), {0, 1, 2}, X), "m", 1e-10)};
}

// Two spheres meet in free fall, seen from a moving frame.
std::vector<Record> galileo(MeasureContext&) {
  Scene scene = sample();
  scene.fingers.clear();
  scene.bodies = {scene.bodies[2], scene.bodies[2]};
  scene.bodies[1].name = "other";
  scene.starts = {{{Quat::Identity(), {0, 0, 0}}, {0.5, 0.02, 0}, {1, 2, 3}},
                  {{Quat::Identity(), {0.06, 0.01, 0}}, {-0.3, 0, 0.01}, {}}};
  Scene moving = scene;
  const Vec3 v(3, -2, 1);
  for (engine::BodyStart& start : moving.starts) start.v_W += v;
  const Pose X{Quat::Identity(), scene.duration * v};
  return {atMost("world moving at 3.7 m/s: largest change",
                 largestDistance(endPoses(scene), endPoses(moving), {0, 1}, X), "m", 1e-10)};
}

std::vector<Record> rerun(MeasureContext&) {
  Simulation a(sample()), b(sample());
  MeasureContext quiet;
  runThrough(a, quiet, [] {});
  runThrough(b, quiet, [] {});
  return {exactly("runs whose state differs in a bit",
                  engine::hashOf(a.state().world) == engine::hashOf(b.state().world) ? 0 : 1, "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyInvariance() {
  return {{"invariance/permutation", permutation},
          {"invariance/rotation", rotation},
          {"invariance/galileo", galileo},
          {"invariance/rerun", rerun}};
}

}  // namespace pincer::tasks
