#include "pincer/tasks/view/chart_board.h"

#include <algorithm>
#include <cmath>

namespace pincer::tasks {
namespace {

enum Charted : std::size_t {
  kGripForce,
  kBodyHeight,
  kTickTime,
  kBodySpeed,
  kBodyTurn,
  kBodyPlace,
  kBodyLoad,
  kFrictionUsed
};

// `dead`: smaller values are round-off of what the engine computes, and nobody's concern.
struct ChartedQuantity {
  const char* name;
  const char* unit;
  double dead;
  bool of_fingers, of_body;
};
// Title, unit, `dead` in that unit, if of each finger, if of a body; in the order of the keys 1 to 8.
constexpr std::array<ChartedQuantity, ChartBoard::kQuantities> kCharted = {{{"grip force", "N", 1e-3, true, false},
                                                                            {"height", "mm", 1e-3, false, true},
                                                                            {"tick", "us", 1e-3, false, false},
                                                                            {"speed", "mm/s", 1e-2, false, true},
                                                                            {"turned", "deg", 1e-3, false, true},
                                                                            {"place", "mm", 1e-3, false, true},
                                                                            {"contact forces", "N", 1e-3, false, true},
                                                                            {"friction used", "", 1e-3, true, false}}};
constexpr std::size_t kShownAtFirst = 3;  // of them; chosen: they leave the scene free

double loadOf(const Snapshot& snapshot, int body) {
  double sum = 0;
  for (int i = 0; i < snapshot.contact_count; ++i) {
    const ContactSnapshot& contact = snapshot.contacts[static_cast<std::size_t>(i)];
    if (contact.body == body || contact.other_body == body) sum += contact.f_W.norm();
  }
  return sum;
}

// The largest over the finger's contacts; 0 where none pushes.
double frictionUsed(const Snapshot& snapshot, int finger) {
  double most = 0;
  for (int i = 0; i < snapshot.contact_count; ++i) {
    const ContactSnapshot& contact = snapshot.contacts[static_cast<std::size_t>(i)];
    const double normal = contact.f_W.dot(contact.n_W);
    if (contact.finger != finger || !(normal > 0) || !(contact.mu > 0)) continue;
    most = std::max(most, (contact.f_W - normal * contact.n_W).norm() / (contact.mu * normal));
  }
  return most;
}

}  // namespace

ChartBoard::ChartBoard(const Snapshot& start, const std::vector<std::string>& fingers) : start_X_WB_(start.X_WB) {
  for (std::size_t i = 0; i < kQuantities; ++i) {
    entries_[i].shown = i < kShownAtFirst;
    if (kCharted[i].of_fingers && !fingers.empty()) makeChart(i, "", fingers);
  }
  makeChart(kTickTime, "", {""});
}

void ChartBoard::makeChart(std::size_t quantity, const std::string& of, std::vector<std::string> lines) {
  const ChartedQuantity& q = kCharted[quantity];
  entries_[quantity].chart.emplace(of.empty() ? q.name : of + ", " + q.name, q.unit, std::move(lines), q.dead);
}

void ChartBoard::follow(int body, const std::string& name) {
  body_ = body;
  before_.reset();
  for (std::size_t i = 0; i < kQuantities; ++i) {
    if (kCharted[i].of_body)
      makeChart(i, name, i == kBodyPlace ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{""});
  }
}

void ChartBoard::add(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < kQuantities; ++i) {
    if (entries_[i].chart) entries_[i].chart->add(snapshot.time, valuesOf(i, snapshot));
  }
  before_ = snapshot.time;
  if (body_ >= 0) before_p_W_ = snapshot.X_WB[static_cast<std::size_t>(body_)].p;
}

Vec3 ChartBoard::offset_W(const Snapshot& snapshot) const {
  const auto body = static_cast<std::size_t>(body_);
  return snapshot.X_WB[body].p - start_X_WB_[body].p;
}

std::vector<double> ChartBoard::valuesOf(std::size_t quantity, const Snapshot& snapshot) const {
  std::vector<double> values;
  const auto body = static_cast<std::size_t>(body_);
  switch (quantity) {
    case kGripForce:
      for (const FingerSnapshot& finger : snapshot.fingers) values.push_back(finger.normal_force);
      return values;
    case kFrictionUsed:
      for (std::size_t i = 0; i < snapshot.fingers.size(); ++i)
        values.push_back(frictionUsed(snapshot, static_cast<int>(i)));
      return values;
    case kBodyHeight:
      return {1e3 * offset_W(snapshot).z()};
    case kTickTime:
      return {1e6 * snapshot.tick_seconds};
    case kBodySpeed: {
      const bool goes_on = before_ && snapshot.time > *before_;
      return {goes_on ? 1e3 * (snapshot.X_WB[body].p - before_p_W_).norm() / (snapshot.time - *before_) : std::nan("")};
    }
    case kBodyTurn:
      return {angleBetween(start_X_WB_[body].q, snapshot.X_WB[body].q) / kDegree};
    case kBodyPlace: {
      const Vec3 p_W = 1e3 * snapshot.X_WB[body].p;
      return {p_W.x(), p_W.y(), p_W.z()};
    }
    default:
      return {loadOf(snapshot, body_)};
  }
}

bool ChartBoard::toggle(std::size_t quantity) {
  Entry& entry = entries_[quantity];
  if (!entry.chart) return false;
  entry.shown = !entry.shown;
  return true;
}

std::vector<const StripChart*> ChartBoard::shown() const {
  std::vector<const StripChart*> charts;
  for (const Entry& entry : entries_) {
    if (entry.shown && entry.chart) charts.push_back(&*entry.chart);
  }
  return charts;
}

}  // namespace pincer::tasks
