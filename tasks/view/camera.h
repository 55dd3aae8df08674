// camera: looks at a point from a distance; turns about it.
//
//   p_WE = p_WT + d (cos(pitch) sin(yaw), -cos(pitch) cos(yaw), sin(pitch)),  yaw
//   0 looks along +y, away from the operator
#pragma once
#include <optional>

#include "pincer/tasks/view/draw_list.h"

namespace pincer::tasks {

struct Camera {
  Vec3 target_W = Vec3::Zero();   // p_WT, what it looks at [m]
  double yaw = 0.5;               // [rad]
  double pitch = 0.35;            // over the horizon [rad], -1.5 .. 1.5
  double distance = 0.3;          // d [m], 1e-3 .. 1e3
  double opening = 30 * kDegree;  // of the view, from its lower to its upper border [rad]
  bool operator==(const Camera&) const = default;

  Vec3 eye_W() const;
  Mat4f view() const;                     // W to the camera's frame: x right, y up, looks along -z
  Mat4f projection(double aspect) const;  // to clip space
  Mat4f world_to_clip(double aspect) const { return projection(aspect) * view(); }

  // Where `p_W` is in a picture of this size [pixels, y down]; absent behind the camera.
  std::optional<Vec2> toPixel(const Vec3& p_W, int width, int height) const;
  // The place under `pixel` in the plane through `p_W` that is parallel to the picture.
  Vec3 fromPixel(const Vec2& pixel, int width, int height, const Vec3& p_W) const;

  void turn(double right, double up);               // by these angles [rad]
  void pan(double right, double up);                // by these shares of the picture's height
  void zoom(double factor);                         // distance times factor
  void frame(const Vec3& centre_W, double radius);  // so that a sphere fills the picture
};

}  // namespace pincer::tasks
