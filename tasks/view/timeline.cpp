#include "pincer/tasks/view/timeline.h"

#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kMostMoments = 2000;  // more, and the oldest are forgotten

int contactsOfBodies(const Snapshot& snapshot) {
  int count = 0;
  for (int i = 0; i < snapshot.contact_count; ++i) count += snapshot.contacts[static_cast<std::size_t>(i)].finger < 0;
  return count;
}

}  // namespace

void Timeline::add(const Snapshot& next) {
  if (begun_ && next.time < last_) {
    std::erase_if(moments_, [&](const TimelineMoment& moment) { return moment.time > next.time; });
    begun_ = false;
  }
  const int body_contacts = contactsOfBodies(next);
  fingers_.resize(next.fingers.size());
  for (std::size_t i = 0; i < next.fingers.size(); ++i) {
    const FingerState now{next.fingers[i].touching, next.fingers[i].touching && next.fingers[i].sliding};
    const auto tell = [&](MomentKind kind) { moments_.push_back({next.time, kind, static_cast<int>(i)}); };
    if (begun_ && now.touching != fingers_[i].touching) tell(now.touching ? MomentKind::kTouch : MomentKind::kRelease);
    if (begun_ && now.sliding && !fingers_[i].sliding) tell(MomentKind::kSlip);
    if (begun_ && now.touching && !now.sliding && fingers_[i].sliding) tell(MomentKind::kStick);
    fingers_[i] = now;
  }
  if (begun_ && (body_contacts > 0) != (body_contacts_ > 0)) {
    moments_.push_back({next.time, body_contacts > 0 ? MomentKind::kContacts : MomentKind::kRelease, -1});
  }
  if (moments_.size() > kMostMoments) moments_.erase(moments_.begin(), moments_.begin() + kMostMoments / 2);
  body_contacts_ = body_contacts;
  last_ = next.time;
  begun_ = true;
}

const TimelineMoment* Timeline::before(double time) const {
  const TimelineMoment* found = nullptr;
  for (const TimelineMoment& moment : moments_) {
    if (moment.time <= time) found = &moment;
  }
  return found;
}

std::string momentText(const TimelineMoment& moment, const std::vector<std::string>& finger_names) {
  if (moment.finger < 0) return moment.kind == MomentKind::kContacts ? "bodies touch" : "bodies part";
  const auto i = static_cast<std::size_t>(moment.finger);
  const std::string name =
      i < finger_names.size() && !finger_names[i].empty() ? finger_names[i] : "finger " + std::to_string(i + 1);
  switch (moment.kind) {
    case MomentKind::kTouch:
      return name + " touches";
    case MomentKind::kSlip:
      return name + " slips";
    case MomentKind::kStick:
      return name + " holds again";
    default:
      return name + " lets go";
  }
}

double tickStep(double span, int most) {
  PINCER_ASSERT(span > 0 && most > 0);
  const double power = math::pow(10, std::floor(math::log10(span / most)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power * most >= span) return step * power;
  }
  return 10 * power;
}

}  // namespace pincer::tasks
