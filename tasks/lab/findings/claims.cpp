#include "pincer/tasks/lab/findings/claims.h"

#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/lab/report/paired_test.h"

namespace pincer::tasks {
namespace {

constexpr double kByChance = 0.05;  // share of misses that chance explains [-]: the published tests' level
constexpr int kFewestStudies = 4;   // with fewer not even all of them are certainly more than half (Wilson)
// Widest half-widths of a figure that follows, over its mean and over the published one [-]: claims.h.
constexpr double kWidestOfLost = 0.25, kWidestOfKnown = 2;

bool certainlyMost(int k, int n) { return wilsonInterval(k, n).first > 0.5; }

bool isNarrow(const Claim& c, const ClaimEvidence& e) {
  return std::isnan(c.half_width) ? e.own_half <= kWidestOfLost * std::abs(c.mean)
                                  : e.own_half <= kWidestOfKnown * c.half_width;
}

std::string figureVerdict(const Claim& c, const ClaimEvidence& e) {
  if (2 * e.unsettled > e.studies) return "does not follow: no threshold";
  if (wilsonInterval(e.studies - e.hits, e.studies).first <= kByChance && isNarrow(c, e)) return "follows";
  if (certainlyMost(e.hits, e.studies)) return "would mostly look the same";
  return fmt::format("does not follow: {:.2g} times", e.mean_a / c.mean);
}

std::string orderVerdict(const Claim& c, const ClaimEvidence& e) {
  const bool tested = c.test != ClaimTest::kNone, pilot = c.mark == ClaimMark::kPilot;
  if (!pilot && certainlyMost(tested ? e.significant_that_way : e.that_way, e.studies)) return "follows";
  if (certainlyMost(e.that_way, e.studies)) return "same direction only";
  return certainlyMost(e.other_way, e.studies) ? "reversed" : "does not follow";
}

std::string nullVerdict(const Claim& c, const ClaimEvidence& e) {
  const double margin = c.margin_kind == MarginKind::kRatio ? math::log(c.margin) : c.margin;
  const bool within = std::abs(e.difference) + e.difference_half <= margin;
  if (within) return c.mark == ClaimMark::kPilot ? "same direction only" : "follows";
  if (certainlyMost(e.studies - e.significant, e.studies)) return "would mostly look the same";
  return certainlyMost(e.significant, e.studies) ? "does not follow" : "can't be told";
}

}  // namespace

std::string verdictOn(const Claim& c, const ClaimEvidence& e) {
  if (c.kind == ClaimKind::kBench || c.kind == ClaimKind::kPeopleOnly || c.kind == ClaimKind::kNotTested) return "-";
  if (e.studies == 0) return "not run";
  if (c.mark == ClaimMark::kCalibration) return "calibration";
  if (e.studies < kFewestStudies) return "too few studies";
  if (c.kind == ClaimKind::kFigure) return figureVerdict(c, e);
  return c.kind == ClaimKind::kOrder ? orderVerdict(c, e) : nullVerdict(c, e);
}

std::string claimsText() {
  std::string text;
  for (const Claim& c : publishedClaims()) {
    text += fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}\n", c.id, c.study, static_cast<int>(c.kind), c.what,
                        c.unit, c.a, c.b, c.mean, std::isnan(c.half_width) ? -1 : c.half_width,
                        static_cast<int>(c.test), static_cast<int>(c.margin_kind), c.margin, static_cast<int>(c.mark));
  }
  return text;
}

std::string claimsHash() {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const char ch : claimsText()) hash = (hash ^ static_cast<unsigned char>(ch)) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

std::string claimsJson(const std::string& hash) { return fmt::format("{{\"claims\": \"{}\"}}", hash); }

}  // namespace pincer::tasks
