// model: fingers on a world. A finger is a driven point of the engine (its proxy, the friction-cone god-object) with a radius, a pad and a
// coupling to the device that moves it.
//
// Sources: C. B. Zilles, J. K. Salisbury, "A constraint-based god-object method for haptic display", IROS 1995, 146-151; N. Melder,
// W. S. Harwin, "Extending the friction cone algorithm for arbitrary polygon based haptic objects", HAPTICS 2004, 234-241. Departure: stick,
// slip and the bodies' motion come from one coupled solve (engine/solve), not from moving the proxy geometrically.
#pragma once
#include <string>
#include <vector>

#include "engine/world/model.h"

namespace pincer::grasp {

struct FingerModel {
  std::string name;
  double radius = 8e-3;               // of the fingertip sphere [m], > 0
  engine::DrivenPointModel coupling;  // proxy mass, stiffness and damping
  // The fingerpad frame L in the finger frame F: pad normal (out of the pad, where a flat touch lands) and distal axis (towards the nail tip).
  Vec3 pad_normal_F = Vec3(0, 0, -1);  // unit
  Vec3 distal_F = Vec3(1, 0, 0);       // unit, perpendicular to pad_normal_F
  double reach = 30e-3;                // nearer than this to a body, its nearest point is reported (for pre-positioning) [m], >= 0
};

struct GraspModel {
  engine::WorldModel world;  // its first points are the fingers' proxies, in order
  std::vector<FingerModel> fingers;
};

// Checks the fingers, adds their proxies to `builder` (which must hold no point yet) and builds the world. Throws InputError.
GraspModel buildGrasp(engine::WorldBuilder builder, std::vector<FingerModel> fingers);

}  // namespace pincer::grasp
