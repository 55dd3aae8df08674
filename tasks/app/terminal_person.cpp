#include "pincer/tasks/app/terminal_person.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

#include "pincer/devices/window/input.h"
#include "pincer/tasks/app/device_options.h"
#include "pincer/tasks/app/print.h"

namespace pincer::tasks {
namespace {

constexpr int kLookAtKeys = 50;  // [ms]

// A trial's ticks; what the person is told lies ready for another thread.
class ToldTrial final : public ServoCycle {
 public:
  ToldTrial(ServoCycle& cycle, const std::function<FingerTold()>& told) : cycle_(cycle), told_(told) {}
  bool tick(double now) override {
    const bool more = cycle_.tick(now);
    const FingerTold told = told_();
    instruction_ = told.instruction;
    stage_ = told.stage;
    return more;
  }
  void cutForces() noexcept override { cycle_.cutForces(); }
  std::vector<StageTimes> stages() const override { return cycle_.stages(); }
  const char* instruction() const { return instruction_; }
  const char* stage() const { return stage_; }

 private:
  ServoCycle& cycle_;
  const std::function<FingerTold()>& told_;
  std::atomic<const char*> instruction_{""}, stage_{""};
};

// Of input that has ended nothing comes.
void takeKeys(AnswerBox& keys) {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char c = 0;
  for (int wait = kLookAtKeys; ::poll(&input, 1, wait) > 0; wait = 0) {
    if (::read(STDIN_FILENO, &c, 1) != 1) return std::this_thread::sleep_for(std::chrono::milliseconds(kLookAtKeys));
    keys.press(c == '\n' ? static_cast<int>(devices::kKeyEnter) : c);
  }
}

// Looks after the keyboard and says what is new, as long as it lives.
class KeyboardThread {
 public:
  KeyboardThread(const ToldTrial& told, AnswerBox& keys)
      : thread_([this, &told, &keys] {
          std::string last;
          while (!done_) {
            const std::string now = fmt::format("{}{}{}", told.instruction(), *told.stage() ? ": " : "", told.stage());
            if (now != last) print(stderr, "{}\n", now);
            last = now;
            takeKeys(keys);
          }
        }) {}
  ~KeyboardThread() {
    done_ = true;
    thread_.join();
  }
  KeyboardThread(const KeyboardThread&) = delete;
  KeyboardThread& operator=(const KeyboardThread&) = delete;

 private:
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace

ServoReport TerminalPerson::serve(ServoCycle& cycle, const std::function<FingerTold()>& told) {
  ToldTrial trial(cycle, told);
  const KeyboardThread keyboard(trial, keys_);
  return runServo(servo_, trial, interrupted_);
}

ServoReport TerminalPerson::serve(FingerTrial& trial, const TrialPlace& place) {
  print(stderr, "Trial {}{}.\n", place.trial, place.trials > 0 ? fmt::format(" of {}", place.trials) : "");
  return serve(trial, [&trial] { return trial.told(); });
}

ServoReport TerminalPerson::serve(HandsCycle& cycle, std::size_t trial, std::size_t trials) {
  print(stderr, "Trial {} of {}.\n", trial + 1, trials);
  return serve(cycle, [&cycle] { return FingerTold{.instruction = cycle.trial().instruction()}; });
}

std::optional<std::string> TerminalPerson::ask(const AskedQuestion& question) const {
  if (!question.problem.empty()) print(stderr, "{}\n", question.problem);
  print(stderr, "{} of {}: {}\n  {}: ", question.place, question.of, question.text, question.hint);
  return typedLine();
}

bool TerminalPerson::show(const StudyPage& page) const {
  print(stderr, "\n{}\n", page.title);
  for (const std::string& line : page.lines) print(stderr, "  {}\n", line);
  print(stderr, "Enter goes on, Ctrl-D ends the session; what is done is kept. ");
  return lineComes();
}

}  // namespace pincer::tasks
