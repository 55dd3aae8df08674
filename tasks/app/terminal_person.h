// terminal_person: somebody who wears real devices and has the terminal: pages are printed, lines
// are keys: "1" and Enter, or Enter alone.
#pragma once
#include <atomic>
#include <memory>

#include "pincer/tasks/lab/experiments/hands_cycle.h"
#include "pincer/tasks/lab/finger/answer_box.h"
#include "pincer/tasks/lab/finger/finger_host.h"

namespace pincer::tasks {

class TerminalPerson {
 public:
  TerminalPerson(const ServoOptions& servo, const std::atomic<bool>& interrupted)
      : servo_(servo), interrupted_(interrupted) {}

  AnswerBox& keys() { return keys_; }
  // Of a finger host:
  ServoReport serve(FingerTrial& trial, const TrialPlace& place);
  // Of a trial with two fingers: Enter answers.
  ServoReport serve(HandsCycle& cycle, std::size_t trial, std::size_t trials);
  bool show(const StudyPage& page) const;
  std::optional<std::string> ask(const AskedQuestion& question) const;

 private:
  ServoReport serve(ServoCycle& cycle, const std::function<FingerTold()>& told);

  ServoOptions servo_;
  const std::atomic<bool>& interrupted_;
  AnswerBox keys_;
};

}  // namespace pincer::tasks
