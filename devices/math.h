// math: the few names that devices/ shares with the rest; devices/ sees no other folder but the functions of analysis.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pincer/contact/elementary.h"

namespace pincer {
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
}  // namespace pincer
