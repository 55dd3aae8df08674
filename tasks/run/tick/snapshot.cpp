#include "pincer/tasks/run/tick/snapshot.h"

#include "pincer/grasp/step.h"

namespace pincer::tasks {
namespace {

ContactSnapshot seenContact(const engine::ContactReport& c) {
  return {c.point, c.body, c.other_body, c.p_W, c.n_W, c.f_W, c.mu, c.sliding};
}

}  // namespace

Snapshot Snapshot::sizedFor(const grasp::GraspModel& model) {
  Snapshot snapshot;
  snapshot.X_WB.resize(model.world.bodies.size());
  snapshot.fingers.resize(model.fingers.size());
  snapshot.drive_forces.resize(model.world.drives.size());
  snapshot.contacts.resize(static_cast<std::size_t>(model.world.options.max_contacts));
  return snapshot;
}

void captureGrasp(const grasp::GraspModel& model, const grasp::GraspState& state, const grasp::GraspScratch& scratch,
                  const engine::StepReport& report, Snapshot& snapshot) {
  snapshot.tick = state.world.tick;
  snapshot.time = state.world.time;
  snapshot.status = report.status;
  snapshot.asleep = report.asleep;
  for (std::size_t i = 0; i < snapshot.X_WB.size(); ++i) {
    snapshot.X_WB[i] = engine::bodyPose(model.world, state.world, static_cast<int>(i));
  }
  const std::span<const grasp::FingerReport> fingers = grasp::fingersOf(scratch);
  for (std::size_t i = 0; i < snapshot.fingers.size(); ++i) {
    const grasp::FingerReport& finger = fingers[i];
    FingerSnapshot& seen = snapshot.fingers[i];
    seen.p_WP = state.world.points[i].p_W;
    seen.p_WF = state.world.points[i].p_target_W;
    if (model.fingers[i].shape)
      seen.q_WF = quatFromRotationVector(state.world.points[i].turn_W) * state.fingers[i].q_WF;
    seen.f_user_W = finger.f_user_W;
    seen.normal_force = finger.normal_force;
    seen.patch_radius = finger.patch_radius;
    seen.touching = finger.touching;
    seen.sliding = finger.sliding;
    seen.place_L = finger.touching ? std::optional(grasp::placeOnPad(model.fingers[i], finger.touch)) : std::nullopt;
  }
  snapshot.contact_count = 0;
  const engine::WorldScratch& world = grasp::worldOf(scratch);
  for (std::size_t d = 0; d < snapshot.drive_forces.size(); ++d)
    snapshot.drive_forces[d] = engine::driveAt(world, static_cast<int>(d)).force;
  for (int k = 0;
       k < engine::contactCount(world) && snapshot.contact_count < static_cast<int>(snapshot.contacts.size()); ++k) {
    const engine::ContactReport contact = engine::contactAt(world, k);
    if (contact.pushes) snapshot.contacts[static_cast<std::size_t>(snapshot.contact_count++)] = seenContact(contact);
  }
}

}  // namespace pincer::tasks
