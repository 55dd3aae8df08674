// mass: mass, centre of mass and inertia of solids.
#pragma once
#include <span>

#include "pincer/contact/shape.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::engine {

struct MassProperties {
  double mass = 0;             // [kg]
  Vec3 p_BBcm = Vec3::Zero();  // centre of mass [m]
  Mat3 I_BBcm = Mat3::Zero();  // inertia about the centre of mass, in B's axes [kg m^2]
};

// Principal axes: a frame I at the centre of mass in which the inertia is diagonal.
struct PrincipalInertia {
  Pose X_BI;  // I in the body's frame; identity rotation where B's axes are principal already (to round-off)
  Vec3 moments = Vec3::Zero();  // about I's axes, each > 0 [kg m^2]
};

// Volume of the solid [m^3]. Throws InputError for half-spaces and dishes, which have none.
double volumeOf(const contact::Shape& shape);

// Mass properties of a homogeneous solid of total mass `mass` > 0 [kg]. Throws InputError for half-spaces and dishes.
MassProperties massPropertiesOf(const contact::Shape& shape, double mass);

// Volume, centre and inertia of the solid that a closed, outward-oriented triangle mesh bounds, by the divergence
// theorem. Source: B. Mirtich, "Fast and accurate computation of polyhedral mass properties", J. Graphics Tools 1(2)
// (1996) 31-50. Throws InputError when the volume isn't positive (open mesh, or turned inside out).
MassProperties massPropertiesOf(const contact::TriangleMesh& mesh, double mass);
double volumeOf(const contact::TriangleMesh& mesh);

// The same solid in another frame: of `properties` in S, those in B. Rotates the
// tensor, which is about the centre of mass.
MassProperties movedBy(const Pose& X_BS, const MassProperties& properties);

// Of several solids in one frame, one or more, rigidly joined: parallel axes (Steiner). What overlaps counts twice.
MassProperties sumOf(std::span<const MassProperties> parts);

// Throws InputError when a moment isn't positive or the triangle inequality of moments is violated by more than 1e-9.
PrincipalInertia principalInertia(const MassProperties& properties);

}  // namespace pincer::engine
