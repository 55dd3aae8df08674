// model: fingers on a world. A finger is a driven point of the engine (its proxy, the friction-cone god-object) with a
// radius, a pad and a coupling to the device that moves it. Its tip may be any of finger_shape.h; its pad may be soft.
//
// Sources: C. B. Zilles, J. K. Salisbury, "A constraint-based god-object method for haptic display", IROS 1995,
// 146-151; N. Melder, W. S. Harwin, "Extending the friction cone algorithm for arbitrary polygon based haptic
// objects", HAPTICS 2004, 234-241. Departure: stick, slip and the bodies' motion come from one coupled solve
// (engine/solve), not from moving the proxy geometrically.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "pincer/contact/finger_shape.h"
#include "pincer/engine/model.h"
#include "pincer/grasp/hold_bounds.h"

namespace pincer::grasp {

// The patch that a soft pad touches with; it carries a torsional moment up to e mu f_n within
// one cone with friction (engine/model.h):
//
//   given radius a, even pressure:  e = 2 a / 3          Hertz:  a = (3 f_n R / (4 E))^(1/3),  e = 3 pi a / 16
//
//   f_n  normal force of the last tick [N];  R  effective radius of the two curvatures [m];  E  effective modulus [Pa]
// Sources: H. Hertz, J. reine angew. Math. 92 (1882) 156-171; R. D. Howe, M. R. Cutkosky,
// Int. J. Robotics Res. 15 (1996) 554-572.
struct SoftPad {
  double patch_radius = 0;      // a, given [m]; 0: not given
  double modulus = 0;           // E [Pa]; 0: no Hertz. Neither: what the body's material says
  double effective_radius = 0;  // R [m]; 0: the fingertip's radius, as on a flat body

  bool isSoft() const { return patch_radius > 0 || modulus > 0; }
};

double patchRadius(const SoftPad& pad, double tip_radius, double f_n);    // a [m]
double torsionRadius(const SoftPad& pad, double tip_radius, double f_n);  // e [m], > 0

// Taxels in rows across the pad (from proximal to distal) and columns along it, its
// middle on the pad's centre (pressure_map.h).
struct PressureGrid {
  int rows = 0, columns = 0;  // 2 .. 64 each; 0: no map, and no cost
  double pitch = 2e-3;        // from one to the next over the skin [m], > 0

  bool isOn() const { return rows > 0; }
};

struct FingerModel {
  std::string name;
  double radius = 8e-3;  // of the fingertip sphere [m], > 0
  // another tip than that sphere, in F; `radius` is then its bounding radius
  std::optional<contact::FingerShape> shape;
  engine::DrivenPointModel coupling;  // proxy mass, stiffness and damping, twist
  bool along_normal = false;          // the coupling's axes are those of the contact (t1, t2, n), not the world's
  SoftPad pad;
  PressureGrid taxels;
  // that is to carry it, if somebody said: `pincer plan` compares the coupling with what it can
  std::optional<ArmPort> arm;
  // The fingerpad frame L in the finger frame F: pad normal (out of the pad, where a flat touch
  // lands) and distal axis (towards the nail tip).
  Vec3 pad_normal_F = Vec3(0, 0, -1);  // unit
  Vec3 distal_F = Vec3(1, 0, 0);       // unit, perpendicular to pad_normal_F
  double reach = 30e-3;  // nearer than this to a body, its nearest point is reported (for pre-positioning) [m], >= 0
};

// A surface that fingers feel in place of a body's own shape, which other bodies meet and which has the mass: a mesh
// shaded smooth over a solid with a closed form.
struct FeltSurface {
  int collider = 0;  // of the world's, that it stands for
  contact::Shape shape;
};

struct GraspModel {
  engine::WorldModel world;  // its first points are the fingers' proxies, in order
  std::vector<FingerModel> fingers;
  std::vector<FeltSurface> felt = {};  // few
};

// Checks the fingers, adds their proxies to `builder` (which must hold no point yet)
// and builds the world. Throws InputError.
GraspModel buildGrasp(engine::WorldBuilder builder, std::vector<FingerModel> fingers);

// From now on fingers feel `shape` where the body has its only one. Throws InputError for a body of
// several, and for half-spaces and dishes.
void feelAs(GraspModel& model, int body, contact::Shape shape);

// The surface that fingers feel of a shape of the world.
inline const contact::Shape& feltShape(const GraspModel& model, int collider) {
  for (const FeltSurface& felt : model.felt) {
    if (felt.collider == collider) return felt.shape;
  }
  return model.world.colliders[static_cast<std::size_t>(collider)].shape;
}

}  // namespace pincer::grasp
