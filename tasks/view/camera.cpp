#include "pincer/tasks/view/camera.h"

#include <algorithm>
#include <cmath>

namespace pincer::tasks {
namespace {

struct CameraAxes {
  Vec3 right, up, back;  // in W, unit
};

CameraAxes cameraAxes(const Camera& c) {
  const Vec3 back(math::cos(c.pitch) * math::sin(c.yaw), -math::cos(c.pitch) * math::cos(c.yaw), math::sin(c.pitch));
  const Vec3 right(math::cos(c.yaw), math::sin(c.yaw), 0);
  return {right, back.cross(right), back};
}

}  // namespace

Vec3 Camera::eye_W() const { return target_W + distance * cameraAxes(*this).back; }

Mat4f Camera::view() const {
  const CameraAxes axes = cameraAxes(*this);
  Mat3 R;
  R << axes.right.transpose(), axes.up.transpose(), axes.back.transpose();
  Mat4f m = Mat4f::Identity();
  m.topLeftCorner<3, 3>() = R.cast<float>();
  m.topRightCorner<3, 1>() = (-(R * eye_W())).cast<float>();
  return m;
}

Mat4f Camera::projection(double aspect) const {
  const double near = 0.05 * distance, far = 40 * distance, f = 1 / math::tan(opening / 2);
  Mat4f m = Mat4f::Zero();
  m(0, 0) = static_cast<float>(f / aspect);
  m(1, 1) = static_cast<float>(f);
  m(2, 2) = static_cast<float>((far + near) / (near - far));
  m(2, 3) = static_cast<float>(2 * far * near / (near - far));
  m(3, 2) = -1;
  return m;
}

std::optional<Vec2> Camera::toPixel(const Vec3& p_W, int width, int height) const {
  const Eigen::Vector4f clip = world_to_clip(static_cast<double>(width) / height) * p_W.cast<float>().homogeneous();
  if (!(clip.w() > 0)) return {};
  return Vec2(0.5 * width * (1 + clip.x() / clip.w()), 0.5 * height * (1 - clip.y() / clip.w()));
}

Vec3 Camera::fromPixel(const Vec2& pixel, int width, int height, const Vec3& p_W) const {
  const CameraAxes axes = cameraAxes(*this);
  const double depth = (eye_W() - p_W).dot(axes.back), scale = 2 * depth * math::tan(opening / 2) / height;
  return eye_W() - depth * axes.back +
         scale * ((pixel.x() - 0.5 * width) * axes.right + (0.5 * height - pixel.y()) * axes.up);
}

void Camera::turn(double right, double up) {
  yaw = std::remainder(yaw + right, 2 * M_PI);
  pitch = std::clamp(pitch + up, -1.5, 1.5);
}

void Camera::pan(double right, double up) {
  const CameraAxes axes = cameraAxes(*this);
  const double height = 2 * distance * math::tan(opening / 2);
  target_W += height * (right * axes.right + up * axes.up);
}

void Camera::zoom(double factor) { distance = std::clamp(distance * factor, 1e-3, 1e3); }

void Camera::frame(const Vec3& centre_W, double radius) {
  target_W = centre_W;
  distance = std::clamp(radius / math::sin(opening / 2), 1e-3, 1e3);
}

}  // namespace pincer::tasks
