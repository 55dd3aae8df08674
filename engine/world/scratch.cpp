#include "engine/world/scratch.h"

#include <algorithm>

namespace pincer::engine {

WorldScratch::WorldScratch(const WorldModel& model) : solver(model.options.max_contacts) {
  const auto contact_count = static_cast<std::size_t>(model.options.max_contacts);
  const std::size_t row_count = contact_count * kMaxContactRows;
  bodies.resize(model.bodies.size());
  points.resize(model.points.size());
  contacts.reserve(contact_count);
  columns.resize(contact_count);
  first_row.resize(contact_count + 1);
  mu.resize(contact_count);
  W.resize(row_count * row_count);
  q.resize(row_count);
  r.resize(row_count);
  u.resize(row_count);
}

std::uint64_t contactId(int kind, int a, int b, std::uint32_t feature) {
  return static_cast<std::uint64_t>(kind) << 62 | static_cast<std::uint64_t>(a & 0x7fff) << 47 |
         static_cast<std::uint64_t>(b & 0x7fff) << 32 | feature;
}

Eigen::Vector4d relativeVelocity(const Contact& c, const Motion& a, const Motion& b) {
  const Vec3 v_W = a.v_W + a.w_W.cross(c.arm_a_W) - (b.v_W + b.w_W.cross(c.arm_b_W));
  Eigen::Vector4d v_C;
  v_C.head<3>() = c.R_WC.transpose() * v_W;
  v_C[3] = c.n_W().dot(a.w_W - b.w_W);
  return v_C;
}

void addContact(WorldScratch& scratch, const Contact& contact) {
  if (scratch.contacts.size() < scratch.contacts.capacity()) {
    scratch.contacts.push_back(contact);
    return;
  }
  scratch.contacts_dropped = true;
  const auto shallowest =
      std::max_element(scratch.contacts.begin(), scratch.contacts.end(), [](const Contact& x, const Contact& y) { return x.phi < y.phi; });
  if (shallowest->phi > contact.phi) *shallowest = contact;
}

}  // namespace pincer::engine
