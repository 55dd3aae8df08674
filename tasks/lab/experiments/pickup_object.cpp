#include "pincer/tasks/lab/experiments/pickup_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/motion/mass.h"
#include "pincer/engine/state.h"
#include "pincer/engine/step.h"
#include "pincer/tasks/lab/experiments/shaded_objects.h"

namespace pincer::tasks {
namespace {

constexpr double kSmallest = 0.005, kLargest = 0.200;  // dimension of an object that two fingers pick up [m]
constexpr double kWidestGrip = 0.100;                  // of thumb and index finger, without a stretch [m]
constexpr double kSettleTime = 20;                     // [s]
constexpr double kDampingTime = 0.1;                   // of the settling motion [s]
constexpr double kRestTime = 0.5;       // an object rests whose points have moved so little in that time [s]
constexpr double kRestDistance = 1e-3;  // [m]

double largestDimension(const contact::TriangleMesh& mesh) {
  const contact::MeshReport report = contact::inspect(mesh);
  return (report.box_max - report.box_min).maxCoeff();
}

void scaleTo(double size, contact::TriangleMesh& mesh) {
  const double largest = largestDimension(mesh);
  if (!(largest > 0))
    throw InputError(fmt::format("{}: all its points coincide: it has no size. Export it again.", mesh.source));
  for (Vec3& vertex : mesh.vertices) vertex *= size / largest;
}

void requireHandSize(const contact::TriangleMesh& mesh, const std::string& units) {
  const double largest = largestDimension(mesh);
  if (largest >= kSmallest && largest <= kLargest) return;
  throw InputError(
      fmt::format("{}: the object is {:.4g} m long when its file is read in {}; two fingers pick up {} .. {} m. "
                  "Give its length (--size 0.06) or its unit (--units m, cm, mm or in).",
                  mesh.source, largest, units, kSmallest, kLargest));
}

contact::TriangleMesh readAtHandSize(const ObjectFile& file) {
  contact::TriangleMesh mesh =
      contact::readMesh(file.path, {.metres_per_unit = file.size ? 1 : contact::metresPerUnit(file.units)});
  file.size ? scaleTo(*file.size, mesh) : requireHandSize(mesh, file.units);
  return mesh;
}

contact::TriangleMesh readCentred(const SpherePickupOptions& options) {
  contact::TriangleMesh mesh = readAtHandSize(*options.object);
  contact::requireClosed(mesh);
  const Vec3 p_BBcm = engine::massPropertiesOf(mesh, options.mass).p_BBcm;
  for (Vec3& vertex : mesh.vertices) vertex -= p_BBcm;
  return mesh;
}

double lowestOf(const contact::TriangleMesh& mesh) {
  double z = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : mesh.vertices) z = std::min(z, vertex.z());
  return z;
}

// Height over which nothing of the mesh, centred over the dish's lowest point, reaches into the dish.
double heightAboveDish(const contact::TriangleMesh& mesh, double dish_radius) {
  double height = -lowestOf(mesh);
  for (const Vec3& p : mesh.vertices) {
    const double rho2 = std::min(p.x() * p.x() + p.y() * p.y(), dish_radius * dish_radius);
    height = std::max(height, dish_radius - std::sqrt(dish_radius * dish_radius - rho2) - p.z());
  }
  return height;
}

// How far a point at most `reach` from the centre may have moved from one pose to the other.
double movement(const Pose& from, const Pose& to, double reach) {
  return (to.p - from.p).norm() + reach * angleBetween(from.q, to.q);
}

Pose settle(const SpherePickupOptions& options, const contact::Shape& shape, double height) {
  const double mu = options.frictions.front();
  const engine::WorldModel model = pickupWorld(options, shape, mu, options.dynamic_ratio * mu).build();
  engine::WorldState state =
      engine::makeState(model, {{}, {{Quat::Identity(), Vec3(0, 0, height)}, Vec3::Zero(), Vec3::Zero()}}, {});
  const engine::ScratchHandle scratch = engine::makeScratch(model);
  engine::BodyState& body = state.bodies[kObjectBody];
  const double keep = math::exp(-model.options.h / kDampingTime);
  Pose last = engine::bodyPose(model, state, kObjectBody);
  for (double next = kRestTime; state.time < kSettleTime;) {
    engine::step(model, state, *scratch);
    body.v_W *= keep;
    body.L_W *= keep;
    if (state.time < next) continue;
    const Pose pose = engine::bodyPose(model, state, kObjectBody);
    if (movement(last, pose, model.bodies[kObjectBody].bounding_radius) < kRestDistance) return pose;
    last = pose;
    next += kRestTime;
  }
  throw InputError(
      fmt::format("{}: the object finds no rest in the dish within {} s. Check that it is closed and of even density.",
                  options.object->path, kSettleTime));
}

struct Crossing {
  double x = 0;
  Vec3 n_W = Vec3::UnitX();
};

// Where the line through `p_W` along W's x axis crosses a triangle.
bool cross(const std::array<Vec3, 3>& corners_W, const Vec3& p_W, Crossing& crossing) {
  const Vec3 n_W = (corners_W[1] - corners_W[0]).cross(corners_W[2] - corners_W[0]);
  if (n_W.x() == 0) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 edge_W = corners_W[(i + 1) % 3] - corners_W[i];
    if (n_W.x() * edge_W.cross(p_W - corners_W[i]).x() < 0) return false;
  }
  crossing.x = p_W.x() + (corners_W[0] - p_W).dot(n_W) / n_W.x();
  crossing.n_W = n_W.normalized();
  return true;
}

