// Bodies that follow keyframes, whatever touches them.
#include <fmt/format.h>

#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

Vec3 vectorOr(const JsonValue& json, std::string_view key, const NumberRule& rule, const Vec3& otherwise) {
  const JsonValue* value = json.find(key);
  return value ? value->vector(rule) : otherwise;
}

// Angular velocity of exp(a(t)) [rad/s]: J a', J = I + (1 - cos t)/t^2 [a] + (t - sin t)/t^3 [a]^2, t = |a|, [a] b = a
// x b. Source: G. S. Chirikjian, Stochastic Models, Information Theory, and Lie Groups 2, 2012, eq. (10.86).
Vec3 angularVelocityOf(const Vec3& a, const Vec3& rate) {
  const double tt = a.squaredNorm();
  const double t = std::sqrt(tt);
  const double first = tt < 1e-4 ? 0.5 - tt / 24 : (1 - math::cos(t)) / tt;
  const double second = tt < 1e-4 ? 1.0 / 6 - tt / 120 : (t - math::sin(t)) / (tt * t);
  const Vec3 across = a.cross(rate);
  return rate + first * across + second * a.cross(across);
}

}  // namespace

void requireOnward(const std::vector<TimedPoint>& points, double fastest, const JsonValue& time) {
  const std::size_t n = points.size();
  const std::string problem = n > 1 ? problemBetween(points[n - 2], points[n - 1], fastest) : "";
  if (!problem.empty()) time.reject(fmt::format("can't be: {}", problem));
}

SceneMotion readBodyTrajectory(const JsonValue& json, engine::BodyStart& start, const Vec3& start_rotation) {
  json.allowOnly(keys::kBodyTrajectory);
  std::vector<TimedPoint> places, turns;
  TimedPoint place{-1, start.X_WB.p, Vec3::Zero()}, turn{-1, start_rotation, Vec3::Zero()};
  for (const JsonValue& keyframe : json.at("keyframes", "Where the body is at which time.").array()) {
    keyframe.allowOnly(keys::kBodyKeyframe);
    const JsonValue& time = keyframe.at("time", "In seconds.");
    const double t = time.number(ranges::kTime);
    place = {t, vectorOr(keyframe, "position", ranges::kCoordinate, place.p_W), Vec3::Zero()};
    turn = {t, vectorOr(keyframe, "rotation", ranges::kRotation, turn.p_W), Vec3::Zero()};
    places.push_back(place);
    turns.push_back(turn);
    requireOnward(places, ranges::kFastest, time);
    requireOnward(turns, ranges::kFastestSpin, time);
  }
  if (places.empty()) json.reject("has no keyframe. For a body that rests, use \"static\": true.");
  const SceneMotion motion{Trajectory::throughKeyframes(places), Trajectory::throughKeyframes(turns)};
  start.X_WB = motion.at(0).X_WB;
  return motion;
}

engine::MotionInput SceneMotion::at(double time) const {
  const TimedPoint p = place.at(time), a = turn.at(time);
  return {{quatFromRotationVector(a.p_W), p.p_W}, {p.v_W, angularVelocityOf(a.p_W, a.v_W)}};
}

void bodyMotions(const Scene& scene, double time, std::span<engine::MotionInput> motions) {
  for (std::size_t i = 0; i < motions.size(); ++i) motions[i] = scene.motions[i].at(time);
}

}  // namespace pincer::tasks
