#include "pincer/tasks/lab/report/study_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/lab/study/arc_segments.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

constexpr double kSettled = 0.62;                                       // share of right answers [-]
constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();  // NaN: too few answers for one

// The task whose levels are angles, and its thresholds counts.
constexpr const char* kCountedInSegments = "smoothness-discrimination";

struct StudyKind {
  const char *task, *name, *unit;
  double scale;
  const char* level_unit;
  double level_scale;
  Averaged averaged = Averaged::kPositive;
};
// Per task: figure, its unit per SI unit, unit of the levels, that per SI unit.
constexpr std::array<StudyKind, 5> kStudyKinds{
    {{kCountedInSegments, "threshold", "segments", 1, "°", 180 / M_PI},
     {"backlash-discrimination", "threshold", "mm", 1e3, "mm", 1e3},
     {"delay-discrimination", "threshold", "ms", 1e3, "ms", 1e3},
     {"repeated-localisation", "mean absolute error", "mm", 1e3, "mm", 1e3},
     {"shape-identification", "right answers", "%", 100, "%", 100, Averaged::kShare}}};

const StudyKind* kindOf(const std::string& task) {
  const auto found =
      std::find_if(kStudyKinds.begin(), kStudyKinds.end(), [&](const StudyKind& k) { return task == k.task; });
  return found == kStudyKinds.end() ? nullptr : &*found;
}

double numberOr(const JsonValue& object, std::string_view key, double otherwise) {
  const JsonValue* value = object.find(key);
  return value && value->kind() == JsonValue::Kind::kNumber ? value->number() : otherwise;
}

int averagedOf(const JsonValue& staircase) {
  const JsonValue* value = staircase.find("averaged");
  return value ? value->integer(1, 1000, "") : 0;
}

// The conditions of the protocol, then any that only the answers know.
std::vector<StudyCondition> conditionsOf(const JsonValue& study, const std::vector<ResponseRecord>& responses) {
  std::vector<StudyCondition> conditions;
  if (const JsonValue* list = study.find("conditions")) {
    for (const JsonValue& c : list->array()) {
      const JsonValue* rule = c.find("staircase");
      conditions.push_back({c.at("name").text(),
                            c.at("label").text(),
                            numberOr(c, "published", kNoFigure),
                            rule ? averagedOf(*rule) : 0,
                            0,
                            0,
                            {},
                            {},
                            {},
                            {},
                            {},
                            {},
                            {},
                            {}});
    }
  }
  for (const ResponseRecord& r : responses) {
    const bool known = std::any_of(conditions.begin(), conditions.end(),
                                   [&](const StudyCondition& c) { return c.name == r.condition; });
    if (known) continue;
    StudyCondition condition;
    condition.name = condition.label = r.condition;
    condition.published = numberOr(study, "published_error", kNoFigure);
    conditions.push_back(std::move(condition));
  }
  return conditions;
}

using People = std::map<std::int64_t, std::vector<const ResponseRecord*>>;

double meanOf(const std::vector<const ResponseRecord*>& trials, double (*of)(const ResponseRecord&)) {
  double sum = 0;
  int n = 0;
  for (const ResponseRecord* r : trials) {
    const double value = of(*r);
    if (std::isnan(value)) continue;
    sum += value;
    ++n;
  }
  return n > 0 ? sum / n : kNoFigure;
}

Estimate overPeople(const People& people, double (*of)(const ResponseRecord&)) {
  std::vector<double> values;
  for (const auto& [person, trials] : people) {
    const double mean = meanOf(trials, of);
    if (!std::isnan(mean)) values.push_back(mean);
  }
  return estimateMean(values);
}

// Of one staircase.
double thresholdOfRun(const std::string& task, const std::vector<const ResponseRecord*>& trials, int averaged) {
  std::vector<double> reversals;
  for (const ResponseRecord* r : trials)
    if (r->reversal) reversals.push_back(task == kCountedInSegments ? segmentsOf(r->level) : r->level);
  if (static_cast<int>(reversals.size()) < averaged) return kNoFigure;
  double sum = 0;
  for (auto level = reversals.end() - averaged; level != reversals.end(); ++level) sum += *level;
  return sum / averaged;
}

