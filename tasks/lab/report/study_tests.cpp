#include "pincer/tasks/lab/report/study_tests.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "pincer/tasks/lab/report/group_tests.h"
#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/lab/report/paired_test.h"

namespace pincer::tasks {
namespace {

// One group per condition, everywhere the same people in the same order, NaN for who has no figure.
struct Compared {
  std::vector<std::string> names;
  Groups groups;
};

Compared comparedOf(const StudySummary& s) {
  std::map<std::int64_t, std::size_t> places;
  for (const StudyCondition& c : s.conditions) {
    for (const StudyPerson& person : c.people) places.emplace(person.participant, places.size());
  }
  Compared compared;
  for (const StudyCondition& c : s.conditions) {
    if (c.headline.n < 2) continue;
    compared.names.push_back(c.name);
    std::vector<double>& group = compared.groups.emplace_back(places.size(), std::nan(""));
    for (const StudyPerson& person : c.people) group[places[person.participant]] = s.headline.scale * person.headline;
  }
  return compared;
}

std::string pText(double p) { return std::isnan(p) ? "–" : p < 0.001 ? "< .001" : fmt::format("{:.3f}", p); }

std::string varianceText(const char* name, const VarianceTest& test) {
  return fmt::format("{}: F({:g}, {:g}) = {:.2f}, p {}", name, test.between_dof, test.within_dof, test.f,
                     test.p < 0.001 ? "< .001" : "= " + pText(test.p));
}

std::string pairRow(const Compared& compared, std::size_t a, std::size_t b) {
  const std::vector<double>&first = compared.groups[a], &second = compared.groups[b];
  const PairedTest paired = comparePairs(first, second);
  const MeansTest student = studentTest(first, second);
  return htmlRow({fmt::format("{} - {}", compared.names[b], compared.names[a]),
                  fmt::format("{:.3g}", student.difference), pText(tukeyPair(compared.groups, a, b)),
                  fmt::format("t({:g}) = {:.2f}, p {}", student.dof, student.t, pText(student.p)),
                  pText(welchTest(first, second).p), pText(paired.p_t),
                  std::isfinite(paired.effect) ? fmt::format("{:.2f}", paired.effect) : "–"},
                 "td");
}

}  // namespace

std::string studyTestsHtml(const StudySummary& s) {
  const Compared compared = comparedOf(s);
  if (compared.groups.size() < 2) return "";
  std::string html = "<h2>Do the conditions differ?</h2>\n<p>" +
                     varianceText("One-way analysis of variance", oneWayVariance(compared.groups)) + "; " +
                     varianceText("repeated measures", repeatedMeasures(compared.groups)) +
                     ".</p>\n<div class=\"wide\"><table>\n";
  html += htmlRow({"pair", fmt::format("difference [{}]", s.headline.unit), "Tukey, p", "Student, unpaired", "Welch, p",
                   "paired t, p", "d_z"},
                  "th");
  for (std::size_t a = 0; a < compared.groups.size(); ++a) {
    for (std::size_t b = a + 1; b < compared.groups.size(); ++b) html += pairRow(compared, a, b);
  }
  return html +
         "</table></div>\n<p class=\"note\">As published: the one-way analysis, Tukey and Student take one person's "
         "figures for those of "
         "different people. Repeated measures and the paired test don't; d_z is the mean of the people's differences "
         "over their standard "
         "deviation.</p>\n";
}

}  // namespace pincer::tasks
