#include "pincer/tasks/run/robot/mjcf_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/run/robot/mjcf_document.h"

namespace pincer::tasks::mjcf {
namespace {

// Ways to say how an element is turned; it may have one of them.
constexpr std::array<std::string_view, 5> kOrientations = {"quat", "axisangle", "xyaxes", "zaxis", "euler"};
constexpr double kShortest = 1e-14;  // of a direction: MuJoCo's least length

double radians(double angle, const Compiler& compiler) {
  return compiler.degrees ? angle * (std::numbers::pi / 180) : angle;
}

// Small letters turn about the axes as they have been turned, capital ones about those that stand still.
Quat eulerQuat(const std::vector<double>& angles, const Compiler& compiler) {
  Quat q = Quat::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const char letter = compiler.euler_order[i];
    const bool moves = letter >= 'x';
    const Vec3 axis = Vec3::Unit(moves ? letter - 'x' : letter - 'X');
    const Quat step = quatOfAxisAngle(axis, radians(angles[i], compiler));
    q = moves ? q * step : step * q;
  }
  return q;
}

// The least turn that takes z to this direction.
Quat zaxisQuat(const Vec3& z) {
  const Vec3 axis = Vec3::UnitZ().cross(z);
  const double s = axis.norm();
  if (s < kShortest) return z[2] > 0 ? Quat::Identity() : Quat(0, 1, 0, 0);
  return quatOfAxisAngle(axis / s, math::atan2(s, z[2]));
}

}  // namespace

Values::Values(const Document& document, const XmlElement& element, std::string_view kind, int class_index)
    : XmlValues(element) {
  if (const std::string* name = element.find("class")) class_index = classNamed(document, *name, element);
  for (int c = class_index; c >= 0; c = document.classes[static_cast<std::size_t>(c)].parent) {
    const auto& elements = document.classes[static_cast<std::size_t>(c)].elements;
    const auto of_kind = elements.find(kind);
    if (of_kind == elements.end()) continue;
    for (auto e = of_kind->second.rbegin(); e != of_kind->second.rend(); ++e) levels_.push_back(&*e);
  }
}

std::optional<Vec2> Values::limits(std::string_view name, std::string_view switch_name, bool autolimits) const {
  constexpr std::string_view kWords[] = {"false", "true", "auto"};  // by value; auto: as the range says
  const int limited = oneOf(switch_name, kWords, 2);
  const std::optional<Vec2> ends = range(name);
  if (ends && (*ends)[0] > (*ends)[1]) reject(name, "has its ends the wrong way round. The lesser comes first.");
  const bool rises = ends && (*ends)[0] < (*ends)[1];
  if (limited == 2 && rises && !autolimits)
    reject(name, fmt::format("has no effect, as autolimits is off. Say {}=\"true\" or \"false\".", switch_name));
  if (limited == 0 || (limited == 2 && !rises)) return std::nullopt;
  if (!rises) element().reject(fmt::format("is limited and needs a {} that rises.", name));
  return ends;
}

Vec3 Values::direction(std::string_view name, const double* v) const {
  const Vec3 d(v[0], v[1], v[2]);
  if (!(d.norm() > kShortest)) reject(name, "has a direction without length.");
  return d.normalized();
}

Quat Values::turnOf(std::string_view name, const Compiler& compiler) const {
  const std::size_t count = name == "xyaxes" ? 6 : name == "quat" || name == "axisangle" ? 4 : 3;
  const std::vector<double> v = numbers(name, count, count);
  if (name == "axisangle") return quatOfAxisAngle(direction(name, v.data()), radians(v[3], compiler));
  if (name == "zaxis") return zaxisQuat(direction(name, v.data()));
  if (name == "euler") return eulerQuat(v, compiler);
  if (name == "quat") {
    const Quat q(v[0], v[1], v[2], v[3]);
    if (!(q.norm() > kShortest)) reject(name, "has no length. No turn is 1 0 0 0.");
    return q.normalized();
  }
  const Vec3 x = direction(name, v.data()), given_y(v[3], v[4], v[5]), y = given_y - x.dot(given_y) * x;
  if (!(y.norm() > kShortest)) reject(name, "has two axes along one line.");
  Mat3 R;
  R << x, y.normalized(), x.cross(y.normalized());
  return Quat(R).normalized();
}

Quat Values::orientation(const Compiler& compiler) const {
  for (const XmlElement* level : levels_) {
    const auto is_there = [&](std::string_view name) { return level->find(name) != nullptr; };
    const auto count = std::count_if(kOrientations.begin(), kOrientations.end(), is_there);
    if (count > 1) level->reject("is turned in two ways. Keep one of them.");
    if (count == 1) return turnOf(*std::find_if(kOrientations.begin(), kOrientations.end(), is_there), compiler);
  }
  return Quat::Identity();
}

}  // namespace pincer::tasks::mjcf
