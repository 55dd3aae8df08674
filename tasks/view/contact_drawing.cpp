#include "pincer/tasks/view/contact_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pincer::tasks {
namespace {

// Colours: red, green, blue, 0 to 1; chosen by eye.
const Vec3f kStick(0.02f, 0.50f, 0.20f), kSlip(0.95f, 0.10f, 0.03f), kNormal(0.02f, 0.07f, 0.30f);
constexpr double kLeastForce = 1e-3;    // smaller ones get no arrow [N]
constexpr double kLeastWritten = 0.01;  // smaller ones aren't written beside their arrow: they would read 0.00 [N]
constexpr std::size_t kMostLabels = 8;  // more of them, and only fingers' and the selected body's forces are written
constexpr double kThin = 0.012;         // of lines, in sizes of marks

const Vec3f& gripColour(bool sliding) { return sliding ? kSlip : kStick; }

void addMarked(DrawList& list, DrawItem item, Part part) {
  item.part = part;
  list.push_back(std::move(item));
}

std::vector<const ContactSnapshot*> contactsOfFinger(const Snapshot& snapshot, int finger, int body) {
  std::vector<const ContactSnapshot*> contacts;
  for (int i = 0; i < snapshot.contact_count; ++i) {
    const ContactSnapshot& contact = snapshot.contacts[static_cast<std::size_t>(i)];
    if (contact.finger == finger && (body < 0 || contact.body == body)) contacts.push_back(&contact);
  }
  return contacts;
}

using ContactGroup = std::vector<const ContactSnapshot*>;

bool touches(const ContactSnapshot& contact, int body) {
  return body >= 0 && (contact.body == body || contact.other_body == body);
}

// Contacts whose force is written as one: all of the same two things; each by itself where the selected body has it.
std::vector<ContactGroup> contactGroups(const Snapshot& snapshot, int selected) {
  std::vector<ContactGroup> groups;
  for (int i = 0; i < snapshot.contact_count; ++i) {
    const ContactSnapshot& contact = snapshot.contacts[static_cast<std::size_t>(i)];
    const auto of_same = [&](const ContactGroup& group) {
      const ContactSnapshot& other = *group.front();
      return other.finger == contact.finger && other.body == contact.body && other.other_body == contact.other_body;
    };
    const auto found = touches(contact, selected) ? groups.end() : std::find_if(groups.begin(), groups.end(), of_same);
    found == groups.end() ? groups.push_back({&contact}) : found->push_back(&contact);
  }
  return groups;
}

// Beyond the arrows' middle end: the mean of their ends, each by its force.
std::optional<ViewLabel> labelOf(const ContactGroup& group, const Snapshot& snapshot, const ContactLook& look) {
  Vec3 sum_W = Vec3::Zero(), ends_W = Vec3::Zero();
  double newtons = 0;
  bool slips = false;
  for (const ContactSnapshot* contact : group) {
    const double force = contact->f_W.norm();
    sum_W += contact->f_W;
    ends_W += force * contact->p_W + (look.metres_per_newton * force + 0.12 * look.marks.size) * contact->f_W;
    newtons += force;
    slips |= contact->sliding;
  }
  if (sum_W.norm() < kLeastWritten) return {};
  std::string text = fmt::format("{:.2f} N", sum_W.norm());
  const double share = shareOfFinger(snapshot, *group.front());
  if (group.size() > 1)
    text += fmt::format(", {} places", group.size());
  else if (share < 1)
    text += fmt::format(", {:.0f} %", 100 * share);
  return ViewLabel{ends_W / newtons, text, slips};
}

void addPlace(const Snapshot& snapshot, const ContactSnapshot& contact, const ContactLook& look, double size,
              DrawList& list) {
  const Paint paint{.colour = gripColour(contact.sliding), .gloss = 0.5f, .glow = 0.35f};
  const auto several = contactsOfFinger(snapshot, contact.finger, -1).size();
  const bool is_one_of_several = contact.finger >= 0 && several > 1;
  const double share = shareOfFinger(snapshot, contact);
  const double radius =
      0.06 * size * (is_one_of_several ? std::clamp(std::sqrt(share * static_cast<double>(several)), 0.4, 1.4) : 1);
  const std::size_t first = list.size();
  list.push_back(
      {look.marks.ball, placed({Quat::Identity(), contact.p_W}, Vec3::Constant(radius)), paint, Layer::kMark});
  addMarkArrow(look.marks, contact.p_W, 0.45 * size * contact.n_W, kThin * size, {.colour = kNormal, .glow = 0.7f},
               list);
  for (std::size_t i = first; i < list.size(); ++i) list[i].part = Part::kContact;
  const double patch = contact.finger < 0
                           ? 0
                           : snapshot.fingers[static_cast<std::size_t>(contact.finger)].patch_radius * std::sqrt(share);
  if (!(patch > 0)) return;
  const Vec3 flat(patch, patch, 0.004 * size);
  addMarked(list,
            {look.marks.ball,
             placed(pointing(contact.p_W, contact.n_W), flat),
             {.colour = gripColour(contact.sliding), .alpha = 0.45f, .gloss = 0.2f, .glow = 0.5f},
             Layer::kMark},
            Part::kContact);
}

void addForce(const ContactSnapshot& contact, const ContactLook& look, double size, DrawList& list) {
  if (contact.f_W.norm() <= kLeastForce) return;
  const std::size_t first = list.size();
  addMarkArrow(look.marks, contact.p_W, look.metres_per_newton * contact.f_W, 0.035 * size,
               {.colour = gripColour(contact.sliding), .gloss = 0.5f, .glow = 0.35f}, list);
  for (std::size_t i = first; i < list.size(); ++i) list[i].part = Part::kForce;
}

void addCone(const ContactSnapshot& contact, const ContactLook& look, double size, DrawList& list) {
  if (contact.finger < 0 || !(contact.mu > 0)) return;
  const double height = 0.9 * size / std::sqrt(1 + contact.mu * contact.mu);
  const Vec3 stretch(contact.mu * height, contact.mu * height, height);
  addMarked(list,
            {look.cone,
             placed(pointing(contact.p_W, contact.n_W), stretch),
             {.colour = gripColour(contact.sliding), .alpha = 0.22f, .gloss = 0.2f, .glow = 0.5f},
             Layer::kMark},
            Part::kCone);
}

// The places in the order in which they lie about their middle.
void addOutline(std::vector<const ContactSnapshot*> contacts, const ContactLook& look, DrawList& list) {
  if (contacts.size() < 3) return;
  Vec3 middle_W = Vec3::Zero();
  for (const ContactSnapshot* contact : contacts) middle_W += contact->p_W / static_cast<double>(contacts.size());
  const Mat3 R_WC = frameFromNormal(contacts.front()->n_W);
  const auto angle = [&](const ContactSnapshot* contact) {
    const Vec3 p_C = R_WC.transpose() * (contact->p_W - middle_W);
    return math::atan2(p_C.y(), p_C.x());
  };
  std::sort(contacts.begin(), contacts.end(), [&](const auto* a, const auto* b) { return angle(a) < angle(b); });
  const double thin = kThin * look.marks.size;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactSnapshot &from = *contacts[i], &to = *contacts[(i + 1) % contacts.size()];
    const Vec3 way_W = to.p_W - from.p_W;
    if (!(way_W.norm() > thin)) continue;
    addMarked(list,
              {look.marks.rod,
               placed(pointing(from.p_W, way_W), Vec3(thin, thin, way_W.norm())),
               {.colour = gripColour(from.sliding || to.sliding), .glow = 0.5f},
               Layer::kMark},
              Part::kContact);
  }
}

}  // namespace

