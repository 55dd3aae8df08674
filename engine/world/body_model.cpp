#include "pincer/engine/world/body_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"
#include "pincer/engine/motion/mass.h"

namespace pincer::engine {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();  // no limit; or what isn't finite, out of any range
constexpr double kFarthestShape = 1e3;                           // from its body's origin [m]

void checkShape(const std::string& body, const ColliderSpec& shape) {
  const std::string name = fmt::format("{}.{}", body, shape.name);
  if (shape.material) checkMaterial(name, *shape.material);
  requireRange(name + ".mass", shape.mass, 0, 1e9, "In kilograms; 0 takes its share by volume.");
  requireRange(name + ".position", shape.X_BS.p.allFinite() ? shape.X_BS.p.norm() : kLargest, 0, kFarthestShape,
               "It is in the body's frame, in metres.");
  PINCER_DEMAND(isUnit(shape.X_BS.q), "addBody: the shapes' quaternions have length 1; normalise them");
}

ColliderModel colliderOf(const std::string& name, const contact::Shape& shape, const Material& material, int body) {
  ColliderModel collider;
  collider.body = body;
  collider.name = name;
  collider.shape = shape;
  collider.material = material;
  collider.bounding_radius = contact::boundingRadius(shape);
  return collider;
}

// Of each shape: as given, or by volume of what those leave.
std::vector<double> massesOf(const BodySpec& spec, double mass) {
  double given = 0, volume = 0;
  for (const ColliderSpec& shape : spec.shapes) {
    given += shape.mass;
    if (shape.mass == 0) volume += volumeOf(shape.shape);
  }
  constexpr double kRoundOff = 1e-9;  // of the mass: sums of numbers that a person wrote
  const double left = mass - given;
  const bool fits = volume > 0 ? left > 0 : std::abs(left) <= kRoundOff * mass;
  if (!fits)
    throw InputError(fmt::format(
        "body \"{}\": its shapes' masses come to {:g} kg, its own is {:g}. Leave one of them out, or let what is "
        "left be positive for shapes without a mass.",
        spec.name, given, mass));
  std::vector<double> masses;
  for (const ColliderSpec& shape : spec.shapes)
    masses.push_back(shape.mass > 0 ? shape.mass : left * volumeOf(shape.shape) / volume);
  return masses;
}

double totalMass(const BodySpec& spec) {
  const bool has_each = !spec.shapes.empty() &&
                        std::all_of(spec.shapes.begin(), spec.shapes.end(), [](const auto& s) { return s.mass > 0; });
  if (spec.mass != 0 || !has_each) return spec.mass;
  double sum = 0;
  for (const ColliderSpec& shape : spec.shapes) sum += shape.mass;
  return sum;
}

void checkInertia(const BodySpec& spec) {
  const GivenInertia& given = *spec.inertia;
  if (!given.p_BBcm.allFinite() || !given.I_BBcm.allFinite() || !isSymmetric(given.I_BBcm))
    throw InputError(fmt::format(
        "body \"{}\": its inertia isn't finite and symmetric. Give the full tensor about the centre of mass.",
        spec.name));
  try {
    static_cast<void>(principalInertia({1, given.p_BBcm, given.I_BBcm}));
  } catch (const InputError& error) {
    throw InputError(fmt::format("body \"{}\": {}", spec.name, error.what()));
  }
}

MassProperties propertiesOf(const BodySpec& spec, double mass) {
  if (spec.inertia) {
    checkInertia(spec);
    return {mass, spec.inertia->p_BBcm, spec.inertia->I_BBcm};
  }
  if (spec.shapes.empty()) return massPropertiesOf(spec.shape, mass);
  const std::vector<double> masses = massesOf(spec, mass);
  std::vector<MassProperties> parts;
  for (std::size_t i = 0; i < masses.size(); ++i)
    parts.push_back(movedBy(spec.shapes[i].X_BS, massPropertiesOf(spec.shapes[i].shape, masses[i])));
  return sumOf(parts);
}

void setInertia(const BodySpec& spec, BodyModel& body) {
  const double mass = totalMass(spec);
  requireRange(spec.name + ".mass", mass, 1e-9, 1e9, "A dynamic body needs a positive mass in kilograms.");
  const PrincipalInertia inertia = principalInertia(propertiesOf(spec, mass));
  body.mass = mass;
  body.inverse_mass = 1 / mass;
  body.root_inverse_mass = std::sqrt(body.inverse_mass);
  body.moments = inertia.moments;
  body.X_BI = inertia.X_BI;
  body.X_IB = inertia.X_BI.inverse();
  body.body_is_inertial = inertia.X_BI.p.isZero(0) && inertia.X_BI.q.vec().isZero(0);
  body.rotation = FreeRotation(inertia.moments);
}

// Of a homogeneous solid: a slab's half thickness is the root of three times the
// mean square distance from its middle plane.
double innerRadius(const contact::Shape& shape) {
  if (isSupport(shape)) return std::numeric_limits<double>::infinity();
  const Vec3 moments = principalInertia(massPropertiesOf(shape, 1)).moments;
  return std::sqrt(std::max(3 * (0.5 * moments.sum() - moments.maxCoeff()), 0.0));
}

// margin  the world's [m]
void setExtent(const std::vector<ColliderModel>& colliders, double margin, BodyModel& body) {
  constexpr double kMarginOfRadius = 0.1;  // at most: bodies that are laid further apart aren't neighbours
  body.inner_radius = std::numeric_limits<double>::infinity();
  bool is_round = true;
  for (const ColliderModel& c : colliders) {
    const double distance = (c.X_BS.p - body.X_BI.p).norm();
    const bool is_ball = std::holds_alternative<contact::Sphere>(c.shape) && distance == 0;
    body.bounding_radius = std::max(body.bounding_radius, c.bounding_radius + distance);
    body.inner_radius = std::min(body.inner_radius, innerRadius(c.shape));
    is_round = is_round && (isSupport(c.shape) || is_ball);
    body.may_be_hollow = body.may_be_hollow || std::holds_alternative<contact::Mesh>(c.shape) ||
                         std::holds_alternative<contact::Dish>(c.shape);
  }
  body.may_be_hollow = body.may_be_hollow || colliders.size() > 1;
  body.contact_margin = body.dynamic ? std::min(margin, kMarginOfRadius * body.bounding_radius) : margin;
  body.corner_reach = is_round ? 0 : std::max(body.bounding_radius - body.inner_radius, 0.0);
}

}  // namespace

