#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/io/printable.h"
#include "pincer/contact/mesh/convex_pieces.h"
#include "pincer/contact/mesh/lathe.h"
#include "pincer/contact/mesh/mesh_groups.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

double length(const JsonValue& json, std::string_view key) {
  return json.at(key, "In metres.").number(ranges::kLength);
}

contact::Shape readCapsule(const JsonValue& json) {
  return contact::Capsule{length(json, "radius"), json.at("length", "In metres.").number(ranges::kStraightLength) / 2};
}

contact::Shape readCylinderWithFlat(const JsonValue& json) {
  const double radius = length(json, "radius");
  const JsonValue& flat = json.at("flat_distance", "From the axis to the flat, in metres.");
  const double distance = flat.number(ranges::kLength);
  if (distance >= radius)
    flat.reject(
        fmt::format("isn't smaller than the radius {}: nothing would be cut off. Use the type \"cylinder\".", radius));
  return contact::CylinderWithFlat{radius, length(json, "length") / 2, distance};
}

// Of all points together, along the longest axis.
void requireSize(const std::vector<Vec3>& points, const JsonValue& json) {
  if (points.empty()) return;
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double size = (high - low).maxCoeff(), farthest = std::max(high.maxCoeff(), -low.minCoeff());
  if (!isWithin(size, ranges::kLength))
    json.reject(fmt::format("has a shape of {:g} m, which {} Are the units right?", size, outOfRange(ranges::kLength)));
  if (!isWithin(farthest, ranges::kCoordinate))
    json.reject(fmt::format("has a point {:g} m from the origin, which {} Are the units right?", farthest,
                            outOfRange(ranges::kCoordinate)));
}

struct MeshSource {
  std::string path;
  contact::ReadOptions options;
};

MeshSource readMeshSource(const JsonValue& json, const std::string& scene_file) {
  const std::string& units =
      json.at("units", "The unit of the file's coordinates: \"m\", \"cm\", \"mm\" or \"in\".").text();
  const std::string path =
      besideScene(scene_file, json.at("file", "An OBJ, STL, PLY or OFF file, relative to the scene's folder.").text());
  const JsonValue* scale = json.find("scale");
  return {path, {.metres_per_unit = contact::metresPerUnit(units) * (scale ? scale->number(ranges::kScale) : 1)}};
}

// The one of the file's named parts.
contact::TriangleMesh namedPart(const MeshSource& source, const std::string& name) {
  std::vector<contact::MeshGroup> groups = contact::readMeshGroups(source.path, source.options);
  std::vector<std::string_view> names;
  for (contact::MeshGroup& group : groups) {
    if (group.name == name) return std::move(group.mesh);
    names.push_back(group.name);
  }
  throw InputError(fmt::format("{}: no part of it is called \"{}\".{}", printablePath(source.path), printable(name),
                               suggestion(name, names)));
}

contact::TriangleMesh readTriangles(const JsonValue& json, const std::string& scene_file) {
  const MeshSource source = readMeshSource(json, scene_file);
  const JsonValue* part = json.find("part");
  return part ? namedPart(source, part->text()) : contact::readMesh(source.path, source.options);
}

Vec2 readProfilePoint(const JsonValue& json) {
  const std::vector<JsonValue>& numbers = json.array();
  if (numbers.size() != 2) json.reject("must be two numbers: the distance from the axis and the height, in metres.");
  return {numbers[0].number(ranges::kCoordinate), numbers[1].number(ranges::kCoordinate)};
}

contact::TriangleMesh readLathe(const JsonValue& json, const JsonValue& profile) {
  for (const std::string_view key : {"part", "units", "scale", "file_normals"}) {
    if (const JsonValue* other = json.find(key)) other->reject("goes with \"file\" only: a \"lathe\" is in metres.");
  }
  std::vector<Vec2> points;
  if (profile.array().size() > kMostProfilePoints)
    profile.reject(fmt::format("has {} points; a profile has at most {}.", profile.array().size(), kMostProfilePoints));
  for (const JsonValue& point : profile.array()) points.push_back(readProfilePoint(point));
  const JsonValue* segments = json.find("segments");
  return contact::lathe(points,
                        segments ? segments->integer(3, 1000, "Facets around the axis; 48 is the default.") : 48);
}

// From a file, or turned.
contact::TriangleMesh readClosedTriangles(const JsonValue& json, const std::string& scene_file) {
  const JsonValue* profile = json.find("lathe");
  if ((profile != nullptr) == (json.find("file") != nullptr))
    json.reject("needs either \"file\" or \"lathe\": a mesh's file, or the profile of a turned solid.");
  if (profile) return readLathe(json, *profile);
  if (const JsonValue* segments = json.find("segments")) segments->reject("goes with \"lathe\" only.");
  return readTriangles(json, scene_file);
}

contact::SurfaceOptions readSurfaceOptions(const JsonValue& json) {
  contact::SurfaceOptions options;
  if (const JsonValue* angle = json.find("crease_angle")) {
    options.crease_angle = angle->number(ranges::kCreaseAngle);
    options.use_file_normals = false;
  }
  if (const JsonValue* normals = json.find("file_normals")) options.use_file_normals = normals->boolean();
  if (const JsonValue* shading = json.find("shading")) {
    options.variant = static_cast<contact::SurfaceVariant>(shading->oneOf(contact::kSurfaceVariantNames));
  }
  return options;
}

