#include "pincer/tasks/lab/findings/shape_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace pincer::tasks {
namespace {

struct Confusion {
  const char *shown, *named;
};
// Published confusions that the claims tell of; the first is compared with the next (confusions:first).
constexpr std::array<Confusion, 10> kTen{{{"tetrahedron", "cone"},
                                          {"cone", "tetrahedron"},
                                          {"triangle", "octagon"},
                                          {"triangle", "tetrahedron"},
                                          {"octagon", "cylinder"},
                                          {"cylinder", "octagon"},
                                          {"cylinder", "cube"},
                                          {"cube", "triangle"},
                                          {"cube", "octagon"},
                                          {"cone", "cylinder"}}};

struct Share {
  int part = 0, all = 0;

  void add(bool in) { part += in, ++all; }
  double percent() const { return all > 0 ? 100.0 * part / all : std::nan(""); }
};

struct ShapeAnswer {
  std::int64_t person;
  std::string solid, named;
  bool shaded, display, right;
  double time, contact;

  explicit ShapeAnswer(const ResponseRecord& r)
      : person(r.participant),
        solid(r.stimulus),
        named(r.answer),
        shaded(r.condition.starts_with("shaded")),
        display(r.condition.ends_with("+cld")),
        right(r.correct == 1),
        time(r.duration),
        contact(r.contact_share) {}
  const char* shading() const { return shaded ? "shaded" : "facets"; }
  const char* sense() const { return display ? "cld" : "force"; }
  const char* group() const { return solid == "sphere" ? "sphere" : "rest"; }
};

// One share per key, in the keys' order.
template <class Key>
void addPercents(const std::string& measure, const std::map<Key, Share>& shares, StudyMeasures& measures) {
  for (const auto& [key, share] : shares) measures.people[measure].push_back(share.percent());
}

void addRight(const std::vector<ShapeAnswer>& answers, StudyMeasures& measures) {
  using Cell = std::tuple<std::int64_t, std::string, bool>;
  std::map<std::int64_t, Share> people;
  std::map<std::string, std::map<std::int64_t, Share>> solids;
  std::map<std::string, std::map<Cell, Share>> cells;
  for (const ShapeAnswer& a : answers) {
    people[a.person].add(a.right);
    solids["right:" + a.solid][a.person].add(a.right);
    cells[std::string("right:") + a.sense()][{a.person, a.solid, a.shaded}].add(a.right);
    cells[std::string("right:") + a.shading()][{a.person, a.solid, a.display}].add(a.right);
    cells[std::string("cells:") + a.group()][{a.person, a.solid, a.shaded}].add(a.right);
  }
  addPercents("right", people, measures);
  for (const auto& [name, shares] : solids) addPercents(name, shares, measures);
  for (const auto& [name, shares] : cells) addPercents(name, shares, measures);
  measures.persons = people.size();
}

void addTimes(const std::vector<ShapeAnswer>& answers, StudyMeasures& measures) {
  std::map<std::pair<std::string, std::int64_t>, std::vector<double>> solids;
  for (const ShapeAnswer& a : answers) {
    std::vector<double>& of_person = solids[{a.solid, a.person}];  // there even if nothing was right
    if (!a.right) continue;
    of_person.push_back(a.time);
    measures.people[std::string("times:") + a.sense()].push_back(a.time);
    measures.people[std::string("times:") + a.group()].push_back(a.time);
    measures.people[std::string("contact:") + a.shading()].push_back(a.contact);
  }
  for (const auto& [key, times] : solids) {
    const double mean = times.empty() ? std::nan("") : estimateMean(times).mean;
    measures.people["time:" + key.first].push_back(mean);
  }
}

// Of the presentations that `counts` picks.
template <class Counts, class IsIt>
void addConfusion(const std::string& measure, const std::vector<ShapeAnswer>& answers, const Counts& counts,
                  const IsIt& is_it, StudyMeasures& measures) {
  std::map<std::int64_t, Share> people;
  for (const ShapeAnswer& a : answers) {
    if (counts(a)) people[a.person].add(is_it(a));
  }
  addPercents(measure, people, measures);
}

void addConfusionOf(const std::string& shown, const std::string& named, const std::vector<ShapeAnswer>& answers,
                    StudyMeasures& measures) {
  const auto is_it = [&](const ShapeAnswer& a) { return named == "others" ? !a.right : a.named == named; };
  const std::string name = shown + ">" + named;
  addConfusion(
      name, answers, [&](const ShapeAnswer& a) { return a.solid == shown; }, is_it, measures);
  for (const bool shaded : {false, true}) {
    const auto counts = [&](const ShapeAnswer& a) { return a.solid == shown && a.shaded == shaded; };
    addConfusion(name + (shaded ? ":shaded" : ":facets"), answers, counts, is_it, measures);
  }
}

double percentOf(const Confusion& c, const std::vector<ShapeAnswer>& answers, std::optional<bool> display) {
  Share share;
  for (const ShapeAnswer& a : answers) {
    if (a.solid == c.shown && (!display || a.display == *display)) share.add(a.named == c.named);
  }
  return share.percent();
}

void addTen(const std::vector<ShapeAnswer>& answers, StudyMeasures& measures) {
  double next = 0;
  for (std::size_t k = 1; k < kTen.size(); ++k) next = std::max(next, percentOf(kTen[k], answers, {}));
  measures.people["confusions:first"] = {percentOf(kTen[0], answers, {})};
  measures.people["confusions:next"] = {next};
  for (const bool display : {false, true}) {
    std::vector<double> ten;
    for (const Confusion& c : kTen) ten.push_back(percentOf(c, answers, display));
    const double mean = estimateMean(ten).mean;
    double squares = 0;
    for (const double x : ten) squares += (x - mean) * (x - mean);
    measures.people[display ? "unevenness:cld" : "unevenness:force"] = {
        std::sqrt(squares / (static_cast<double>(kTen.size()) - 1))};
  }
}

}  // namespace

void addShapeMeasures(const std::vector<ResponseRecord>& responses, StudyMeasures& measures) {
  const std::vector<ShapeAnswer> answers(responses.begin(), responses.end());
  addRight(answers, measures);
  addTimes(answers, measures);
  for (const Confusion& c : kTen) addConfusionOf(c.shown, c.named, answers, measures);
  addConfusionOf("tetrahedron", "others", answers, measures);
  addTen(answers, measures);
}

}  // namespace pincer::tasks
