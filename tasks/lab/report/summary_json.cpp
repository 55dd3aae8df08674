#include <nlohmann/json.hpp>

#include "pincer/tasks/lab/report/summary.h"

namespace pincer::tasks {

namespace {

using Json = nlohmann::ordered_json;  // keys in the order of the table

Json asJson(const CellSummary& cell) {
  Json json{{"condition", cell.condition},       {"mu_s", nullptr},           {"trials", cell.trials},
            {"successes", cell.successes},       {"timeouts", cell.timeouts}, {"faults", cell.faults},
            {"success_rate", cell.successRate()}};
  if (!cell.allFrictions()) json["mu_s"] = cell.mu_s;
  for (std::size_t m = 0; m < kMeasures.size(); ++m) {
    const Estimate& e = cell.measures[m];
    const Interval interval = intervalOf(e, Averaged::kPositive);
    json[kMeasures[m].key] = Json{{"n", e.n},
                                  {"mean", e.mean},
                                  {"ci95_half_width", e.half_width},
                                  {"ci95_low", interval.low},
                                  {"ci95_high", interval.high},
                                  {"lower_bound", cell.timeouts > 0}};
  }
  return json;
}

}  // namespace

std::string summaryJson(const SessionSummary& s) {
  Json json{{"session", s.path},
            {"task", s.info.task},
            {"seed", s.info.seed},
            {"version", s.info.version},
            {"build", s.info.build},
            {"commit", s.info.commit},
            {"processor", s.info.processor},
            {"c_library", s.info.c_library},
            {"flags", s.info.flags},
            {"state", s.state},
            {"warning", s.warning},
            {"started_utc", s.started_utc},
            {"participants", s.participants},
            {"trials", s.trials},
            {"cells", Json::array()}};
  for (const CellSummary& cell : s.cells) json["cells"].push_back(asJson(cell));
  json["pairs"] = Json::array();
  for (const MeasureRow& row : s.rows) {
    const FindingMeasure& m = findingMeasures()[row.measure];
    const std::vector<double> adjusted = row.adjusted();
    for (std::size_t k = 0; k < row.tests.size(); ++k) {
      const PairedTest& test = row.tests[k];
      json["pairs"].push_back({{"measure", m.key},
                               {"unit", m.unit},
                               {"reference", s.conditions[0]},
                               {"condition", s.conditions[k + 1]},
                               {"reference_mean", row.means[0].mean},
                               {"mean", row.means[k + 1].mean},
                               {"n", test.n},
                               {"difference", test.difference.mean},
                               {"ci95_half_width", test.difference.half_width},
                               {"d_z", test.effect},
                               {"p_t", test.p_t},
                               {"p_wilcoxon", test.p_wilcoxon},
                               {"p_holm", adjusted[k]}});
    }
  }
  // a name may hold what a terminal obeys, and bytes that are no UTF-8
  return json.dump(2, ' ', true, Json::error_handler_t::replace);
}

}  // namespace pincer::tasks
