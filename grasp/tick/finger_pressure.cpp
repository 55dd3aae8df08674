#include <algorithm>

#include "pincer/grasp/pad_place.h"
#include "pincer/grasp/pressure_map.h"
#include "pincer/grasp/tick/finger_tick.h"

namespace pincer::grasp {
namespace {

// A force on the finger as the world has it.
struct TouchForce {
  Vec3 d_W;        // from the finger's centre to the place [m]
  Vec3 n_W;        // outward normal of the body
  Vec3 f_W;        // [N]
  double torsion;  // about n_W [N m]
};

// `axis_F`, tangent to the pad at its centre, carried along the shortest way to where the skin's normal is `m_F`.
Vec3 carried(const Vec3& axis_F, const Vec3& pad_normal_F, const Vec3& m_F) {
  const double cosine = pad_normal_F.dot(m_F);
  constexpr double kOpposite = 1e-9;  // on the nail, where every way is as short
  if (1 + cosine < kOpposite) return axis_F;
  return axis_F - axis_F.dot(m_F) / (1 + cosine) * (pad_normal_F + m_F);
}

PadForce padForceOf(const FingerModel& finger, const Quat& q_WF, const TouchForce& touch, double radius) {
  const Quat q_FW = q_WF.conjugate();
  const Vec3 d_F = q_FW * touch.d_W, m_F = -(q_FW * touch.n_W), f_F = q_FW * touch.f_W;
  const Vec3 distal_F = carried(finger.distal_F, finger.pad_normal_F, m_F);
  const Vec3 radial_F = carried(finger.pad_normal_F.cross(finger.distal_F), finger.pad_normal_F, m_F);
  PadForce pad;
  pad.place = finger.shape ? placeOnPad(finger, d_F, m_F) : placeOnPad(finger, d_F);
  pad.force = {-f_F.dot(m_F), {f_F.dot(distal_F), f_F.dot(radial_F)}};
  pad.torsion = -touch.torsion;
  pad.radius = radius;
  pad.hertz = finger.pad.modulus > 0;
  return pad;
}

}  // namespace

void mapPressure(const GraspModel& model, int finger, FingersContacts contacts, GraspScratch& scratch) {
  const FingerModel& f = model.fingers[finger];
  if (!f.taxels.isOn()) return;
  std::vector<Taxel>& map = scratch.taxels[finger];
  FingerReport& report = scratch.fingers[finger];
  report.pressure = map;
  std::fill(map.begin(), map.end(), Taxel{});
  if (!report.touching) return;
  const Quat& q_WF = scratch.q_mid_WF[finger];
  const Vec3& p_mid_W = scratch.world.points[finger].p_mid_W;
  const auto put = [&](const TouchForce& touch, double radius) {
    report.off_grid += spread(f.taxels, padForceOf(f, q_WF, touch, radius), map);
  };
  const double h = scratch.world.h;
  const bool is_cut = h < model.world.options.h;
  if (is_cut) return put({report.touch.d_W, report.n_W, report.f_contact_W, report.torsion}, 0);
  for (const engine::Contact& c : contacts) {
    if (!c.active()) continue;
    const double e = engine::rowsOf(c.material) > engine::kTorsionRow ? c.material.torsion_radius : 0;
    const double torsion = e > 0 ? c.r[engine::kTorsionRow] * e / h : 0;
    put({c.p_W - p_mid_W, c.n_W(), c.impulse_W / h, torsion}, e);
  }
}

}  // namespace pincer::grasp
