#include "pincer/tasks/lab/findings/claim_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/error.h"
#include "pincer/tasks/lab/report/group_tests.h"
#include "pincer/tasks/lab/report/paired_test.h"

namespace pincer::tasks {
namespace {

constexpr double kSignificance = 0.05;  // of p: level of significance

std::vector<double> finiteValues(const std::vector<double>& values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite), [](double x) { return std::isfinite(x); });
  return finite;
}

double tukeyAmongConditions(const Claim& claim, const StudyMeasures& study) {
  Groups groups;
  std::size_t a = 0, b = 0;
  for (const char* name : {"C1", "C2", "C3", "C4"}) {
    if (name == std::string(claim.a)) a = groups.size();
    if (name == std::string(claim.b)) b = groups.size();
    groups.push_back(study.of(name));
  }
  return tukeyPair(groups, a, b);
}

double publishedTest(const Claim& claim, const StudyMeasures& study) {
  const std::vector<double>&a = study.of(claim.a), &b = study.of(claim.b);
  switch (claim.test) {
    case ClaimTest::kTukey:
      return tukeyAmongConditions(claim, study);
    case ClaimTest::kStudent:
      return studentTest(a, b).p;
    case ClaimTest::kWelch:
      return welchTest(a, b).p;
    case ClaimTest::kPaired:
      return comparePairs(a, b).p_t;
    case ClaimTest::kAboveZero:
      return oneSampleTest(b, 0).p;
    case ClaimTest::kOneWay:
    case ClaimTest::kNone:
      break;
  }
  return 1;
}

bool isPaired(const Claim& claim, const StudyMeasures& study) {
  const auto one_each = [&](const char* measure) { return study.of(measure).size() == study.persons; };
  return claim.test != ClaimTest::kAboveZero && one_each(claim.a) && one_each(claim.b);
}

// Over the studies.
struct Collected {
  std::vector<double> a, b, difference, effect, half;

  void give(ClaimEvidence& e) const {
    const Estimate of_a = estimateMean(a), d = estimateMean(difference);
    e.mean_a = of_a.mean;
    e.half_a = of_a.half_width;
    e.mean_b = estimateMean(b).mean;
    e.own_half = estimateMean(half).mean;
    e.difference = d.mean;
    e.difference_half = d.half_width;
    e.effect = estimateMean(effect).mean;
  }
};

void addFigure(const Claim& claim, const StudyMeasures& study, ClaimEvidence& e, Collected& all) {
  const Estimate own = estimateMean(finiteValues(study.of(claim.a)));
  if (own.n < 2) return;
  ++e.studies;
  const auto unsettled = study.unsettled.find(claim.a);
  const bool lost = unsettled != study.unsettled.end() && unsettled->second;
  e.unsettled += lost;
  const double h = std::isnan(claim.half_width) ? 0 : claim.half_width;
  e.hits += !lost && std::abs(own.mean - claim.mean) <= math::hypot(h, own.half_width);
  all.a.push_back(own.mean);
  all.half.push_back(own.half_width);
}

void addComparison(const Claim& claim, const StudyMeasures& study, ClaimEvidence& e, Collected& all) {
  const Estimate b = estimateMean(finiteValues(study.of(claim.b)));
  const bool against_zero = claim.test == ClaimTest::kAboveZero;
  const Estimate a = against_zero ? Estimate{b.n, 0, 0} : estimateMean(finiteValues(study.of(claim.a)));
  const int fewest = claim.test == ClaimTest::kNone ? 1 : 2;  // some untested measures are of the whole study
  if (a.n < fewest || b.n < fewest) return;
  ++e.studies;
  const double difference = b.mean - a.mean, p = publishedTest(claim, study);
  e.that_way += difference > 0;
  e.other_way += difference < 0;
  e.significant += p < kSignificance;
  e.significant_that_way += p < kSignificance && difference > 0;
  if (isPaired(claim, study)) {
    const PairedTest paired = comparePairs(study.of(claim.a), study.of(claim.b));
    e.paired += paired.p_t < kSignificance && paired.difference.mean > 0;
    if (std::isfinite(paired.effect)) all.effect.push_back(paired.effect);
  }
  all.a.push_back(a.mean);
  all.b.push_back(b.mean);
  all.difference.push_back(claim.margin_kind == MarginKind::kRatio ? math::log(b.mean / a.mean) : difference);
}

// Words that all parts of a table have in common.
class CommonGround {
 public:
  void require(const SessionReader& session) {
    const SessionInfo& info = session.info();
    same(commit_, info.commit, session.path(), "commit");
    same(claims_, info.scene_json, session.path(), "list of claims");
    same(people_[info.task], info.participants_hash, session.path(), "people");
  }
  const std::string& commit() const { return commit_.second; }
  std::vector<std::string> participants() const {
    std::vector<std::string> lines;
    for (const auto& [task, hash] : people_) lines.push_back(task + ": " + hash.second);
    return lines;
  }

 private:
  using Known = std::pair<bool, std::string>;
  static void same(Known& known, const std::string& value, const std::string& path, const char* what) {
    if (!known.first) known = {true, value};
    if (known.second == value) return;
    throw InputError(fmt::format(
        "{}: is of another {} ({}) than the sessions before it ({}). Give another --out, or run them all again.", path,
        what, value, known.second));
  }
  Known commit_, claims_;
  std::map<std::string, Known> people_;
};

std::vector<StudyMeasures> readStudies(const std::vector<std::string>& paths, CommonGround& ground) {
  std::vector<StudyMeasures> studies;
  for (const std::string& path : paths) {
    const SessionReader session(path);
    if (!session.complete()) continue;
    ground.require(session);
    if (!isStudy(session.info().task)) {
      studies.push_back(measuresOf(session.trials()));
      continue;
    }
    const std::vector<ResponseRecord> responses = session.responses();
    studies.push_back(measuresOf(summariseStudy(session, responses), responses));
  }
  return studies;
}

std::map<std::string, std::vector<StudyMeasures>> readAll(const std::map<std::string, std::vector<std::string>>& files,
                                                          CommonGround& ground) {
  std::map<std::string, std::vector<StudyMeasures>> measures;
  for (const auto& [study, paths] : files) measures[study] = readStudies(paths, ground);
  return measures;
}

}  // namespace

ClaimEvidence evidenceOf(const Claim& claim, const std::vector<StudyMeasures>& studies) {
  ClaimEvidence e;
  Collected all;
  for (const StudyMeasures& study : studies) {
    if (claim.kind == ClaimKind::kFigure) addFigure(claim, study, e, all);
    if (claim.kind == ClaimKind::kOrder || claim.kind == ClaimKind::kNull) addComparison(claim, study, e, all);
  }
  if (e.studies > 0) all.give(e);
  return e;
}

ClaimTable judgeClaims(const StudySessions& sessions) {
  CommonGround ground;
  auto studies = readAll(sessions.studies, ground), parked = readAll(sessions.parked, ground),
       unrelated = readAll(sessions.unrelated, ground);
  ClaimTable table;
  for (const Claim& claim : publishedClaims())
    table.rows.push_back({&claim, evidenceOf(claim, studies[claim.study]), evidenceOf(claim, parked[claim.study]),
                          evidenceOf(claim, unrelated[claim.study])});
  table.commit = ground.commit();
  table.participants = ground.participants();
  return table;
}

}  // namespace pincer::tasks