// The mean over a participant's staircases in the condition, one per block; those that found none don't count.
double thresholdOf(const std::string& task, const std::vector<const ResponseRecord*>& trials, int averaged) {
  std::map<std::int64_t, std::vector<const ResponseRecord*>> runs;
  for (const ResponseRecord* r : trials) runs[r->run].push_back(r);
  double sum = 0;
  int n = 0;
  for (const auto& [run, own] : runs) {
    const double threshold = thresholdOfRun(task, own, averaged);
    if (std::isnan(threshold)) continue;
    sum += threshold;
    ++n;
  }
  return n > 0 ? sum / n : kNoFigure;
}

double headlineOf(const std::string& task, const StudyCondition& condition,
                  const std::vector<const ResponseRecord*>& trials) {
  if (condition.averaged > 0) return thresholdOf(task, trials, condition.averaged);
  if (task == "repeated-localisation")
    return meanOf(trials, [](const ResponseRecord& r) { return std::abs(r.answer_value - r.level); });
  return meanOf(trials, [](const ResponseRecord& r) { return static_cast<double>(r.correct); });
}

void summarise(const std::string& task, const std::vector<ResponseRecord>& responses, StudyCondition& condition) {
  People people;
  for (const ResponseRecord& r : responses) {
    if (r.condition != condition.name) continue;
    ++condition.trials;
    if (r.outcome == "answered")
      people[r.participant].push_back(&r);
    else
      ++condition.unanswered;
  }
  std::vector<double> headlines;
  for (const auto& [person, trials] : people) {
    condition.people.push_back({person, headlineOf(task, condition, trials)});
    if (!std::isnan(condition.people.back().headline)) headlines.push_back(condition.people.back().headline);
  }
  condition.headline = estimateMean(headlines);
  condition.right = overPeople(people, [](const ResponseRecord& r) { return static_cast<double>(r.correct); });
  condition.duration = overPeople(people, [](const ResponseRecord& r) { return r.duration; });
  condition.response_time = overPeople(people, [](const ResponseRecord& r) { return r.response_time; });
  condition.contact_share = overPeople(people, [](const ResponseRecord& r) { return r.contact_share; });
  condition.finger_speed = overPeople(people, [](const ResponseRecord& r) { return r.finger_speed; });
  condition.tactor_speed = overPeople(people, [](const ResponseRecord& r) { return r.tactor_speed; });
}

std::string estimateText(const Estimate& e, double scale, int digits, Averaged averaged = Averaged::kPositive) {
  if (e.n == 0) return "–";
  if (e.n < 2 || !(e.half_width > 0)) return fmt::format("{:.{}f}", scale * e.mean, digits);
  const Interval interval = intervalOf(e, averaged);
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", scale * e.mean, digits, scale * interval.low, digits,
                     scale * interval.high, digits);
}

// True if the published figure lies in pincer's interval; where not, how far off the mean is.
std::string followsText(const StudySummary& s, const StudyCondition& c) {
  if (std::isnan(c.published) || c.headline.n < 2 || isUnsettled(c)) return "–";
  const Interval interval = intervalOf(c.headline, s.headline.averaged);
  if (interval.low <= c.published && c.published <= interval.high) return "yes";
  return fmt::format("no, {:.2g} times", c.headline.mean / c.published);
}

void estimateJson(JsonWriter& json, const char* key, const Estimate& e) {
  json.key(key).beginObject().key("n").value(e.n).key("mean").value(e.n > 0 ? e.mean : kNoFigure);
  json.key("ci95_half_width").value(e.n > 1 ? e.half_width : kNoFigure).endObject();
}

// Characters, not bytes: units and dashes aren't ASCII.
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

bool isUnsettled(const StudyCondition& c) { return c.averaged > 0 && c.right.n > 0 && c.right.mean < kSettled; }

