#include "pincer/tasks/lab/report/device_errors.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "pincer/devices/cld/tactor_error.h"
#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/lab/report/statistics.h"

namespace pincer::tasks {
namespace {

constexpr double kFrontLimit = 0.132;                       // delay of the front end [s]
constexpr double kLongestLag = 0.2;                         // [s]
constexpr double kMostLags = 200;                           // at 1 kHz; samples of a damaged session may stand closer
constexpr std::int32_t kTouchingFlag = 1, kParkedFlag = 8;  // bits of FingerRecord::flags

// A run of kept samples of one finger in which its tactor was in use.
class LagSearch {
 public:
  void add(double time, const FingerRecord& finger) {
    if (!wanted_.empty() && (time <= last_ || time > last_ + 0.5)) wanted_.clear();  // another trial, or a rest
    if (!wanted_.empty() && step_ == 0) step_ = time - last_;
    last_ = time;
    wanted_.push_back(finger.place_wanted_L);
    const double lags_wanted = step_ > 0 ? std::min(kMostLags, std::round(kLongestLag / step_)) : 0;
    const std::size_t lags = static_cast<std::size_t>(lags_wanted) + 1;
    if (squares_.size() < lags) squares_.resize(lags), counts_.resize(lags);
    if (wanted_.size() < lags || step_ == 0) return;  // every lag sees the same samples
    for (std::size_t k = 0; k < lags; ++k) {
      squares_[k] += squared(wanted_[wanted_.size() - 1 - k], finger.place_shown_L);
      ++counts_[k];
    }
  }
  static double squared(const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
  }

  double step_ = 0;
  std::vector<double> squares_;
  std::vector<std::int64_t> counts_;

 private:
  double last_ = 0;
  std::vector<std::array<double, 2>> wanted_;
};

void takeBestLag(const LagSearch& search, DeviceErrors& errors) {
  errors.step = search.step_;
  double best = -1;
  for (std::size_t k = 0; k < search.squares_.size(); ++k) {
    if (search.counts_[k] == 0 || (best >= 0 && search.squares_[k] >= best)) continue;
    best = search.squares_[k];
    errors.lag = static_cast<double>(k) * search.step_;
    errors.remains = std::sqrt(best / static_cast<double>(search.counts_[k]));
  }
}

bool inUse(const FingerRecord& finger) {
  const bool measured = std::isfinite(finger.place_shown_L[0]) && std::isfinite(finger.place_shown_L[1]);
  return measured && (finger.flags & kTouchingFlag) != 0 && (finger.flags & kParkedFlag) == 0;
}

}  // namespace

DeviceErrors deviceErrors(const SessionReader& session) {
  std::vector<double> distances;
  std::array<LagSearch, kRecordedFingers> searches;
  std::int64_t beyond = 0;
  session.forEachSample({}, [&](const SampleRecord& sample) {
    for (std::size_t i = 0; i < sample.fingers.size(); ++i) {
      const FingerRecord& finger = sample.fingers[i];
      if (!inUse(finger)) continue;
      distances.push_back(std::sqrt(LagSearch::squared(finger.place_wanted_L, finger.place_shown_L)));
      beyond += distances.back() > devices::kLocalisationLimit;
      searches[i].add(sample.time, finger);
    }
  });
  DeviceErrors errors;
  errors.samples = static_cast<std::int64_t>(distances.size());
  if (distances.empty()) return errors;
  errors.median = percentile(distances, 0.5);
  errors.high = percentile(distances, 0.95);
  errors.noticed = static_cast<double>(beyond) / static_cast<double>(distances.size());
  takeBestLag(searches[0], errors);
  return errors;
}

std::string deviceErrorsHtml(const DeviceErrors& e) {
  if (e.samples == 0) return "";
  std::string html = "<h2>Errors of the displays, and what people notice</h2>\n<div class=\"wide\"><table>\n" +
                     htmlRow({"measure", "display", "noticed from"}, "th");
  html += htmlRow({"place, median error [mm]", fmt::format("{:.2f}", 1e3 * e.median),
                   fmt::format("{:.1f}", 1e3 * devices::kLocalisationLimit)},
                  "td");
  html += htmlRow({"place, 95 % of errors below [mm]", fmt::format("{:.2f}", 1e3 * e.high),
                   fmt::format("{:.1f}", 1e3 * devices::kLocalisationLimit)},
                  "td");
  html += htmlRow({"samples beyond that [%]", fmt::format("{:.1f}", 100 * e.noticed), "–"}, "td");
  html += htmlRow({"lag, index finger [ms]", fmt::format("{:.0f} ± {:.1f}", 1e3 * e.lag, 0.5e3 * e.step),
                   fmt::format("{:.0f} (front end: {:.0f})", 1e3 * devices::kDelayLimit, 1e3 * kFrontLimit)},
                  "td");
  html += htmlRow({"what remains without the lag, root mean square [mm]", fmt::format("{:.2f}", 1e3 * e.remains), "–"},
                  "td");
  return html +
         "</table></div>\n<p class=\"note\">Place told and place measured on the pad, while a finger touched and its "
         "tactor wasn't parked. "
         "Limits: localisation and delay discrimination of Doxon (2014). What remains isn't play alone: nothing "
         "published says when it is "
         "noticed.</p>\n";
}

}  // namespace pincer::tasks