double shareOfFinger(const Snapshot& snapshot, const ContactSnapshot& contact) {
  if (contact.finger < 0) return 1;
  double all = 0;
  for (const ContactSnapshot* other : contactsOfFinger(snapshot, contact.finger, -1))
    all += std::max(0.0, other->f_W.dot(other->n_W));
  return all > 0 ? std::max(0.0, contact.f_W.dot(contact.n_W)) / all : 1;
}

void addContacts(const Snapshot& snapshot, const ViewChoice& choice, const ContactLook& look, DrawList& list) {
  for (int i = 0; i < snapshot.contact_count; ++i) {
    const ContactSnapshot& contact = snapshot.contacts[static_cast<std::size_t>(i)];
    const double size = contact.finger < 0 ? 0.4 * look.marks.size : look.marks.size;  // bodies have many
    if (choice.contacts) addPlace(snapshot, contact, look, size, list);
    if (choice.forces) addForce(contact, look, size, list);
    if (choice.cones) addCone(contact, look, size, list);
  }
  if (!choice.contacts) return;
  for (std::size_t finger = 0; finger < snapshot.fingers.size(); ++finger) {
    for (std::size_t body = 0; body < snapshot.X_WB.size(); ++body) {
      addOutline(contactsOfFinger(snapshot, static_cast<int>(finger), static_cast<int>(body)), look, list);
    }
  }
}

std::vector<ViewLabel> contactLabels(const Snapshot& snapshot, const ContactLook& look, int selected) {
  const std::vector<ContactGroup> groups = contactGroups(snapshot, selected);
  const bool only_fingers = groups.size() > kMostLabels;
  std::vector<ViewLabel> labels;
  for (const ContactGroup& group : groups) {
    const ContactSnapshot& first = *group.front();
    if (only_fingers && first.finger < 0 && !touches(first, selected)) continue;
    if (auto label = labelOf(group, snapshot, look)) labels.push_back(std::move(*label));
  }
  return labels;
}

}  // namespace pincer::tasks
