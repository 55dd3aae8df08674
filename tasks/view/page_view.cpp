#include "pincer/tasks/view/page_view.h"

#include <fmt/format.h>

#include <cctype>

#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kMostTyped = 400;  // characters

// A page in an empty world; `hear` gets each key that goes down.
class PageWindow {
 public:
  PageWindow(devices::Surface& surface, const std::string& title, std::function<void(const devices::InputEvent&)> hear)
      : start_(Snapshot::sizedFor(nothing_)),
        channel_(start_),
        viewer_(surface, nothing_, start_, channel_, pace_, nullptr,
                {.title = title, .keys = false, .type = std::move(hear)}) {}

  bool update(const StudyPage& page) {
    viewer_.showPage(page);
    return viewer_.update();
  }

 private:
  const grasp::GraspModel nothing_ = grasp::buildGrasp(engine::WorldBuilder{engine::WorldOptions{}}, {});
  const Snapshot start_;
  SnapshotChannel channel_;
  PaceControl pace_;
  Viewer viewer_;
};

// The character of a key; 0: none.
char typedCharacter(const devices::InputEvent& event) {
  // Keys that aren't letters on an American keyboard, without and with Shift.
  constexpr std::string_view kPlain = "`1234567890-=[]\\;',./", kShifted = "~!@#$%^&*()_+{}|:\"<>?";
  if (event.code < ' ' || event.code > '~') return 0;
  const char key = static_cast<char>(event.code);
  if (std::isalpha(static_cast<unsigned char>(key)))
    return event.modifiers.shift ? key : static_cast<char>(std::tolower(static_cast<unsigned char>(key)));
  const auto at = kPlain.find(key);
  return event.modifiers.shift && at != std::string_view::npos ? kShifted[at] : key;
}

}  // namespace

bool showPage(devices::Surface& surface, const std::string& title, const StudyPage& page,
              const std::atomic<bool>& interrupted) {
  bool read = false;
  PageWindow window(surface, title,
                    [&](const devices::InputEvent& event) { read = read || event.code == devices::kKeyEnter; });
  StudyPage shown = page;
  shown.lines.push_back("Enter: go on.   Esc: leave; what is done is kept.");
  while (!read && !interrupted) {
    if (!window.update(shown)) return false;
  }
  return read;
}

std::optional<std::string> askOnPage(devices::Surface& surface, const std::string& title, const AskedQuestion& question,
                                     const std::atomic<bool>& interrupted) {
  std::string typed;
  bool entered = false;
  PageWindow window(surface, title, [&](const devices::InputEvent& event) {
    const char c = typedCharacter(event);
    if (event.code == devices::kKeyEnter) entered = true;
    if (event.code == devices::kKeyBackspace && !typed.empty()) typed.pop_back();
    if (c != 0 && typed.size() < kMostTyped) typed += c;
  });
  while (!entered && !interrupted) {
    StudyPage page{fmt::format("Question {} of {}", question.place, question.of),
                   {question.text, question.hint + ".", "> " + typed + "_"}};
    if (!question.problem.empty()) page.lines.push_back(question.problem);
    page.lines.push_back("Enter: that is my answer.   Esc: leave; what is done is kept.");
    if (!window.update(page)) return {};
  }
  return entered ? std::optional(typed) : std::nullopt;
}

}  // namespace pincer::tasks
