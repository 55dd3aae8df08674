// claims: every published finding F1 .. F48 as one row of data, fixed before a study is
// run, and the rule by which each is judged.
//
// Source: A. J. Doxon, doctoral dissertation, University of Utah, 2014, ch. 2 to 4; half-widths and tests
// rebuilt from other printed figures where the copy at hand lost them. A simulated study is the published
// design with its number of people; the published test (two-sided, .05) is run on each. "Certainly":
// Wilson's 95 % interval of the share of studies.
//
//   figure   hit: |mean - m| <= sqrt(h^2 + h_sim^2)      follows: the misses are compatible with 5 %, and h_sim <= 2 h
//                                                        (h lost: <= m / 4), so that noisy people don't follow more
//                                                        easily;  mostly: hits in certainly more than half
//   order    a < b                                       follows: that way and significant in certainly more than half;
//                                                        same direction only: that way in certainly more than half;
//                                                        reversed: the other way in certainly more than half
//   null     a = b                                       follows: the interval of the mean difference over all studies
//                                                        lies within the margin; mostly: not significant in certainly
//                                                        more than half;  does not follow: significant in so many
//
// Bench rows, what only people can say, and what wasn't tested have no verdict here. A figure that people's limits were
// taken from ("calibration") is never counted; of a pilot of two people the best verdict is "same direction only".
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace pincer::tasks {

enum class ClaimKind : std::uint8_t { kFigure, kOrder, kNull, kBench, kPeopleOnly, kNotTested };
// kTukey: among C1 .. C4. kAboveZero: of one group. The rest compare a and b.
enum class ClaimTest : std::uint8_t { kNone, kTukey, kStudent, kWelch, kPaired, kAboveZero, kOneWay };
enum class MarginKind : std::uint8_t { kNone, kDifference, kRatio };
enum class ClaimMark : std::uint8_t { kCounted, kCalibration, kPilot };

struct Claim {
  const char *id, *study;
  ClaimKind kind;
  const char *what, *unit;
  const char *a = "", *b = "";      // measures (claim_measures.h); a figure has a only
  double mean = 0, half_width = 0;  // published m, h; h NaN: lost
  ClaimTest test = ClaimTest::kNone;
  MarginKind margin_kind = MarginKind::kNone;
  double margin = 0;  // in the unit, or a ratio above 1
  ClaimMark mark = ClaimMark::kCounted;
  const char* note = "";
};

const std::vector<Claim>& publishedClaims();

// All that decides a verdict, as text, and its fingerprint, which sessions keep.
std::string claimsText();
std::string claimsHash();
std::string claimsJson(const std::string& hash);  // as a session keeps it

// Verdicts of many studies on a claim.
struct ClaimEvidence {
  int studies = 0, unsettled = 0;                             // unsettled: a staircase of it found no threshold
  int hits = 0;                                               // figure
  int that_way = 0, other_way = 0;                            // order
  int significant = 0, significant_that_way = 0, paired = 0;  // paired: likewise significant within people (that way)
  double mean_a = 0, half_a = 0;                              // over the studies: of a, its 95 % half-width
  double mean_b = 0;
  double own_half = 0;                         // h_sim, mean over the studies
  double difference = 0, difference_half = 0;  // b - a over the studies; of a ratio margin ln(b / a)
  double effect = 0;  // d_z of people, mean over the studies; NaN where people did one of the two
};

// "follows", "would mostly look the same", "same direction only", "reversed", "does not follow: 1.4 times", "can't be
// told", "calibration", "too few studies", "not run", "-".
std::string verdictOn(const Claim& claim, const ClaimEvidence& evidence);

}  // namespace pincer::tasks
