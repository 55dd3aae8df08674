// survey_form: the questions of a study put to a person, one after the other, each answer durable before the next.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/study/survey.h"
#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

// A question on a screen: which of how many, what was wrong with the last answer (empty: nothing).
struct AskedQuestion {
  std::string text, hint, problem;
  std::size_t place = 1, of = 1;
};
// The text that the person typed; absent: the person has left.
using AskPerson = std::function<std::optional<std::string>(const AskedQuestion& question)>;

struct SurveyForm {
  std::vector<SurveyQuestion> questions;
  std::string moment;  // "before", "after"
  std::int64_t participant = 0;
};

// Asks what isn't among `answered` yet, again and again until an answer will do. False: the person has left.
bool fillForm(const SurveyForm& form, const std::vector<SurveyRecord>& answered, const AskPerson& ask,
              const std::function<void(const SurveyRecord&)>& keep);

}  // namespace pincer::tasks
