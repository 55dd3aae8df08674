// finger_host: who does the trials with one finger and who watches them. Empty functions: nobody
// does, and simulated participants do them.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/finger/finger_trial.h"
#include "pincer/tasks/lab/finger/survey_form.h"

namespace pincer::tasks {

// A page that a person reads; Enter goes on.
struct StudyPage {
  std::string title;
  std::vector<std::string> lines;
};

// Which trial it is, as a person counts.
struct TrialPlace {
  std::int64_t trial = 1, trials = 0;  // of the run; 0: nobody knows how many there will be
  std::string condition;               // for who watches a simulated participant
};

struct FingerHost {
  // Whoever wears the finger where the trial puts it.
  std::function<std::unique_ptr<WornFinger>(const FingerPlace& place)> finger;
  std::function<ServoReport(FingerTrial& trial, const TrialPlace& place)> serve;
  // False: the person has left.
  std::function<bool(const StudyPage& page)> show;
  AskPerson ask;  // a question of the survey
  // Asks the operator whether forces may come on: before the first trial, and before the
  // one after a fault. False ends the session.
  std::function<bool(const std::string& why)> arm;
  // Only this one of the study's participants, from 0; absent: all of them.
  std::optional<std::int64_t> person;

  bool isPersons() const { return static_cast<bool>(finger); }
};

}  // namespace pincer::tasks
