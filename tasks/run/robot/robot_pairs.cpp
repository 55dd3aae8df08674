// The pairs of a robot's scene: bodies that don't touch, and bodies with a friction of their own.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "pincer/tasks/run/robot/robot_scene_parts.h"

namespace pincer::tasks {
namespace {

using Names = std::pair<std::string, std::string>;  // of two bodies of the scene, in order

Names namesOf(const std::string& a, const std::string& b) { return std::minmax(a, b); }

// Names of two bodies that don't touch.
using Apart = std::set<Names>;

void addApart(const std::string& a, const std::string& b, Apart& apart) {
  if (a != b) apart.insert(namesOf(a, b));
}

// The name of a body's link, empty of a world without geoms.
std::string linkName(SceneWriting& w, int body) {
  if (body < 0) return w.posed.robot.world_geoms.empty() ? "" : w.names.of("world", "world");
  return w.bodyName(w.posed.carrier(body));
}

// Only links can be kept apart: what else of the link touches is noted.
std::string excludedName(SceneWriting& w, const RobotExclusion& exclusion, int body) {
  if (body < 0) return linkName(w, body);
  const RobotLink& link = w.posed.links[static_cast<std::size_t>(w.posed.link_of[static_cast<std::size_t>(body)])];
  const std::vector<RobotGeom>& own = w.posed.body(body).geoms;
  const auto isOwn = [&](const RobotGeom* geom) {
    return std::any_of(own.begin(), own.end(), [&](const RobotGeom& g) { return &g == geom; });
  };
  const bool is_part = std::any_of(link.geoms.begin(), link.geoms.end(),
                                   [&](const auto& g) { return !g.first->isOnlySeen() && !isOwn(g.first); });
  if (is_part) w.notes.add("exclude of a part", "All that is fixed to it is kept apart, too.", exclusion.place);
  return w.bodyName(link.body);
}

// A body of several joints doesn't touch the body that carries it, as those of one joint don't.
void addCarried(SceneWriting& w, Apart& apart) {
  for (const RobotLink& link : w.posed.links) {
    const RobotBody& body = w.posed.body(link.body);
    if (body.joints.size() > 1 && body.parent >= 0)
      addApart(w.bodyName(link.body), w.bodyName(w.posed.carrier(body.parent)), apart);
  }
}

Apart apartOf(SceneWriting& w) {
  Apart apart;
  for (const RobotExclusion& exclusion : w.posed.robot.excluded) {
    const std::string a = excludedName(w, exclusion, exclusion.a), b = excludedName(w, exclusion, exclusion.b);
    if (!a.empty() && !b.empty()) addApart(a, b, apart);
  }
  addCarried(w, apart);
  return apart;
}

const RobotGeom* geomAt(const Robot& robot, const RobotGeomIndex& at) {
  const auto& geoms = at.body < 0 ? robot.world_geoms : robot.bodies[static_cast<std::size_t>(at.body)].geoms;
  return &geoms[static_cast<std::size_t>(at.geom)];
}

std::vector<const RobotGeom*> geomsOfLink(const PosedRobot& posed, int body) {
  std::vector<const RobotGeom*> geoms;
  if (body < 0) {
    for (const RobotGeom& geom : posed.robot.world_geoms) geoms.push_back(&geom);
    return geoms;
  }
  const int link = posed.link_of[static_cast<std::size_t>(body)];
  for (const auto& [geom, X] : posed.links[static_cast<std::size_t>(link)].geoms) geoms.push_back(geom);
  return geoms;
}

bool isJoinedTo(const PosedRobot& posed, int child, int parent) {
  const RobotBody& body = posed.body(posed.carrier(child));
  return !body.joints.empty() && body.parent >= 0 && parent >= 0 && posed.carrier(body.parent) == posed.carrier(parent);
}

class PairWriter {
 public:
  PairWriter(SceneWriting& w, const Apart& apart) : w_(w), apart_(apart) {}

  void write() {
    for (const RobotPair& pair : w_.posed.robot.pairs) add(pair);
    for (const auto& [names, friction] : frictions_) writeMaterial(names, friction);
  }

 private:
  void add(const RobotPair& pair) {
    const std::string a = linkName(w_, pair.a.body), b = linkName(w_, pair.b.body);
    const bool joined =
        pair.a.body >= 0 && pair.b.body >= 0 &&
        (isJoinedTo(w_.posed, pair.a.body, pair.b.body) || isJoinedTo(w_.posed, pair.b.body, pair.a.body));
    if (a == b || joined || apart_.count(namesOf(a, b))) {
      w_.notes.add("pair of links that never touch",
                   "One link, two that a joint holds together, or two that are excluded.", pair.place);
      return;
    }
    if (!pair.friction) return;
    requireAlone(pair);
    const auto [at, is_new] = frictions_.emplace(namesOf(a, b), *pair.friction);
    if (!is_new && !(at->second == *pair.friction)) reject(pair, "has another friction than another pair of them");
  }

  // Bodies have one friction for each other: whatever else of the two touches must be a pair as well.
  void requireAlone(const RobotPair& pair) const {
    std::set<std::pair<const RobotGeom*, const RobotGeom*>> paired;
    for (const RobotPair& other : w_.posed.robot.pairs) {
      if (!other.friction) continue;
      const RobotGeom *a = geomAt(w_.posed.robot, other.a), *b = geomAt(w_.posed.robot, other.b);
      paired.insert({a, b});
      paired.insert({b, a});
    }
    for (const RobotGeom* a : geomsOfLink(w_.posed, pair.a.body)) {
      for (const RobotGeom* b : geomsOfLink(w_.posed, pair.b.body)) {
        if (canTouch(*a, *b) && !paired.count({a, b}))
          reject(pair, fmt::format("isn't all that touches: so do the geoms at {} and {}", a->place, b->place));
      }
    }
  }

  [[noreturn]] static void reject(const RobotPair& pair, const std::string& why) {
    rejectAt(pair.place,
             fmt::format("<pair> gives two bodies a friction of their own, but {}. Friction is one for two bodies "
                         "here: give it to the geoms, or leave the pair's friction out.",
                         why));
  }

  void writeMaterial(const Names& names, const RobotFriction& friction) {
    w_.json.beginObject().key("bodies").beginArray().value(names.first).value(names.second).endArray();
    writeFriction(friction, w_.json);
    w_.json.endObject();
  }

  SceneWriting& w_;
  const Apart& apart_;
  std::map<Names, RobotFriction> frictions_;
};

}  // namespace

void writeFriction(const RobotFriction& friction, JsonWriter& json) {
  json.key("material").beginObject().key("mu_s").value(friction.mu);
  if (friction.torsion_radius > 0) json.key("torsion_radius").value(friction.torsion_radius);
  if (friction.rolling_radius > 0) json.key("rolling_radius").value(friction.rolling_radius);
  json.endObject();
}

void writePairs(SceneWriting& w) {
  const Apart apart = apartOf(w);
  w.json.key("pairs").beginArray();
  for (const auto& [a, b] : apart) {
    w.json.beginObject().key("bodies").beginArray().value(a).value(b).endArray().key("touch").value(false).endObject();
  }
  PairWriter(w, apart).write();
  w.json.endArray();
}

}  // namespace pincer::tasks