void requireRange(const std::string& what, double value, double low, double high, const char* remedy) {
  if (value >= low && value <= high) return;
  throw InputError(fmt::format("{} = {} is out of range [{}, {}]. {}", what, value, low, high, remedy));
}

void checkMaterial(const std::string& body, const Material& m) {
  requireRange(body + ".material.mu_s", m.mu_s, 0, kLargest,
               "A friction coefficient can't be negative; typical: skin on plastic 0.6.");
  requireRange(body + ".material.mu_d", m.mu_d, 0, m.mu_s, "Dynamic friction lies between 0 and static friction mu_s.");
  requireRange(body + ".material.restitution", m.restitution, 0, 1, "0 doesn't bounce, 1 keeps all speed.");
  requireRange(body + ".material.torsion_radius", m.torsion_radius, 0, 1,
               "It is about two thirds of the contact patch's radius: a few mm.");
  requireRange(
      body + ".material.rolling_radius", m.rolling_radius, 0, 1,
      "Friction times it is the arm of the force that resists rolling: a hundredth to a tenth of a ball's radius.");
  requireRange(body + ".material.stribeck_speed", m.stribeck_speed, 0, 100,
               "In m/s; 0 if friction doesn't change with speed, else about 0.01.");
}

bool isSupport(const contact::Shape& shape) {
  return std::holds_alternative<contact::HalfSpace>(shape) || std::holds_alternative<contact::Dish>(shape);
}

std::vector<ColliderModel> collidersFor(const BodySpec& spec, int number) {
  checkMaterial(spec.name, spec.material);
  std::vector<ColliderModel> colliders;
  for (const ColliderSpec& shape : spec.shapes) {
    checkShape(spec.name, shape);
    ColliderModel& collider =
        colliders.emplace_back(colliderOf(shape.name, shape.shape, shape.material.value_or(spec.material), number));
    collider.X_BS = shape.X_BS;
    collider.is_posed = !(shape.X_BS.p.isZero(0) && shape.X_BS.q.vec().isZero(0));
    collider.bits = shape.bits;
  }
  if (colliders.empty()) colliders.push_back(colliderOf(spec.name, spec.shape, spec.material, number));
  const auto is_support = [](const ColliderModel& c) { return isSupport(c.shape); };
  if (spec.dynamic && std::any_of(colliders.begin(), colliders.end(), is_support))
    throw InputError(
        fmt::format("body \"{}\": half-spaces and dishes have no mass and can't move. Make it static.", spec.name));
  return colliders;
}

BodyModel bodyFor(const BodySpec& spec, const std::vector<ColliderModel>& colliders, double margin) {
  BodyModel body;
  body.name = spec.name;
  body.collider_count = static_cast<int>(colliders.size());
  body.is_plane =
      colliders.size() == 1 && std::holds_alternative<contact::HalfSpace>(colliders[0].shape) && !colliders[0].is_posed;
  body.dynamic = spec.dynamic;
  body.driven = spec.driven;
  if (spec.dynamic) setInertia(spec, body);
  setExtent(colliders, margin, body);
  return body;
}

}  // namespace pincer::engine
