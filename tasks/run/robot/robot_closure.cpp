#include "pincer/tasks/run/robot/robot_closure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/robot/robot_pose.h"

namespace pincer::tasks {
namespace {

constexpr int kPasses = 100;          // Newton's method, its steps held short
constexpr double kLongestStep = 0.3;  // [rad, m]
constexpr double kClosed = 1e-13;     // [m, rad]
constexpr double kGood = 1e-9;        // a scene takes 1e-6
constexpr double kDifference = 1e-6;  // of a coordinate, for derivatives

struct Joint {
  std::string_view name;
  double reference;
  std::size_t at;  // its coordinate
};
// Hinges and slides.
std::vector<Joint> singleJoints(const Robot& robot) {
  std::vector<Joint> all;
  std::size_t at = 0;
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      const int count = coordinateCount(joint.kind);
      if (count == 1) all.push_back({joint.name, joint.reference, at});
      at += static_cast<std::size_t>(count);
    }
  }
  return all;
}

Pose poseOf(const std::vector<Pose>& poses, int body) {
  return body < 0 ? Pose{} : poses[static_cast<std::size_t>(body)];
}

// How far all loops and couplings are off, one after the other.
class Misses {
 public:
  explicit Misses(const Robot& robot) : robot_(robot), joints_(singleJoints(robot)) {
    for (const RobotLoop& loop : robot.loops) frames_.push_back(framesOf(robot, loop));
  }
  const std::vector<Joint>& joints() const { return joints_; }

  std::vector<double> at(const std::vector<double>& q) const {
    std::vector<double> all;
    const std::vector<Pose> poses = bodyPoses(robot_, q);
    for (std::size_t i = 0; i < frames_.size(); ++i) addLoop(robot_.loops[i], frames_[i], poses, all);
    for (const RobotCoupling& coupling : robot_.couplings) {
      if (!coupling.leader.empty()) all.push_back(missOf(coupling, q));
    }
    return all;
  }
  // The place in the file of the miss with this index.
  const Place& placeOf(std::size_t index) const {
    for (const RobotLoop& loop : robot_.loops) {
      const std::size_t count = loop.is_weld ? 6 : 3;
      if (index < count) return loop.place;
      index -= count;
    }
    for (const RobotCoupling& coupling : robot_.couplings) {
      if (!coupling.leader.empty() && index-- == 0) return coupling.place;
    }
    return robot_.couplings.back().place;
  }

 private:
  static void addLoop(const RobotLoop& loop, const LoopFrames& frames, const std::vector<Pose>& poses,
                      std::vector<double>& all) {
    const Pose X_BA = (poseOf(poses, loop.b) * frames.X_BJ).inverse() * (poseOf(poses, loop.a) * frames.X_AJ);
    for (int k = 0; k < 3; ++k) all.push_back(X_BA.p[k]);
    for (int k = 0; loop.is_weld && k < 3; ++k) all.push_back((X_BA.q.w() < 0 ? -2 : 2) * X_BA.q.vec()[k]);
  }
  const Joint& jointOf(const std::string& name) const {
    return *std::find_if(joints_.begin(), joints_.end(), [&](const Joint& joint) { return joint.name == name; });
  }
  double missOf(const RobotCoupling& coupling, const std::vector<double>& q) const {
    const Joint &leader = jointOf(coupling.leader), &follower = jointOf(coupling.follower);
    const double z = q[leader.at] - leader.reference;
    double value = 0;
    for (std::size_t k = coupling.polynomial.size(); k-- > 0;) value = value * z + coupling.polynomial[k];
    return q[follower.at] - follower.reference - value;
  }

  const Robot& robot_;
  std::vector<Joint> joints_;
  std::vector<LoopFrames> frames_;
};

using Vector = std::vector<double>;
double dot(const Vector& x, const Vector& y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

// The least step s with rows s = -miss, where the rows say something new.
Vector leastStep(std::vector<Vector> rows, const Vector& miss) {
  constexpr double kNothingNew = 1e-5;  // of a row from differences
  Vector step(rows.empty() ? 0 : rows.front().size());
  std::vector<Vector> basis;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Vector& own = rows[k];
    const double wanted = -miss[k] - dot(own, step), before = std::sqrt(dot(own, own));
    for (const Vector& other : basis) {
      const double along = dot(own, other);
      for (std::size_t i = 0; i < own.size(); ++i) own[i] -= along * other[i];
    }
    const double left = std::sqrt(dot(own, own));
    if (!(left > kNothingNew * std::max(before, 1e-3))) continue;
    for (double& x : own) x /= left;
    for (std::size_t i = 0; i < own.size(); ++i) step[i] += wanted / left * own[i];
    basis.push_back(own);
  }
  return step;
}

// How each miss changes with each of the joints that may move.
std::vector<Vector> slopes(const Misses& misses, const std::vector<std::size_t>& moved, Vector q, std::size_t count) {
  std::vector<Vector> rows(count, Vector(moved.size()));
  for (std::size_t j = 0; j < moved.size(); ++j) {
    const double at = q[moved[j]];
    q[moved[j]] = at + kDifference;
    const Vector up = misses.at(q);
    q[moved[j]] = at - kDifference;
    const Vector down = misses.at(q);
    q[moved[j]] = at;
    for (std::size_t k = 0; k < count; ++k) rows[k][j] = (up[k] - down[k]) / (2 * kDifference);
  }
  return rows;
}

std::size_t worstOf(const Vector& miss) {
  const auto worst =
      std::max_element(miss.begin(), miss.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  return static_cast<std::size_t>(worst - miss.begin());
}

}  // namespace

LoopFrames framesOf(const Robot& robot, const RobotLoop& loop) {
  const std::vector<Pose> drawn = bodyPoses(robot, drawnCoordinates(robot));
  LoopFrames frames{{Quat::Identity(), loop.p_A}, {}};
  const Pose X_BA = poseOf(drawn, loop.b).inverse() * poseOf(drawn, loop.a);
  frames.X_BJ = X_BA * frames.X_AJ;
  if (loop.p_B) frames.X_BJ.p = *loop.p_B;
  return frames;
}

void closePose(const Robot& robot, const std::vector<bool>& held, std::vector<double>& q) {
  const Misses misses(robot);
  Vector miss = misses.at(q);
  if (miss.empty()) return;
  std::vector<std::size_t> moved;
  for (const Joint& joint : misses.joints()) {
    if (!held[joint.at]) moved.push_back(joint.at);
  }
  for (int pass = 0; pass < kPasses && std::abs(miss[worstOf(miss)]) > kClosed; ++pass) {
    const Vector step = leastStep(slopes(misses, moved, q, miss.size()), miss);
    const double longest = step.empty() ? 0 : std::abs(step[worstOf(step)]),
                 share = longest > kLongestStep ? kLongestStep / longest : 1;
    for (std::size_t j = 0; j < moved.size(); ++j) q[moved[j]] += share * step[j];
    miss = misses.at(q);
  }
  const std::size_t worst = worstOf(miss);
  if (std::abs(miss[worst]) <= kGood) return;
  throw InputError(
      fmt::format("{}: can't be closed from this pose: its sides stay {:.3g} (m or rad) apart, whatever the other "
                  "joints do. Start from another "
                  "keyframe, or give \"start\" other joints.",
                  misses.placeOf(worst), std::abs(miss[worst])));
}

}  // namespace pincer::tasks
