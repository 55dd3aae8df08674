#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

using namespace tasks;

// of a world that is stepped: a tick of more costs what a fuzzer has better use for
constexpr std::size_t kMostBodies = 12;
constexpr int kTicks = 8;

// A folder that isn't there: files that a scene names are refused.
const char* const kName = "/nowhere/fuzz.json";

void demandFinite(const Simulation& simulation) {
  for (const auto& body : simulation.state().world.bodies) {
    demand(body.X_WI.p.allFinite() && body.X_WI.q.coeffs().allFinite(), "poses stay finite");
    demand(body.v_W.allFinite() && body.L_W.allFinite(), "velocities stay finite");
  }
  for (const auto& finger : simulation.fingers()) demand(finger.f_user_W.allFinite(), "forces stay finite");
}

}  // namespace

void scene(Bytes input) {
  readsOrRefuses([&] { buildWorld(parseScene(textOf(input), kName)); });
}

void scene_step(Bytes input) {
  readsOrRefuses([&] {
    Scene scene = parseScene(textOf(input), kName);
    if (scene.bodies.size() > kMostBodies) return;
    Simulation simulation(std::move(scene));
    for (int i = 0; i < kTicks; ++i) {
      simulation.tick();
      demandFinite(simulation);
    }
  });
}

}  // namespace pincer::fuzz
