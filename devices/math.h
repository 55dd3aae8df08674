// math: the few names that devices/ shares with the rest; devices/ sees no other folder.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pincer {
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
}  // namespace pincer
