// contact pair: two geoms that touch whatever their bits say, with a friction of their own.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/mjcf_parts.h"

namespace pincer::tasks::mjcf {
namespace {

std::vector<RobotGeom>& geomsOf(Robot& robot, int body) {
  return body < 0 ? robot.world_geoms : robot.bodies[static_cast<std::size_t>(body)].geoms;
}

RobotGeomIndex geomNamed(Reading& reading, const Values& values, std::string_view attribute) {
  const std::string name = values.required(attribute);
  if (const auto at = reading.geom_bodies.find(name); at != reading.geom_bodies.end()) {
    const std::vector<RobotGeom>& geoms = geomsOf(reading.robot, at->second);
    const auto geom = std::find_if(geoms.begin(), geoms.end(), [&](const RobotGeom& g) { return g.name == name; });
    return {at->second, static_cast<int>(geom - geoms.begin())};
  }
  std::vector<std::string_view> names;
  for (const auto& [known, body] : reading.geom_bodies) names.push_back(known);
  values.reject(attribute, fmt::format("is the name of no geom.{}", suggestion(name, names)));
}

// Sliding along two axes, turning, rolling about two: those that are missing are as the one before, or MJCF's.
std::optional<RobotFriction> readFriction(const Values& values) {
  const int dimensions = values.whole("condim", 0);
  if (dimensions != 0) requireDimensions(values, dimensions);
  const std::vector<double> given = values.numbers("friction", 1, 5);
  if (given.empty() && dimensions == 0) return std::nullopt;
  if (given.empty() || dimensions == 0)
    values.element().reject("needs both condim and friction, or neither: one alone mixes with what the geoms say.");
  std::vector<double> f = {1, 1, 0.005, 0.0001, 0.0001};
  std::copy(given.begin(), given.end(), f.begin());
  if (given.size() == 1) f[1] = f[0];
  if (given.size() == 4) f[4] = f[3];
  if (f[0] != f[1] || (dimensions == 6 && f[3] != f[4]))
    values.reject("friction", "isn't the same along both axes, as it is here. Give both the same number.");
  if (*std::min_element(f.begin(), f.end()) < 0) values.reject("friction", "has a negative coefficient.");
  return frictionOf(dimensions, Vec3(f[0], f[2], f[3]));
}

// A bit that no geom has: the first geom of the pair is that to the second.
void letTouch(Reading& reading, const Values& values, RobotGeom& a, RobotGeom& b) {
  if (canTouch(a, b)) return;
  unsigned taken = 0;
  const auto collect = [&](const std::vector<RobotGeom>& geoms) {
    for (const RobotGeom& g : geoms) taken |= static_cast<unsigned>(g.contype) | static_cast<unsigned>(g.conaffinity);
  };
  collect(reading.robot.world_geoms);
  for (const RobotBody& body : reading.robot.bodies) collect(body.geoms);
  unsigned bit = 1;
  constexpr unsigned kLast = 1u << 30;  // contype is a signed number in the file
  while ((taken & bit) != 0 && bit < kLast) bit <<= 1;
  if ((taken & bit) != 0)
    values.element().reject("is one too many: all 31 bits of contype and conaffinity are taken. Use these instead.");
  a.contype |= static_cast<int>(bit);
  b.conaffinity |= static_cast<int>(bit);
}

}  // namespace

void readPair(Reading& reading, const XmlElement& element) {
  const Values values(reading.document, element, "pair", 0);
  RobotPair pair{geomNamed(reading, values, "geom1"), geomNamed(reading, values, "geom2"), readFriction(values),
                 element.place()};
  RobotGeom& a = geomsOf(reading.robot, pair.a.body)[static_cast<std::size_t>(pair.a.geom)];
  RobotGeom& b = geomsOf(reading.robot, pair.b.body)[static_cast<std::size_t>(pair.b.geom)];
  letTouch(reading, values, a, b);
  reading.robot.pairs.push_back(std::move(pair));
}

}  // namespace pincer::tasks::mjcf
