#include "pincer/tasks/app/grasp_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "pincer/grasp/finger_distance.h"
#include "pincer/grasp/grasp_quality.h"

namespace pincer::tasks {
namespace {

struct HeldBody {
  std::string name;
  grasp::GraspQuality quality;
};

std::vector<HeldBody> heldBodies(const Simulation& simulation) {
  std::vector<HeldBody> held;
  for (std::size_t i = 0; i < simulation.scene().bodies.size(); ++i) {
    const int body = static_cast<int>(i);
    if (!simulation.scene().bodies[i].dynamic) continue;
    if (grasp::graspContacts(simulation.model(), simulation.scratch(), body).empty()) continue;
    held.push_back({simulation.scene().bodies[i].name,
                    grasp::graspQuality(simulation.model(), simulation.state(), simulation.scratch(), body)});
  }
  return held;
}

const std::string& fingerName(const Simulation& simulation, const grasp::GraspContact& contact) {
  return simulation.scene().fingers[static_cast<std::size_t>(contact.finger)].model.name;
}

// "a turn about (1.00, 0.00, 0.00)" or "a push along ...", whichever is the larger part.
std::string wrenchText(const grasp::Vec6& w) {
  const bool turn = w.tail<3>().norm() > w.head<3>().norm();
  const Vec3 d = turn ? w.tail<3>().normalized() : w.head<3>().normalized();
  const bool mixed = std::min(w.tail<3>().norm(), w.head<3>().norm()) > 0.1;
  return fmt::format("{}{} ({:.2f}, {:.2f}, {:.2f})", mixed ? "mostly " : "", turn ? "a turn about" : "a push along",
                     d.x(), d.y(), d.z());
}

std::string strengthText(const grasp::GraspQuality& q) {
  if (q.force_closure) {
    return fmt::format("force closure; least resistance {:.4g} N per N of squeeze (epsilon), against {}; volume {:.3g}",
                       q.epsilon, wrenchText(q.weakest_W), q.volume);
  }
  if (q.rank < 6) return fmt::format("no force closure: nothing resists {}", wrenchText(q.weakest_W));
  return fmt::format("no force closure: no squeeze resists {}", wrenchText(q.weakest_W));
}

std::string weightText(const grasp::GraspQuality& q) {
  if (std::isinf(q.least_squeeze)) return "the fingers alone can't hold its weight";
  return fmt::format("squeeze {:.4g} N in all; its weight needs {:.4g} N", q.squeeze, q.least_squeeze);
}

// The forces that the present squeeze can resist, along the world's axes.
std::string coneText(const grasp::GraspQuality& q) {
  constexpr std::array<const char*, 6> axes = {"+x", "-x", "+y", "-y", "+z", "-z"};
  std::string pushes, turns;
  for (std::size_t k = 0; k < 6; ++k) {
    pushes += fmt::format(" {} {:.3g}", axes[k], q.squeeze * q.resisted[k]);
    turns += fmt::format(" {} {:.3g}", axes[k], 1e3 * q.squeeze * q.resisted[k + 6]);
  }
  return fmt::format("resists pushes of{} N; turns of{} N mm", pushes, turns);
}

constexpr double kNearby = 0.1;  // further fingers aren't on their way to a body [m]

std::string distanceText(const Simulation& simulation) {
  std::string out;
  for (const grasp::FingerDistance& d : grasp::fingerDistances(simulation.model(), simulation.state())) {
    if (!simulation.scene().bodies[static_cast<std::size_t>(d.body)].dynamic || d.gap > kNearby) continue;
    out += fmt::format(
        "  {:<14} {:.4g} mm from {}, at ({:.4g}, {:.4g}, {:.4g}) mm of the world, ({:.4g}, {:.4g}) mm of the pad\n",
        simulation.scene().fingers[static_cast<std::size_t>(d.finger)].model.name, 1e3 * d.gap,
        simulation.scene().bodies[static_cast<std::size_t>(d.body)].name, 1e3 * d.p_body_W.x(), 1e3 * d.p_body_W.y(),
        1e3 * d.p_body_W.z(), 1e3 * d.place_L.x(), 1e3 * d.place_L.y());
  }
  return out.empty() ? out : "\nFingers near bodies that can move\n" + out;
}

}  // namespace

std::string graspText(const Simulation& simulation) {
  const std::vector<HeldBody> held = heldBodies(simulation);
  if (held.empty()) return "\nNo finger presses a body that can move.\n" + distanceText(simulation);
  std::string out;
  for (const HeldBody& body : held) {
    const grasp::GraspQuality& q = body.quality;
    out += fmt::format("\nGrasp of {} (torques over {:.4g} mm)\n", body.name, 1e3 * q.rho);
    for (std::size_t i = 0; i < q.contacts.size(); ++i) {
      out += fmt::format("  {:<14} presses {:.4g} N, {:.1f} % of its friction left, internal force {:.4g} N\n",
                         fingerName(simulation, q.contacts[i]), q.contacts[i].f_n, 100 * q.slip_margins[i],
                         q.internal_f_W[i].norm());
    }
    out += fmt::format("  {}\n  {}\n  {}\n", strengthText(q), weightText(q), coneText(q));
  }
  return out + distanceText(simulation);
}

namespace {

void writeDistances(const Simulation& simulation, JsonWriter& json) {
  json.key("distances").beginArray();
  for (const grasp::FingerDistance& d : grasp::fingerDistances(simulation.model(), simulation.state())) {
    json.beginObject().key("finger").value(simulation.scene().fingers[static_cast<std::size_t>(d.finger)].model.name);
    json.key("body").value(simulation.scene().bodies[static_cast<std::size_t>(d.body)].name).key("gap").value(d.gap);
    json.key("p_finger_W").value(d.p_finger_W).key("p_body_W").value(d.p_body_W).key("n_W").value(d.n_W).endObject();
  }
  json.endArray();
}

}  // namespace

void writeGrasps(const Simulation& simulation, JsonWriter& json) {
  json.key("grasps").beginArray();
  for (const HeldBody& body : heldBodies(simulation)) {
    const grasp::GraspQuality& q = body.quality;
    json.beginObject().key("body").value(body.name).key("rho").value(q.rho).key("rank").value(q.rank);
    json.key("force_closure").value(q.force_closure).key("epsilon").value(q.epsilon).key("volume").value(q.volume);
    json.key("weakest_f_W").value(Vec3(q.weakest_W.head<3>())).key("weakest_tau_W").value(Vec3(q.weakest_W.tail<3>()));
    json.key("squeeze").value(q.squeeze).key("can_hold_weight").value(std::isfinite(q.least_squeeze));
    if (std::isfinite(q.least_squeeze)) json.key("least_squeeze").value(q.least_squeeze);
    json.key("contacts").beginArray();
    for (std::size_t i = 0; i < q.contacts.size(); ++i) {
      json.beginObject()
          .key("finger")
          .value(fingerName(simulation, q.contacts[i]))
          .key("normal_force")
          .value(q.contacts[i].f_n);
      json.key("slip_margin").value(q.slip_margins[i]).key("internal_f_W").value(q.internal_f_W[i]).endObject();
    }
    json.endArray().key("resisted").beginArray();
    for (const double r : q.resisted) json.value(r);
    json.endArray().endObject();
  }
  json.endArray();
  writeDistances(simulation, json);
}

}  // namespace pincer::tasks
