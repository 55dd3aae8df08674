#include "pincer/tasks/app/plan_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/app/plan_joints.h"

namespace pincer::tasks {
namespace {

struct ShapeName {
  std::string operator()(const contact::Sphere& s) const { return fmt::format("sphere r {:g} mm", 1e3 * s.radius); }
  std::string operator()(const contact::Box& b) const {
    return fmt::format("box {:g} x {:g} x {:g} mm", 2e3 * b.half.x(), 2e3 * b.half.y(), 2e3 * b.half.z());
  }
  std::string operator()(const contact::Capsule& c) const {
    return fmt::format("capsule r {:g} mm, straight part {:g} mm", 1e3 * c.radius, 2e3 * c.half_length);
  }
  std::string operator()(const contact::Cylinder& c) const {
    return fmt::format("cylinder r {:g} mm, {:g} mm long", 1e3 * c.radius, 2e3 * c.half_length);
  }
  std::string operator()(const contact::CylinderWithFlat& c) const {
    return fmt::format("cylinder r {:g} mm, {:g} mm long, flat at {:g} mm", 1e3 * c.radius, 2e3 * c.half_length,
                       1e3 * c.flat_distance);
  }
  std::string operator()(const contact::HalfSpace&) const { return "half-space"; }
  std::string operator()(const contact::Dish& d) const { return fmt::format("dish r {:g} mm", 1e3 * d.radius); }
  std::string operator()(const contact::Mesh& m) const {
    return fmt::format("mesh of {}",
                       counted(static_cast<std::int64_t>(m.surface->triangles().triangles.size()), "triangle"));
  }
  std::string operator()(const contact::Convex& c) const {
    return fmt::format("convex, {} corners, {} faces", c.hull->vertices().size(), c.hull->faces().size());
  }
};

bool isMesh(const engine::ColliderModel& c) { return std::holds_alternative<contact::Mesh>(c.shape); }
bool isSphere(const engine::ColliderModel& c) { return std::holds_alternative<contact::Sphere>(c.shape); }

std::string rotationForm(const engine::BodyModel& body) {
  switch (body.rotation.kind) {
    case engine::FreeRotation::Kind::kSpherical:
      return "rotation: spherical top, exact";
    case engine::FreeRotation::Kind::kSymmetric:
      return "rotation: symmetric top, exact";
    case engine::FreeRotation::Kind::kTriaxial:
      return "rotation: triaxial top, splitting";
  }
  return "";
}

std::string shapesForm(const engine::WorldModel& world, const engine::BodyModel& body) {
  std::vector<std::string> names;
  for (const engine::ColliderModel& c : engine::collidersOf(world, body)) names.push_back(nameOf(c.shape));
  if (names.size() == 1) return names.front();
  constexpr std::size_t kMost = 4;  // shapes that are named; chosen: they fit a line
  const std::string further = names.size() > kMost ? fmt::format(", and {} more", names.size() - kMost) : "";
  const std::size_t count = names.size();
  names.resize(std::min(count, kMost));
  return fmt::format("{} shapes: {}{}", count, fmt::join(names, ", "), further);
}

std::string bodyForm(const engine::WorldModel& world, const engine::BodyModel& body) {
  const std::string shape = shapesForm(world, body);
  if (!body.dynamic) return fmt::format("{}; static, costs nothing by itself", shape);
  const std::string touch = body.may_touch ? "" : "; touches nothing: moves in closed form alone";
  return fmt::format("{}, {:.4g} g; {}{}", shape, 1e3 * body.mass, rotationForm(body), touch);
}

std::string rowsText(const engine::Material& m) {
  std::string text = fmt::format("{} rows each, {}", engine::rowsOf(m), m.torsion_radius > 0 ? "" : "no torsion");
  if (m.torsion_radius > 0) text += fmt::format("torsion up to {:g} mm x friction", 1e3 * m.torsion_radius);
  if (m.rolling_radius > 0) text += fmt::format(", against rolling up to {:g} mm x friction", 1e3 * m.rolling_radius);
  return text;
}

std::string frictionText(const engine::Material& m) {
  return fmt::format("{}, mu_s {:g}, mu_d {:g}", rowsText(m), m.mu_s, m.mu_d);
}

std::string pairForm(const engine::WorldModel& world, const engine::PairModel& pair) {
  const auto shapes_a = engine::collidersOf(world, world.bodies[static_cast<std::size_t>(pair.a)]),
             shapes_b = engine::collidersOf(world, world.bodies[static_cast<std::size_t>(pair.b)]);
  if (pair.is_of_many)
    return fmt::format("{} by {}, those whose spheres meet; materials combined where two touch",
                       counted(std::ssize(shapes_a), "shape"), std::ssize(shapes_b));
  const bool mesh = isMesh(shapes_a[0]) || isMesh(shapes_b[0]), sphere = isSphere(shapes_a[0]) || isSphere(shapes_b[0]);
  const char* form = !mesh    ? "closed form"
                     : sphere ? "sphere on the smooth surface"
                              : "corners of the mesh's convex hull";
  return fmt::format("{}; {}", form, frictionText(pair.material));
}

std::string couplingForm(const engine::DrivenPointModel& coupling, const std::array<engine::AxisForm, 3>& forms) {
  constexpr std::array<const char*, 3> names = {"locked", "4th order", "implicit"};
  std::vector<std::string> axes;
  for (std::size_t i = 0; i < 3; ++i)
    axes.push_back(fmt::format("{} {}", "xyz"[i], names[static_cast<std::size_t>(forms[i])]));
  return fmt::format("proxy {:g} g; coupling {}", 1e3 * coupling.mass, fmt::join(axes, ", "));
}

std::string surfaceForm(const contact::Shape& shape) {
  const auto* mesh = std::get_if<contact::Mesh>(&shape);
  if (!mesh) return "closed form";
  const contact::SurfaceVariant variant = mesh->surface->variant();
  if (variant == contact::SurfaceVariant::smooth) {
    const auto patches = static_cast<std::int64_t>(mesh->surface->triangles().triangles.size());
    return fmt::format("smooth surface of {} shaded {}, warm-started search", patches,
                       patches == 1 ? "patch" : "patches");
  }
  return fmt::format("mesh with shading {}, warm-started search",
                     contact::kSurfaceVariantNames[static_cast<std::size_t>(variant)]);
}

std::string touchForm(const grasp::GraspModel& model, const engine::ColliderModel& collider) {
  if (engine::isOnlySeen(collider.bits)) return "only seen";
  const contact::Shape& felt = grasp::feltShape(model, static_cast<int>(&collider - model.world.colliders.data()));
  return fmt::format("{}; {}", surfaceForm(felt), frictionText(collider.material));
}

// The damping that the coupling asks of an arm, by Colgate and Schenkel's bound, and whether its arm has it.
std::string armForm(const grasp::FingerModel& f, double tick) {
  const double stiffness = f.coupling.stiffness.maxCoeff(), damping = f.coupling.damping.maxCoeff();
  const double needed = grasp::requiredDamping(stiffness, damping, tick);
  const std::string need =
      fmt::format("{:g} N/m and {:g} N s/m held for {:g} ms need an arm with {:.3g} N s/m of its own to be passive",
                  stiffness, damping, 1e3 * tick, needed);
  if (!f.arm) return need;
  if (f.arm->damping > needed) return fmt::format("{}; this one has {:g}", need, f.arm->damping);
  const double stable = grasp::stableStiffness(*f.arm, damping, tick),
               passive = grasp::passiveStiffness(*f.arm, damping, tick);
  return fmt::format(
      "WARNING: {}; this one has {:g}. It carries {:.3g} N/m passively and buzzes above {:.3g} N/m: lower the "
      "coupling, "
      "raise the rate, or switch passivity on",
      need, f.arm->damping, passive, stable);
}

std::string tipForm(const grasp::FingerModel& f, grasp::FingerMethod method) {
  constexpr std::array<const char*, 4> names = {"sphere", "capsule", "ellipsoid", "pad"};
  std::string text = fmt::format("r {:g} mm", 1e3 * f.radius);
  if (f.shape) text = fmt::format("{} within {:g} mm", names[f.shape->index()], 1e3 * f.radius);
  if (f.pad.isSoft())
    text += f.pad.modulus > 0 ? ", soft pad by Hertz" : fmt::format(", soft pad of {:g} mm", 1e3 * f.pad.patch_radius);
  if (f.along_normal) text += ", coupling along the contact's axes";
  if (method != grasp::FingerMethod::kProxy)
    text += fmt::format(", rendered by {}", grasp::kFingerMethodNames[static_cast<std::size_t>(method)]);
  return text;
}

// One line per body, or per shape where they differ.
void describeTouch(const grasp::GraspModel& model, const std::string& finger, const engine::BodyModel& body,
                   std::vector<PlanLine>& lines) {
  const auto shapes = engine::collidersOf(model.world, body);
  const std::string first = touchForm(model, shapes.front());
  const auto is_alike = [&](const engine::ColliderModel& c) { return touchForm(model, c) == first; };
  if (std::all_of(shapes.begin(), shapes.end(), is_alike))
    return lines.push_back({"touch", fmt::format("{} - {}", finger, body.name), first});
  for (const engine::ColliderModel& c : shapes)
    lines.push_back({"touch", fmt::format("{} - {}.{}", finger, body.name, c.name), touchForm(model, c)});
}

void describeFinger(const grasp::GraspModel& model, std::size_t finger, grasp::FingerMethod method,
                    std::vector<PlanLine>& lines) {
  const grasp::FingerModel& f = model.fingers[finger];
  lines.push_back(
      {"finger", f.name,
       fmt::format("{}, {}", tipForm(f, method), couplingForm(f.coupling, model.world.point_forms[finger]))});
  lines.push_back({"arm", f.name, armForm(f, model.world.options.h)});
  for (const engine::BodyModel& body : model.world.bodies) describeTouch(model, f.name, body, lines);
}

void describeMany(const grasp::GraspModel& model, std::vector<PlanLine>& lines) {
  const engine::WorldModel& world = model.world;
  if (world.has_broad_phase)
    lines.push_back(
        {"pairs", "broad phase",
         fmt::format("tree of the boxes of {} bodies; materials combined where two touch", world.bodies.size())});
  if (world.options.threads > 1)
    lines.push_back(
        {"solve", "threads",
         fmt::format("islands shared by {}, the same bits as on one", counted(world.options.threads, "thread"))});
}

void describeSkipped(const grasp::GraspModel& model, std::vector<PlanLine>& lines) {
  const bool bodies_touch = !model.world.pairs.empty() || model.world.has_broad_phase;
  if (!bodies_touch) lines.push_back({"skipped", "body contacts", "no two bodies can touch"});
  if (model.fingers.empty()) lines.push_back({"skipped", "finger contacts, pad places", "there are no fingers"});
  if (!bodies_touch && model.fingers.empty()) lines.push_back({"skipped", "solve", "nothing can touch"});
  if (!model.world.has_broad_phase)
    lines.push_back({"skipped", "broad phase", "every pair is looked at: cheaper for so few bodies"});
  if (model.world.options.threads == 1)
    lines.push_back({"skipped", "threads", "islands are solved one after the other"});
}

}  // namespace

std::string nameOf(const contact::Shape& shape) { return std::visit(ShapeName{}, shape); }

std::vector<PlanLine> describePlan(const grasp::GraspModel& model, const std::vector<grasp::FingerMethod>& methods) {
  std::vector<PlanLine> lines;
  const std::vector<engine::BodyModel>& bodies = model.world.bodies;
  for (const engine::BodyModel& body : bodies) lines.push_back({"body", body.name, bodyForm(model.world, body)});
  for (const engine::PairModel& pair : model.world.pairs) {
    const std::string name = fmt::format("{} - {}", bodies[static_cast<std::size_t>(pair.a)].name,
                                         bodies[static_cast<std::size_t>(pair.b)].name);
    lines.push_back({"pair", name, pairForm(model.world, pair)});
  }
  describeTrees(model.world, lines);
  for (std::size_t i = 0; i < model.fingers.size(); ++i) describeFinger(model, i, methods[i], lines);
  describeMany(model, lines);
  describeSkipped(model, lines);
  return lines;
}

}  // namespace pincer::tasks
