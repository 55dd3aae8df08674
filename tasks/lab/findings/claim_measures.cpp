#include "pincer/tasks/lab/findings/claim_measures.h"

#include <algorithm>
#include <cmath>

#include "pincer/tasks/lab/findings/shape_measures.h"
#include "pincer/tasks/lab/report/person_means.h"

namespace pincer::tasks {
namespace {

constexpr double kMillimetresPerMetre = 1e3;

struct SpeedSums {
  double finger = 0, tactor = 0;
  int finger_n = 0, tactor_n = 0;

  void add(const ResponseRecord& r) {
    if (std::isfinite(r.finger_speed)) finger += r.finger_speed, ++finger_n;
    if (std::isfinite(r.tactor_speed)) tactor += r.tactor_speed, ++tactor_n;
  }
  double fingerMean() const { return finger_n > 0 ? kMillimetresPerMetre * finger / finger_n : std::nan(""); }
  double tactorMean() const { return tactor_n > 0 ? kMillimetresPerMetre * tactor / tactor_n : std::nan(""); }
};

void addSpeeds(const StudyCondition& condition, const std::vector<ResponseRecord>& responses, StudyMeasures& measures) {
  std::map<std::int64_t, SpeedSums> people;
  for (const ResponseRecord& r : responses) {
    if (r.condition == condition.name && r.outcome == "answered") people[r.participant].add(r);
  }
  for (const StudyPerson& person : condition.people) {
    const SpeedSums& sums = people[person.participant];
    measures.people["finger:" + condition.name].push_back(sums.fingerMean());
    measures.people["tactor:" + condition.name].push_back(sums.tactorMean());
    measures.people["finger/tactor:" + condition.name].push_back(sums.fingerMean() / sums.tactorMean());
  }
}

struct MeanOf {
  double sum = 0;
  int n = 0;
  void add(double x) { sum += x, ++n; }
  double mean() const { return n > 0 ? kMillimetresPerMetre * sum / n : std::nan(""); }
};

void addMatches(const std::vector<ResponseRecord>& responses, StudyMeasures& measures) {
  struct Person {
    MeanOf all, inner, outer, inward;
  };
  std::map<std::int64_t, Person> people;
  double outermost = 0;
  for (const ResponseRecord& r : responses) outermost = std::max(outermost, std::abs(r.level));
  for (const ResponseRecord& r : responses) {
    const double error = r.answer_value - r.level;
    if (r.outcome != "answered" || !std::isfinite(error)) continue;
    Person& person = people[r.participant];
    const bool outer = std::abs(r.level) > outermost - 1e-9;
    person.all.add(std::abs(error));
    (outer ? person.outer : person.inner).add(std::abs(error));
    if (outer) person.inward.add(r.level > 0 ? -error : error);
  }
  for (const auto& [number, person] : people) {
    measures.people["error"].push_back(person.all.mean());
    measures.people["error:inner"].push_back(person.inner.mean());
    measures.people["error:outer"].push_back(person.outer.mean());
    measures.people["inward:outer"].push_back(person.inward.mean());
  }
}

}  // namespace

const std::vector<double>& StudyMeasures::of(const std::string& measure) const {
  static const std::vector<double> nothing;
  const auto found = people.find(measure);
  return found == people.end() ? nothing : found->second;
}

StudyMeasures measuresOf(const StudySummary& summary, const std::vector<ResponseRecord>& responses) {
  StudyMeasures measures;
  measures.persons = static_cast<std::size_t>(summary.participants);
  if (summary.info.task == "shape-identification") {
    addShapeMeasures(responses, measures);
    return measures;
  }
  for (const StudyCondition& c : summary.conditions) {
    for (const StudyPerson& person : c.people)
      measures.people[c.name].push_back(summary.headline.scale * person.headline);
    measures.unsettled[c.name] = isUnsettled(c);
    addSpeeds(c, responses, measures);
  }
  if (summary.info.task == "repeated-localisation") addMatches(responses, measures);
  const std::vector<double>&delays = measures.of("whole"), &speeds = measures.of("tactor:whole");
  std::vector<double> errors;
  for (std::size_t i = 0; i < delays.size(); ++i) errors.push_back(1e-3 * delays[i] * speeds[i]);
  if (!errors.empty()) measures.people["place-error"] = errors;
  return measures;
}

StudyMeasures measuresOf(const std::vector<TrialRecord>& trials) {
  const std::map<std::string, std::string> names = {{"tries", "tries"},
                                                    {"pickup_time", "pickup-time"},
                                                    {"alignment_error", "alignment-error"},
                                                    {"alignment_time", "alignment-time"}};
  std::map<std::int64_t, std::vector<TrialRecord>> of_person;
  for (const TrialRecord& t : trials) of_person[t.participant].push_back(t);
  StudyMeasures measures;
  measures.persons = of_person.size();
  for (const auto& [person, own] : of_person) {
    const std::vector<double> force = personMeans(own, "force"), cld = personMeans(own, "cld+force");
    for (std::size_t m = 0; m < findingMeasures().size(); ++m) {
      const auto name = names.find(findingMeasures()[m].key);
      if (name == names.end()) continue;
      measures.people[name->second + ":force"].push_back(force[m]);
      measures.people[name->second + ":cld"].push_back(cld[m]);
      measures.people[name->second + ":longer"].push_back(cld[m] - force[m]);
    }
  }
  return measures;
}

}  // namespace pincer::tasks