double levelShown(const StudySummary& s, double headline) {
  return s.headline.level_scale * (s.info.task == kCountedInSegments ? turnOf(headline) : headline);
}

bool isStudy(const std::string& task) { return kindOf(task) != nullptr; }

StudySummary summariseStudy(const SessionInfo& info, const std::string& name,
                            const std::vector<ResponseRecord>& responses) {
  StudySummary s{name, info, "", "", "", info.participants_hash, 0, 0, {}, {}};
  const StudyKind* kind = kindOf(info.task);
  if (!kind) throw InputError(fmt::format("{}: a session of {}, which isn't a psychophysical study.", name, info.task));
  s.headline = {kind->name, kind->unit, kind->scale, kind->level_unit, kind->level_scale, kind->averaged};
  const JsonValue protocol = parseJson(info.protocol_json, name + ": protocol");
  std::set<std::int64_t> people;
  for (const ResponseRecord& r : responses) people.insert(r.participant);
  s.participants = static_cast<std::int64_t>(people.size());
  s.trials = static_cast<std::int64_t>(responses.size());
  s.conditions = conditionsOf(protocol, responses);
  for (StudyCondition& condition : s.conditions) summarise(info.task, responses, condition);
  return s;
}

StudySummary summariseStudy(const SessionReader& session, const std::vector<ResponseRecord>& responses) {
  StudySummary s = summariseStudy(session.info(), session.path(), responses);
  s.state = session.state();
  s.started_utc = session.startedUtc();
  s.warning = session.warning();
  return s;
}

std::vector<std::string> studyTableHeads(const StudySummary& s) {
  return {"condition",        fmt::format("{} [{}]", s.headline.name, s.headline.unit),
          "published",        "follows",
          "people",           "trials",
          "right [%]",        "shown [s]",
          "answer after [s]", "in contact [%]",
          "finger [mm/s]",    "tactor [mm/s]"};
}

std::vector<std::string> studyTableRow(const StudySummary& s, const StudyCondition& c) {
  const int digits = s.headline.unit == "ms" || s.headline.unit == "%" ? 1 : 2;
  std::string headline = estimateText(c.headline, s.headline.scale, digits, s.headline.averaged);
  const bool counted = s.info.task == kCountedInSegments && c.headline.n > 0;
  if (isUnsettled(c)) headline = (counted ? "≤ " : "≥ ") + headline;
  if (counted) headline += fmt::format(" ({:.2g}°)", levelShown(s, c.headline.mean));
  return {c.name == c.label ? c.name : c.name + ": " + c.label,
          headline,
          std::isnan(c.published) ? "–" : fmt::format("{:.3g}", s.headline.scale * c.published),
          followsText(s, c),
          std::to_string(c.people.size()),
          std::to_string(c.trials),
          estimateText(c.right, 100, 1, Averaged::kShare),
          estimateText(c.duration, 1, 1),
          estimateText(c.response_time, 1, 2),
          estimateText(c.contact_share, 100, 1, Averaged::kShare),
          estimateText(c.finger_speed, 1e3, 1),
          estimateText(c.tactor_speed, 1e3, 1)};
}

std::string studyNote(const StudySummary& s) {
  std::string note =
      "In brackets the 95 % confidence interval over participants (Student t, of the logarithm; of shares the logit). "
      "Published: A. J. "
      "Doxon, doctoral dissertation, University of "
      "Utah, 2014, with people; here the participants are simulated, their parameters fixed before the study "
      "(fingerprint ";
  note += s.fingerprint +
          "). Follows: whether the published figure lies within the interval; where not, pincer's mean over it. No "
          "parameter was changed "
          "to meet "
          "one: a no is a result.";
  std::int64_t lost = 0, unanswered = 0;
  for (const StudyCondition& c : s.conditions) {
    unanswered += c.unanswered;
    for (const StudyPerson& person : c.people) lost += std::isnan(person.headline);
  }
  if (std::any_of(s.conditions.begin(), s.conditions.end(), isUnsettled)) {
    note += fmt::format(
        " ≥ (of segments ≤) marks conditions with fewer than {:.0f} % right answers: their staircases ended before "
        "they had risen to a "
        "threshold.",
        100 * kSettled);
  }
  if (lost > 0)
    note +=
        fmt::format(" {} found no threshold and {} left out.", counted(lost, "staircase"), lost == 1 ? "is" : "are");
  if (unanswered > 0) note += fmt::format(" {} ended without an answer.", counted(unanswered, "trial"));
  return note;
}

