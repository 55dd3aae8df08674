#include "pincer/grasp/energy_ledger.h"

#include "pincer/contact/functions/invariants.h"
#include "pincer/grasp/tick/scratch.h"

namespace pincer::grasp {
namespace {

// Work of friction on what slides, over the tick's last part [J], >= 0.
double slippedBy(const GraspScratch& scratch, int finger) {
  double slipped = 0;
  for (const engine::Contact& c : scratch.world.contacts) {
    if (c.a.kind != engine::SideKind::kPoint || c.a.index != finger || !c.active() || !c.sliding) continue;
    slipped -= c.r.head<2>().dot(c.u_C.head<2>());
  }
  return slipped;
}

}  // namespace

double storedByFinger(const GraspModel& model, const GraspState& state, int finger) {
  PINCER_DEMAND(isIndex(finger, model.fingers.size()) && isIndex(finger, state.world.points.size()),
                "storedByFinger: there is no such finger");
  const engine::PointState& point = state.world.points[static_cast<std::size_t>(finger)];
  const engine::DrivenPointModel& coupling = model.fingers[static_cast<std::size_t>(finger)].coupling;
  const Vec3 e = point.p_W - point.p_target_W;
  return 0.5 * e.dot(coupling.stiffness.cwiseProduct(e)) + 0.5 * coupling.mass * point.v_W.squaredNorm() +
         0.5 * coupling.turn_stiffness * point.turn_W.squaredNorm();
}

double storedEnergy(const GraspModel& model, const GraspState& state) {
  double sum = kineticEnergy(model.world, state.world) + potentialEnergy(model.world, state.world);
  for (int i = 0; i < static_cast<int>(model.fingers.size()); ++i) sum += storedByFinger(model, state, i);
  return sum;
}

EnergyLedger::EnergyLedger(const GraspModel& model, const GraspState& state) : entries_(model.fingers.size()) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    entries_[i].x_W = state.world.points[i].p_target_W;
    entries_[i].p_W = state.world.points[i].p_W;
    entries_[i].stored_at_start = storedByFinger(model, state, static_cast<int>(i));
  }
}

void EnergyLedger::add(const GraspModel& model, const GraspState& state, const GraspScratch& scratch,
                       std::span<const Vec3> f_W) {
  PINCER_DEMAND(f_W.empty() || f_W.size() == entries_.size(), "EnergyLedger: one force per finger, or none at all");
  PINCER_DEMAND(model.fingers.size() == entries_.size(), "EnergyLedger: opened for another model");
  const double h = model.world.options.h;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    EnergyAccount& a = entry.account;
    const engine::PointState& point = state.world.points[i];
    const FingerReport& report = scratch.fingers[i];
    const Vec3 way = point.p_target_W - entry.x_W, proxy_way = point.p_W - entry.p_W, stretch = proxy_way - way;
    const double held = -entry.f_held_W.dot(way), modelled = -report.f_user_W.dot(way);
    const double delivered = -report.f_contact_W.dot(proxy_way), slipped = slippedBy(scratch, static_cast<int>(i));
    const double stored = storedByFinger(model, state, static_cast<int>(i)) - entry.stored_at_start;
    const double damped = stretch.dot(model.fingers[i].coupling.damping.cwiseProduct(stretch)) / h;
    a.held += held;
    a.late += held - modelled;
    a.numerical += modelled - (stored - a.stored) - damped - delivered;
    a.stored = stored;
    a.damped += damped;
    a.slipped += slipped;
    a.to_bodies += delivered - slipped;
    entry.x_W = point.p_target_W;
    entry.p_W = point.p_W;
    entry.f_held_W = f_W.empty() ? report.f_user_W : f_W[i];
  }
}

}  // namespace pincer::grasp
