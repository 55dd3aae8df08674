#include "pincer/tasks/lab/study/survey.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kLongestAnswer = 2000;  // characters

SurveyItem agreement(const char* name, const char* text, AskedFor per) {
  return {name, text, AnswerKind::kScale, 1, 7, "not at all", "very much", {}, per, true};
}

std::vector<SurveyItem> aboutPeople() {
  return {{"age", "How old are you?", AnswerKind::kNumber, 10, 120, "", "", {}, AskedFor::kSession, false},
          {"hand",
           "Which hand do you write with?",
           AnswerKind::kChoice,
           1,
           7,
           "",
           "",
           {"right", "left", "either"},
           AskedFor::kSession,
           true},
          {"experience",
           "Have you used a contact location display before?",
           AnswerKind::kChoice,
           1,
           7,
           "",
           "",
           {"no", "yes"},
           AskedFor::kSession,
           true}};
}

std::string trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r\n");
  return from == std::string_view::npos ? ""
                                        : std::string(text.substr(from, text.find_last_not_of(" \t\r\n") - from + 1));
}

[[noreturn]] void refuseAnswer(const SurveyItem& item, const std::string& typed) {
  throw InputError(fmt::format("\"{}\" isn't an answer here. Give {}.", typed.substr(0, 40), answerHint(item)));
}

double numberTyped(const SurveyItem& item, const std::string& typed) {
  double value = 0;
  const auto read = std::from_chars(typed.data(), typed.data() + typed.size(), value);
  const bool whole = item.kind != AnswerKind::kScale || value == std::floor(value);
  if (read.ec != std::errc{} || read.ptr != typed.data() + typed.size() || !(value >= item.low && value <= item.high) ||
      !whole)
    refuseAnswer(item, typed);
  return value;
}

}  // namespace

SurveyPlan manipulationSurvey() {
  const auto each = AskedFor::kTaskAndCondition;
  SurveyPlan plan;
  plan.demographics = aboutPeople();
  plan.survey = {
      agreement("did_well", "I did well", each),
      agreement("easy", "It was easy", each),
      agreement("many_tries", "It took many tries", each),
      agreement("took_long", "It took long", each),
      agreement("sure_where", "I was sure where I touched", each),
      agreement("too_much", "There was too much to feel", each),
      agreement("moved_slowly", "I moved slowly", each),
      agreement("comfort", "The displays were comfortable", AskedFor::kSession),
      agreement("pinching", "A display pinched my finger", AskedFor::kSession),
      {"preferred", "Which condition did you prefer?", AnswerKind::kChoice, 1, 7, "", "", {}, AskedFor::kSession, true},
      {"remarks",
       "What did the displays do? Anything else?",
       AnswerKind::kText,
       1,
       7,
       "",
       "",
       {},
       AskedFor::kSession,
       false}};
  return plan;
}

SurveyPlan oneFingerSurvey() {
  SurveyPlan plan;
  plan.demographics = aboutPeople();
  plan.survey = {
      agreement("did_well", "I did well", AskedFor::kCondition),
      agreement("easy", "It was easy", AskedFor::kCondition),
      agreement("comfort", "The display was comfortable", AskedFor::kSession),
      {"remarks", "How did you tell? Anything else?", AnswerKind::kText, 1, 7, "", "", {}, AskedFor::kSession, false}};
  return plan;
}

void validate(const SurveyPlan& plan, std::string_view of) {
  std::set<std::string> names;
  const auto check = [&](const std::vector<SurveyItem>& items, const char* list) {
    for (std::size_t k = 0; k < items.size(); ++k) {
      const SurveyItem& item = items[k];
      const std::string path = fmt::format("session.{}[{}]", list, k), head = fmt::format("{}: {}: ", of, path);
      if (item.name.empty() || item.text.empty())
        throw ParameterError(path,
                             head + "has no name or no text. Give both: the one for tables, the other for people.");
      if (!names.insert(item.name).second)
        throw ParameterError(path, fmt::format("{}the name {} is there twice. Each needs its own.", head, item.name));
      if (item.kind == AnswerKind::kChoice && item.choices.size() == 1)
        throw ParameterError(path + ".choices",
                             head + "a choice of one is none. Give two or more, or none for the study's conditions.");
      if (!(item.low < item.high))
        throw ParameterError(
            path + ".low",
            fmt::format("{}low = {} isn't below high = {}. A scale goes from low to high.", head, item.low, item.high));
    }
  };
  check(plan.demographics, "demographics");
  check(plan.survey, "survey");
}

std::vector<SurveyQuestion> questionsOf(const std::vector<SurveyItem>& items, const std::vector<std::string>& tasks,
                                        const std::vector<NamedCondition>& conditions) {
  std::vector<SurveyQuestion> questions;
  for (const SurveyItem& item : items) {
    SurveyItem asked = item;
    if (item.kind == AnswerKind::kChoice && item.choices.empty())
      for (const NamedCondition& condition : conditions)
        asked.choices.push_back(condition.label.empty() ? condition.name : condition.label);
    if (item.kind == AnswerKind::kChoice && asked.choices.size() < 2) continue;  // of one condition nobody prefers any
    if (item.per == AskedFor::kSession) {
      questions.push_back({asked, "", "", ""});
      continue;
    }
    for (const std::string& task : item.per == AskedFor::kTaskAndCondition ? tasks : std::vector<std::string>{""})
      for (const NamedCondition& condition : conditions)
        questions.push_back({asked, task, condition.name, condition.label});
  }
  return questions;
}

std::string questionText(const SurveyQuestion& q) {
  const std::string& label = q.label.empty() ? q.condition : q.label;
  const std::string of = q.task.empty() ? label : label.empty() ? q.task : q.task + ", " + label;
  return of.empty() ? q.item.text : fmt::format("{} ({})", q.item.text, of);
}

std::string answerHint(const SurveyItem& item) {
  const auto labelled = [](double value, const std::string& label) {
    return label.empty() ? fmt::format("{:g}", value) : fmt::format("{:g} ({})", value, label);
  };
  std::string hint;
  if (item.kind == AnswerKind::kScale || item.kind == AnswerKind::kNumber) {
    hint =
        fmt::format("a number from {} to {}", labelled(item.low, item.low_label), labelled(item.high, item.high_label));
  } else if (item.kind == AnswerKind::kChoice) {
    for (std::size_t k = 0; k < item.choices.size(); ++k)
      hint += fmt::format("{}{} {}",
                          k == 0                         ? ""
                          : k + 1 == item.choices.size() ? " or "
                                                         : ", ",
                          k + 1, item.choices[k]);
  } else {
    hint = "a line of text";
  }
  return item.required ? hint : hint + ", or nothing";
}

SurveyAnswer answerOf(const SurveyItem& item, std::string_view typed_text) {
  const std::string typed = trimmed(typed_text).substr(0, kLongestAnswer);
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (typed.empty() && !item.required) return {"", none};
  if (typed.empty()) refuseAnswer(item, typed);
  if (item.kind == AnswerKind::kText) return {typed, none};
  if (item.kind != AnswerKind::kChoice) return {typed, numberTyped(item, typed)};
  for (std::size_t k = 0; k < item.choices.size(); ++k) {
    if (typed == std::to_string(k + 1) || typed == item.choices[k])
      return {item.choices[k], static_cast<double>(k + 1)};
  }
  refuseAnswer(item, typed);
}

}  // namespace pincer::tasks
