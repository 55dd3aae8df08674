// survey: what people are asked beside the trials: about themselves before the first, and afterwards how they thought
// they did. Items are data: a study file names its own. Simulated people leave it empty.
//
// The published study asked people after both manipulation tasks how they thought they did and what the display did (A.
// J. Doxon, dissertation, University of Utah, 2014, ch. 4); its items are lost, and manipulationSurvey() is ours.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/tasks/lab/study/parameter.h"

namespace pincer::tasks {

enum class AnswerKind : std::uint8_t { kScale, kNumber, kChoice, kText };
enum class AskedFor : std::uint8_t { kSession, kCondition, kTaskAndCondition };

struct SurveyItem {
  std::string name;  // in tables: "did_well"
  std::string text;  // "I did well"
  AnswerKind kind = AnswerKind::kScale;
  double low = 1, high = 7;           // of a scale (whole numbers) or a number
  std::string low_label, high_label;  // of a scale: "not at all", "very much"
  std::vector<std::string> choices;   // of a choice; none: the study's conditions
  AskedFor per = AskedFor::kSession;
  bool required = true;  // false: an empty answer will do
  bool operator==(const SurveyItem&) const = default;
};

// In which order a participant does the conditions: balanced over the participants (a Latin square; of two, every other
// participant begins with the second), as the file lists them, or shuffled by the seed.
enum class ConditionOrder : std::uint8_t { kBalanced, kListed, kShuffled };

struct SurveyPlan {
  ConditionOrder order = ConditionOrder::kBalanced;
  int blocks = 1;                         // how often a participant goes through all conditions
  std::vector<std::string> instructions;  // read before each condition, in place of the program's own; empty: those
  int training = 1;                       // trials before each condition of an experiment with one finger
  std::vector<SurveyItem> demographics;   // asked before the first trial
  std::vector<SurveyItem> survey;         // asked after the last
  bool operator==(const SurveyPlan&) const = default;
};

// Age, hand, experience; and per task and condition what the published survey was about (ours).
SurveyPlan manipulationSurvey();
// The same of one task with one finger.
SurveyPlan oneFingerSurvey();

// Throws ParameterError: two items of one name, a choice of fewer than two, low not below high.
void validate(const SurveyPlan& plan, std::string_view of);

// An item that is to be asked, of one condition or task if it is asked for each.
struct SurveyQuestion {
  SurveyItem item;
  std::string task, condition;  // empty: of the whole session
  std::string label;            // of the condition, for people
};

struct NamedCondition {
  std::string name, label;
};
std::vector<SurveyQuestion> questionsOf(const std::vector<SurveyItem>& items, const std::vector<std::string>& tasks,
                                        const std::vector<NamedCondition>& conditions);

// "I did well: sphere-pickup, CLD + force", and how to answer: "1 (not at all) to 7 (very much)".
std::string questionText(const SurveyQuestion& question);
std::string answerHint(const SurveyItem& item);

// Typed text as it is kept: a choice by its words. Throws InputError with a sentence about what would do.
struct SurveyAnswer {
  std::string text;
  double value = 0;  // of a scale or a number; NaN: it has none
};
SurveyAnswer answerOf(const SurveyItem& item, std::string_view typed);

}  // namespace pincer::tasks
