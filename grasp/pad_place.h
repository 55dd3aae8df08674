// pad_place: where on its pad a finger is touched. Made where somebody asks: two arcs were 4 % of the instructions of a
// tick, and a scene without a display needs none.
#pragma once
#include "pincer/contact/math.h"
#include "pincer/grasp/model.h"

namespace pincer::grasp {

// A point of a finger's skin.
struct PadTouch {
  bool there = false;
  Quat q_WF = Quat::Identity();  // of the finger, in the middle of the tick
  Vec3 d_W = Vec3::Zero();       // from the finger's centre [m]; of a sphere the direction, of any length
  Vec3 n_W = Vec3::Zero();       // outward normal of the skin there
};

struct FingerReport;

// Arc length over the skin from the pad's centre (the finger's support point along the pad normal) to the touch, in the
// direction (distal, radial) in which it lies about the pad normal [m]; zero if nothing is there.
Vec2 placeOnPad(const FingerModel& finger, const PadTouch& touch);
// Of the fingertip's point in direction `d_F` from the centre, of any length.
Vec2 placeOnPad(const FingerModel& finger, const Vec3& d_F);
// Of any finger's surface point `p_F` [m] with outward normal `normal_F`.
Vec2 placeOnPad(const FingerModel& finger, const Vec3& p_F, const Vec3& normal_F);

// How fast the touch ran over the pad in the tick of length `h`; zero where the finger didn't touch before [m/s].
Vec2 placeRateOnPad(const FingerModel& finger, const FingerReport& report, double h);

}  // namespace pincer::grasp
