#include "pincer/tasks/lab/findings/findings.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <sstream>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {
namespace {

constexpr double kSignificant = 0.05;  // of p: level of significance
constexpr int kFewest = 4;             // with fewer not even all of them are certainly more than half (Wilson)

// The means of one participant, one per measure.
struct PersonMeans {
  std::vector<double> force, cld;
};

// The participants' means of every session that is whole.
std::vector<std::vector<PersonMeans>> experimentsOf(const std::vector<std::string>& sessions, std::string& hash) {
  std::vector<std::vector<PersonMeans>> experiments;
  for (const std::string& path : sessions) {
    const SessionReader session(path);
    if (!session.complete()) continue;
    hash = session.info().participants_hash;
    std::map<std::int64_t, std::vector<TrialRecord>> people;
    for (TrialRecord& trial : session.trials()) people[trial.participant].push_back(std::move(trial));
    experiments.emplace_back();
    for (const auto& [person, trials] : people)
      experiments.back().push_back({personMeans(trials, "force"), personMeans(trials, "cld+force")});
  }
  return experiments;
}

FindingResult summarise(const std::vector<std::vector<PersonMeans>>& experiments, std::size_t measure) {
  FindingResult result;
  std::vector<double> force, cld, difference, effect;
  for (const auto& people : experiments) {
    std::vector<double> a, b;
    for (const PersonMeans& person : people) {
      a.push_back(person.force[measure]);
      b.push_back(person.cld[measure]);
    }
    const PairedTest test = comparePairs(a, b);
    if (test.n == 0) continue;
    ++result.experiments;
    force.push_back(estimateMean(a).mean);
    cld.push_back(estimateMean(b).mean);
    difference.push_back(test.difference.mean);
    if (std::isfinite(test.effect)) effect.push_back(test.effect);
    const bool significant = test.p_t < kSignificant, less = test.difference.mean<0, more = test.difference.mean> 0;
    result.significant_t += significant;
    result.significant_w += test.p_wilcoxon < kSignificant;
    result.less += less;
    result.more += more;
    result.significant_less += significant && less;
    result.significant_more += significant && more;
  }
  result.force = estimateMean(force);
  result.cld = estimateMean(cld);
  result.difference = estimateMean(difference);
  result.effect = estimateMean(effect);
  return result;
}

}  // namespace

bool isWanted(const std::string& name, const std::string& only) {
  std::istringstream parts(only);
  parts.exceptions(std::ios::badbit);  // else it takes a lack of memory for the end
  bool wanted = only.empty();
  for (std::string part; std::getline(parts, part, ',');) wanted = wanted || name.find(part) != std::string::npos;
  return wanted;
}

void validate(const FindingsOptions& o) {
  const auto require = [](const char* name, int value, int low, int high) {
    if (value >= low && value <= high) return;
    throw InputError(fmt::format("findings: {} = {} is out of range [{}, {}].", name, value, low, high));
  };
  require("experiments", o.experiments, 2, 1000);
  require("control_experiments", o.control_experiments, 2, 1000);
  require("participants", o.participants, 2, 60);
  require("pickups", o.pickups, 1, 100);
  require("alignments", o.alignments, 1, 100);
  require("threads", o.threads, 1, 256);
}

ManipulationStudy experimentOf(const FindingsOptions& options, const FindingsVariant& variant, int experiment) {
  constexpr int kMoreThanJsonHolds = 11;  // bits of a seed: 53 go into a number of a study file
  ManipulationStudy study;
  study.participants = options.participants;
  study.seed = seedFor(options.seed, static_cast<std::uint64_t>(experiment)) >> kMoreThanJsonHolds;
  study.training = {0, 0};
  study.pickup.repetitions = options.pickups;
  study.alignment.repetitions = options.alignments;
  variant.change(study);
  return study;
}

VariantResult judgeVariant(const FindingsVariant& variant, const std::vector<std::string>& sessions) {
  VariantResult result{variant.name, variant.what, "", {}, sessions};
  const auto experiments = experimentsOf(sessions, result.hash);
  if (experiments.empty()) return result;
  for (std::size_t m = 0; m < findingMeasures().size(); ++m) result.findings.push_back(summarise(experiments, m));
  return result;
}

std::string verdictOn(const FindingMeasure& measure, const FindingResult& r) {
  if (measure.expected == PublishedEffect::kNone) return "-";
  if (r.experiments < kFewest) return "too few experiments";
  if (measure.expected == PublishedEffect::kSame) {
    return wilsonInterval(r.significant_t, r.experiments).first <= kSignificant ? "follows" : "does not follow";
  }
  const bool less = measure.expected == PublishedEffect::kLess;
  if (wilsonInterval(less ? r.significant_less : r.significant_more, r.experiments).first > 0.5) return "follows";
  const double sign = less ? -1 : 1;
  return sign * r.difference.mean - r.difference.half_width > 0 ? "in the same direction only" : "does not follow";
}

}  // namespace pincer::tasks
