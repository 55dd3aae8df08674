#include "pincer/tasks/view/words.h"

#include <fmt/format.h>

#include <cmath>

namespace pincer::tasks {
namespace {

std::string gripWords(bool sliding) { return sliding ? "slides" : "sticks"; }

std::string nameAt(const std::vector<std::string>& names, int i, const char* else_name) {
  const bool named = i >= 0 && i < static_cast<int>(names.size()) && !names[static_cast<std::size_t>(i)].empty();
  return named ? names[static_cast<std::size_t>(i)] : else_name;
}

}  // namespace

std::string motionWords(const BodyRow& row) {
  const Vec3 mm = (1e3 * row.p_W).unaryExpr([](double v) { return std::abs(v) < 0.05 ? 0.0 : v; });  // no "-0.0"
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm  {:.1f} mm/s  turned {:.1f}°", mm.x(), mm.y(), mm.z(),
                     1e3 * row.speed, row.turn / kDegree);
}

std::string fingerWords(const FingerSnapshot& finger) {
  if (!finger.touching) return "in the air";
  std::string words = fmt::format("{:.2f} N, {}", finger.normal_force, gripWords(finger.sliding));
  if (finger.place_L)
    words += fmt::format("; on the pad {:.1f} mm distal, {:.1f} mm radial", 1e3 * finger.place_L->x(),
                         1e3 * finger.place_L->y());
  return words;
}

std::string contactWords(const Snapshot& snapshot, int body, const std::vector<std::string>& fingers,
                         const std::vector<std::string>& bodies) {
  std::string words;
  for (int i = 0; i < snapshot.contact_count; ++i) {
    const ContactSnapshot& contact = snapshot.contacts[static_cast<std::size_t>(i)];
    if (contact.body != body && contact.other_body != body) continue;
    const int other = contact.body == body ? contact.other_body : contact.body;
    const std::string with =
        contact.finger >= 0 ? nameAt(fingers, contact.finger, "a finger") : nameAt(bodies, other, "a body");
    words += fmt::format("{}{} {:.2f} N, {}", words.empty() ? "" : "\n", with, contact.f_W.norm(),
                         gripWords(contact.sliding));
  }
  return words;
}

}  // namespace pincer::tasks
