#include "pincer/tasks/lab/finger/survey_form.h"

#include <algorithm>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

bool isAnswered(const SurveyForm& form, const SurveyQuestion& q, const std::vector<SurveyRecord>& answered) {
  return std::any_of(answered.begin(), answered.end(), [&](const SurveyRecord& r) {
    return r.participant == form.participant && r.moment == form.moment && r.item == q.item.name && r.task == q.task &&
           r.condition == q.condition;
  });
}

// Until an answer will do; absent: the person has left.
std::optional<SurveyAnswer> askOne(const SurveyQuestion& q, std::size_t place, std::size_t of, const AskPerson& ask) {
  AskedQuestion asked{questionText(q), answerHint(q.item), "", place, of};
  for (;;) {
    const std::optional<std::string> typed = ask(asked);
    if (!typed) return {};
    try {
      return answerOf(q.item, *typed);
    } catch (const InputError& error) {
      asked.problem = error.what();
    }
  }
}

}  // namespace

bool fillForm(const SurveyForm& form, const std::vector<SurveyRecord>& answered, const AskPerson& ask,
              const std::function<void(const SurveyRecord&)>& keep) {
  for (std::size_t k = 0; k < form.questions.size(); ++k) {
    const SurveyQuestion& q = form.questions[k];
    if (isAnswered(form, q, answered)) continue;
    const auto answer = askOne(q, k + 1, form.questions.size(), ask);
    if (!answer) return false;
    keep({form.participant, form.moment, q.item.name, q.task, q.condition, questionText(q), answer->text,
          answer->value});
  }
  return true;
}

}  // namespace pincer::tasks
