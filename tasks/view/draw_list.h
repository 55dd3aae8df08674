// draw_list: what a picture is made of. Lengths in metres, frame W; what goes to the graphics card is single precision.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::tasks {

using Vec3f = Eigen::Vector3f;
using Mat4f = Eigen::Matrix4f;

struct ViewVertex {
  Vec3f p;  // [m], frame of the mesh
  Vec3f n;  // unit
  // barycentric coordinates in the triangle whose edges are to be shown; ones: no edge is near
  Vec3f edge = Vec3f::Ones();
};

struct ViewMesh {
  std::vector<ViewVertex> vertices;
  std::vector<std::uint32_t> triangles;  // three vertices each, counter-clockwise seen from outside
  // all around: no triangle is ever seen from behind, and those that are turned away needn't be drawn
  bool closed = false;
};

struct Paint {
  Vec3f colour = Vec3f(0.7f, 0.7f, 0.7f);  // linear light, 0 .. 1
  float alpha = 1;                         // under 1: drawn after all that is opaque
  float gloss = 0.35f;                     // 0 chalk .. 1 glaze
  float edges = 0;                         // how strongly the triangles' edges show
  float octants = 0;                       // how strongly they differ by turns, so that a ball is seen to turn
  float glow = 0;                          // share of the colour that needs no light: marks, which stand for no thing
  float fade = 0;      // horizontal distance from the camera's target at which it has faded out [m]; 0: never
  float grid = 0;      // spacing of the lines along x and y of the mesh [m], each tenth stronger; 0: none
  bool sheer = false;  // of the surface only its lines, and the shadows on it, are seen
};

enum class Layer : std::uint8_t {
  kSolid,   // has a shadow, hides what is behind it
  kMark,    // has none; shows through what hides it, faintly
  kGround,  // takes shadows, has none
};

// Meaning of an item, for somebody who leaves some of them out.
enum class Part : std::uint8_t { kThing, kContact, kForce, kCone, kJoint, kDevice, kGoal };

struct DrawItem {
  int mesh = 0;  // MeshSink::add
  Mat4f X_WM = Mat4f::Identity();
  Paint paint;
  Layer layer = Layer::kSolid;
  Part part = Part::kThing;
  int thing = 0;  // whose it is, for Renderer::things; 0: nobody's
};

// Who keeps the meshes that items name.
class MeshSink {
 public:
  virtual ~MeshSink() = default;
  virtual int add(const ViewMesh& mesh) = 0;  // returns its place
};

using DrawList = std::vector<DrawItem>;

// A rigid placement of a mesh that is stretched along its own axes first.
inline Mat4f placed(const Pose& X_WM, const Vec3& stretch = Vec3::Ones()) {
  Mat4f m = Mat4f::Identity();
  m.topLeftCorner<3, 3>() = (X_WM.q.toRotationMatrix() * stretch.asDiagonal()).cast<float>();
  m.topRightCorner<3, 1>() = X_WM.p.cast<float>();
  return m;
}

}  // namespace pincer::tasks