contact::Shape readMesh(const JsonValue& json, const std::string& scene_file) {
  const contact::SurfaceOptions options = readSurfaceOptions(json);
  try {
    contact::TriangleMesh triangles = readClosedTriangles(json, scene_file);
    requireSize(triangles.vertices, json);
    contact::requireClosed(triangles);
    return contact::Mesh{contact::SmoothMesh::build(std::move(triangles), options)};
  } catch (const InputError& error) {
    json.reject(fmt::format("can't be used: {}", error.what()));
  }
}

}  // namespace

namespace {

std::vector<Vec3> readAnyPoints(const JsonValue& json, const std::string& scene_file) {
  const JsonValue* points = json.find("points");
  if ((points != nullptr) == (json.find("file") != nullptr))
    json.reject("needs either \"points\" or \"file\": the corners of the solid, in metres, or a file that holds them.");
  if (!points) return readTriangles(json, scene_file).vertices;
  for (const std::string_view key : {"part", "units", "scale"}) {
    if (const JsonValue* other = json.find(key)) other->reject("goes with \"file\" only: \"points\" are in metres.");
  }
  std::vector<Vec3> corners;
  for (const JsonValue& point : points->array()) corners.push_back(point.vector(ranges::kCoordinate));
  return corners;
}

}  // namespace

std::vector<Vec3> readPoints(const JsonValue& json, const std::string& scene_file) {
  std::vector<Vec3> points = readAnyPoints(json, scene_file);
  if (points.size() > kMostHullPoints)
    json.reject(
        fmt::format("has {} points; a hull is made of at most {}. Leave out those inside, or simplify the mesh.",
                    points.size(), kMostHullPoints));
  requireSize(points, json);
  return points;
}

std::shared_ptr<const contact::Polytope> SceneHulls::hullOf(const std::vector<Vec3>& points) {
  const auto found =
      std::find_if(known_.begin(), known_.end(), [&](const Known& known) { return known.points == points; });
  if (found != known_.end()) return found->hull;
  known_.push_back({points, contact::Polytope::hullOf(points, "convex")});
  return known_.back().hull;
}

namespace {

contact::Shape readConvex(const JsonValue& json, const std::string& scene_file, SceneHulls& hulls) {
  try {
    return contact::Convex{hulls.hullOf(readPoints(json, scene_file))};
  } catch (const InputError& error) {
    json.reject(fmt::format("can't be used: {}", error.what()));
  }
}

using Hulls = std::vector<std::shared_ptr<const contact::Polytope>>;

Hulls hullsThatHangTogether(const MeshSource& source, const JsonValue& json) {
  const contact::TriangleMesh triangles = contact::readMesh(source.path, source.options);
  requireSize(triangles.vertices, json);
  return contact::hullsOfPieces(triangles);
}

Hulls namedHulls(const MeshSource& source, const JsonValue& json) {
  const std::vector<contact::MeshGroup> groups = contact::readMeshGroups(source.path, source.options);
  for (const contact::MeshGroup& group : groups) requireSize(group.mesh.vertices, json);
  return contact::hullsOfGroups(groups);
}

std::span<const std::string_view> keysOf(std::size_t type) {
  constexpr std::array<std::span<const std::string_view>, keys::kShapeTypes.size()> all = {
      keys::kSphere,    keys::kBox,  keys::kCapsule, keys::kCylinder, keys::kCylinderWithFlat,
      keys::kHalfSpace, keys::kDish, keys::kMesh,    keys::kConvex};
  return all[type];
}

}  // namespace

contact::Shape readShape(const JsonValue& json, const std::string& file, SceneHulls& hulls) {
  const std::size_t type = json.at("type", "One of the shapes in docs/scenes.md.").oneOf(keys::kShapeTypes);
  json.allowOnly(keysOf(type));
  const std::string_view name = keys::kShapeTypes[type];
  if (name == "sphere") return contact::Sphere{length(json, "radius")};
  if (name == "box")
    return contact::Box{json.at("size", "Edge lengths [x, y, z] in metres.").vector(ranges::kLength) / 2};
  if (name == "capsule") return readCapsule(json);
  if (name == "cylinder") return contact::Cylinder{length(json, "radius"), length(json, "length") / 2};
  if (name == "cylinder_with_flat") return readCylinderWithFlat(json);
  if (name == "dish") return contact::Dish{length(json, "radius")};
  if (name == "mesh") return readMesh(json, file);
  if (name == "convex") return readConvex(json, file, hulls);
  return contact::HalfSpace{};
}

std::vector<contact::Shape> readPieces(const JsonValue& json, const std::string& file) {
  json.allowOnly(keys::kPieces);
  const JsonValue* by_part = json.find("by_part");
  const bool are_named = by_part && by_part->boolean();
  try {
    const MeshSource source = readMeshSource(json, file);
    const auto hulls = are_named ? namedHulls(source, json) : hullsThatHangTogether(source, json);
    std::vector<contact::Shape> shapes;
    for (const auto& hull : hulls) shapes.emplace_back(contact::Convex{hull});
    return shapes;
  } catch (const InputError& error) {
    json.reject(fmt::format("can't be used: {}", error.what()));
  }
}

Pose readHalfSpacePose(const JsonValue& shape) {
  Pose X_WB;
  if (const JsonValue* point = shape.find("point")) X_WB.p = point->vector(ranges::kCoordinate);
  const JsonValue* normal = shape.find("normal");
  if (!normal) return X_WB;
  const Vec3 n = normal->vector(ranges::kDirection);
  if (!(n.norm() > ranges::kShortestDirection))
    normal->reject("has no length, so it has no direction. It points out of the solid: [0, 0, 1] for a floor.");
  X_WB.q = Quat(frameFromNormal(n.normalized())).normalized();
  return X_WB;
}

}  // namespace pincer::tasks