std::string studyFinding(const StudySummary& s) {
  const bool is_simulated = s.info.devices_json.find("\"simulated\"") != std::string::npos;
  std::string words = fmt::format("{} {}{}.", s.participants, is_simulated ? "simulated " : "",
                                  s.participants == 1 ? "person" : "people");
  std::string name = s.headline.name;
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  for (const StudyCondition& c : s.conditions) {
    if (c.headline.n == 0) continue;
    const std::string of = s.conditions.size() > 1 ? fmt::format(", {}", c.label.empty() ? c.name : c.label) : "";
    words += fmt::format(" {}{}: {} {}", name, of, studyTableRow(s, c)[1], s.headline.unit);
    words += std::isnan(c.published)
                 ? "."
                 : fmt::format("; published {:.3g} {}.", s.headline.scale * c.published, s.headline.unit);
  }
  const bool lone =
      std::all_of(s.conditions.begin(), s.conditions.end(), [](const StudyCondition& c) { return c.headline.n < 2; });
  if (lone) return words + " One person says nothing about others.";
  return words + " In brackets the 95 % interval of the mean over people.";
}

std::string formatStudyTable(const StudySummary& s) {
  std::vector<std::vector<std::string>> rows{studyTableHeads(s)};
  for (const StudyCondition& c : s.conditions) rows.push_back(studyTableRow(s, c));
  for (auto& row : rows) {
    for (std::string& field : row) field = printable(field);  // names in a session may be another's
  }
  std::vector<std::size_t> widths(rows[0].size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], characters(row[i]));
  std::string text = fmt::format("{}, seed {}: {}, {}\n\n", printable(s.info.task), s.info.seed,
                                 counted(s.participants, "participant"), counted(s.trials, "trial"));
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string gap(widths[i] - characters(row[i]), ' ');
      text += i == 0 ? row[i] + gap : "  " + gap + row[i];
    }
    text += '\n';
  }
  return text + "\n" + studyNote(s);
}

std::string studySummaryJson(const StudySummary& s) {
  JsonWriter json;
  json.beginObject().key("task").value(s.info.task).key("seed").value(s.info.seed);
  json.key("state").value(s.state).key("fingerprint").value(s.fingerprint);
  json.key("participants").value(s.participants).key("trials").value(s.trials).key("headline").value(s.headline.name);
  json.key("conditions").beginArray();
  for (const StudyCondition& c : s.conditions) {
    json.beginObject().key("name").value(c.name).key("label").value(c.label).key("published_si").value(c.published);
    json.key("trials").value(c.trials).key("unanswered").value(c.unanswered);
    estimateJson(json, "headline_si", c.headline);
    estimateJson(json, "right", c.right);
    estimateJson(json, "duration_s", c.duration);
    estimateJson(json, "response_time_s", c.response_time);
    estimateJson(json, "contact_share", c.contact_share);
    estimateJson(json, "finger_speed_m_per_s", c.finger_speed);
    estimateJson(json, "tactor_speed_m_per_s", c.tactor_speed);
    json.key("people").beginArray();
    for (const StudyPerson& person : c.people) {
      json.beginObject()
          .key("participant")
          .value(person.participant)
          .key("headline_si")
          .value(person.headline)
          .endObject();
    }
    json.endArray().endObject();
  }
  return json.endArray().endObject().text();
}

}  // namespace pincer::tasks