// Width, asymmetry and normals on the pinch line.
void measurePinch(const contact::TriangleMesh& mesh, PickupObject& object) {
  Crossing left{std::numeric_limits<double>::infinity(), {}}, right{-std::numeric_limits<double>::infinity(), {}};
  for (const auto& triangle : mesh.triangles) {
    std::array<Vec3, 3> corners_W;
    for (std::size_t i = 0; i < 3; ++i)
      corners_W[i] = object.rest_X_WB * mesh.vertices[static_cast<std::size_t>(triangle[i])];
    Crossing crossing;
    if (!cross(corners_W, object.place_W, crossing)) continue;
    if (crossing.x < left.x) left = crossing;
    if (crossing.x > right.x) right = crossing;
  }
  if (!(left.x < right.x)) {
    throw InputError(fmt::format(
        "{}: no surface on the line along x through its centre of mass. Turn the object in its file.", mesh.source));
  }
  object.half_width = 0.5 * (right.x - left.x);
  object.asymmetry = std::abs(0.5 * (right.x + left.x) - object.place_W.x());
  object.antipodal_angle = math::acos(std::clamp(std::min(right.n_W.x(), -left.n_W.x()), -1.0, 1.0));
}

void requireGrip(const PickupObject& object, const std::string& source) {
  const double width = 2 * object.half_width;
  if (width <= kWidestGrip) return;
  throw InputError(fmt::format(
      "{}: where the fingers pinch it the object is {:.3g} m wide; thumb and index finger grasp up to {} m. "
      "Give a smaller --size, or turn the object in its file.",
      source, width, kWidestGrip));
}

PickupObject objectFromFile(const SpherePickupOptions& options) {
  const contact::TriangleMesh mesh = readCentred(options);
  PickupObject object;
  contact::SurfaceOptions surface;
  surface.variant = options.object->shading;
  object.shape = contact::Mesh{contact::SmoothMesh::build(mesh, surface)};
  const double start_gap = 1e-3;
  object.rest_X_WB = settle(options, object.shape, heightAboveDish(mesh, options.dish_radius) + start_gap);
  object.place_W = object.rest_X_WB.p;
  measurePinch(mesh, object);
  requireGrip(object, mesh.source);
  return object;
}

}  // namespace

PickupObject makePickupObject(const SpherePickupOptions& options) {
  validate(options);
  if (options.object) return objectFromFile(options);
  PickupObject object;
  object.shape = contact::Sphere{options.radius};
  if (options.shading) object.felt = contact::Mesh{shadedSphere(options.radius, *options.shading)};
  object.rest_X_WB.p = object.place_W = Vec3(0, 0, options.radius);
  object.half_width = options.radius;
  return object;
}

engine::WorldBuilder pickupWorld(const SpherePickupOptions& options, const contact::Shape& object, double mu_s,
                                 double mu_d) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  const engine::Material dish{options.dish_friction, options.dish_friction, 0, 0};
  builder.addBody({"dish", contact::Dish{options.dish_radius}, false, 0, dish});
  builder.addBody({"object", object, true, options.mass, {mu_s, mu_d, 0, options.torsion_radius}});
  return builder;
}

}  // namespace pincer::tasks
