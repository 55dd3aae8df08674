// shape_meshes: the shapes of contact/ as triangles to be drawn, in their own frames [m].
#pragma once
#include "pincer/contact/finger_shape.h"
#include "pincer/contact/shape.h"
#include "pincer/tasks/view/draw_list.h"

namespace pincer::tasks {

enum class MeshLook : std::uint8_t {
  kSmooth,  // the smooth surface that fingers feel, each patch cut into small triangles
  kFacets,  // the flat triangles of the file
};

// A half-space is a disc of radius `extent` [m]; a dish ends at this distance from its axis,
// and has a rim and an outside to be seen.
ViewMesh shapeMesh(const contact::Shape& shape, MeshLook look, double extent);

// A fingertip that isn't a sphere, in its own frame F: faces flat, edges round, where it touches.
ViewMesh tipMesh(const contact::FingerShape& tip);

// Of unit size, to be stretched: a ball of radius 1; a rod of radius 1 from z = 0 to 1; a cone with its apex
// at the origin, open towards z = 1, where its radius is 1, and the same closed and pointing the other way
// (an arrow's head: base at z = 0, tip at 1).
ViewMesh ballMesh();
ViewMesh rodMesh();
ViewMesh openConeMesh();
ViewMesh arrowHeadMesh();

// A fingertip of radius 1 about the origin, its pad towards -z: the finger comes from -x, rounded
// at both ends, `length` long behind the centre. The pad is the part of the ball within `angle` of
// -z, a little proud; the nail lies opposite.
ViewMesh fingerMesh(double length);
ViewMesh padMesh(double angle);
ViewMesh nailMesh();

// How many triangles each patch is cut into, so that the whole has about `kDrawnTriangles`.
constexpr int kDrawnTriangles = 60000;

}  // namespace pincer::tasks
