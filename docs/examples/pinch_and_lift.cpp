// Two fingers close on a bumpy stone, lift it by 50 mm and hold it.
#include <pincer/pincer.h>

#include <algorithm>
#include <cstdio>

using namespace pincer;

int main() {
  // The world: a floor and a stone of 80 g, felt as a smooth surface. (A file:
  // contact::readMesh, pincer/contact/mesh_reader.h.)
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({.name = "floor", .shape = contact::HalfSpace{}, .dynamic = false});
  const auto surface = contact::SmoothMesh::build(contact::bumpySphere(0.020, 0.08, 3, 12));
  const int stone = builder.addBody({.name = "stone",
                                     .shape = contact::Mesh{surface},
                                     .mass = 0.08,
                                     .material = {.mu_s = 0.6, .mu_d = 0.5, .torsion_radius = 3e-3}});

  // Two fingertips of 8 mm, each on a spring of 500 N/m.
  std::vector<grasp::FingerModel> fingers(2);
  for (auto& finger : fingers) finger.coupling.stiffness.setConstant(500);
  const grasp::GraspModel model = grasp::buildGrasp(std::move(builder), fingers);

  // The stone lies at rest, the fingers wait beside it.
  const std::vector<engine::BodyStart> starts = {{}, {.X_WB = {Quat::Identity(), Vec3(0, 0, 0.021)}}};
  grasp::GraspState state = grasp::makeState(model, starts, {Vec3(-0.05, 0, 0.02), Vec3(0.05, 0, 0.02)});
  const grasp::ScratchHandle scratch = grasp::makeScratch(model);

  // Every millisecond the devices say where the fingers are. Here: one second
  // closing, one second lifting, one second holding.
  std::vector<grasp::FingerInput> inputs(2);
  for (int tick = 1; tick <= 3000; ++tick) {
    const double closing = std::min(tick / 1000.0, 1.0), lifting = std::clamp(tick / 1000.0 - 1, 0.0, 1.0);
    const double x = 0.05 - 0.026 * closing;  // 24 mm: 4 mm into the surface
    inputs[0].p_WF = Vec3(-x, 0, 0.02 + 0.05 * lifting);
    inputs[1].p_WF = Vec3(x, 0, 0.02 + 0.05 * lifting);
    const grasp::GraspReport report = grasp::step(model, state, *scratch, inputs);
    if (report.status & engine::kStateNotFinite) return 1;
    if (tick % 500 == 0) {
      std::printf("%.1f s: stone at %5.1f mm, fingers press with %.2f and %.2f N\n", 1e-3 * tick,
                  1e3 * engine::bodyPose(model.world, state.world, stone).p.z(), report.fingers[0].normal_force,
                  report.fingers[1].normal_force);
    }
  }
  return engine::bodyPose(model.world, state.world, stone).p.z() > 0.06 ? 0 : 1;  // lifted, and held
}
