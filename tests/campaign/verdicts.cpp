#include "pincer/tests/campaign/verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <string_view>

namespace pincer::campaign {
namespace {

constexpr std::size_t kLongestMessage = 4096;  // [bytes] beyond it nobody finds the sentence that helps

std::optional<Finding> howItEnded(const Launch& launch, const Ended& e, const Expect& expect) {
  if (e.hung)
    return Finding{Verdict::kHung, fmt::format("still there {:.1f} s after it was asked to stop", launch.grace)};
  const bool asked_for = (e.stopped && e.signal == launch.stop_signal) ||
                         (e.struck && e.signal == launch.blow->signal) ||
                         std::find(expect.signals.begin(), expect.signals.end(), e.signal) != expect.signals.end();
  if (e.signal != 0 && !asked_for)
    return Finding{Verdict::kCrashed, fmt::format("ended by signal {} ({})", e.signal, ::strsignal(e.signal))};
  if (e.error.find("Sanitizer") != std::string::npos || e.error.find("runtime error:") != std::string::npos) {
    return Finding{Verdict::kCrashed, "a sanitizer's report"};
  }
  return {};
}

// Two clauses at least: what is wrong, and what to do.
bool hasRemedy(const std::string& message) {
  for (std::size_t i = 8; i + 2 < message.size(); ++i) {  // behind "pincer: "
    const bool ends = std::string(".;:!?)").find(message[i]) != std::string::npos &&
                      (message[i + 1] == ' ' || message[i + 1] == '\n');
    if (ends && message.size() - i > 8) return true;
  }
  return false;
}

std::optional<Finding> howItRefused(const Ended& e, const Expect& expect) {
  if (expect.may_be_silent) return {};
  const auto wrong = [&](const std::string& why) {
    return Finding{Verdict::kWrong, fmt::format("exit code {}: {}", e.exit_code, why)};
  };
  const std::size_t at = e.error.find("pincer: ");
  if (e.error.empty()) return wrong("no message");
  if (at != 0 && (at == std::string::npos || e.error[at - 1] != '\n'))
    return wrong("the message doesn't begin with \"pincer: \"");
  const std::string message = e.error.substr(at);
  if (message.size() > kLongestMessage) return wrong(fmt::format("a message of {} bytes", message.size()));
  if (!expect.name.empty() && message.find(expect.name) == std::string::npos)
    return wrong("the message doesn't name " + expect.name + ": " + message);
  if (!hasRemedy(message)) return wrong("the message has no remedy: " + message);
  return {};
}

constexpr std::string_view kJournal = "-journal";  // SQLite's, behind the database's name

bool isPart(const std::string& name) {
  return name.ends_with(".part") || name.ends_with(kJournal) || name.ends_with(".tmp") || name.find("gnuplot") == 0;
}

bool isJournalOfOne(const std::string& name, const std::set<std::string>& files) {
  return name.ends_with(kJournal) && files.contains(name.substr(0, name.size() - kJournal.size()));
}

}  // namespace

std::string controlCharacterIn(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c0 = (byte < 0x20 && byte != '\n') || byte == 0x7f;
    const bool c1 = byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
    const bool turns = text.compare(i, 2, "\xe2\x80") == 0 && i + 2 < text.size() &&
                       static_cast<unsigned char>(text[i + 2]) >= 0xaa &&
                       static_cast<unsigned char>(text[i + 2]) <= 0xae;  // the direction of writing
    if (c0 || c1 || turns) return fmt::format("0x{:02x} at byte {}", byte, i);
  }
  return {};
}

std::optional<Finding> verdictOn(const Launch& launch, const Ended& e, const Expect& expect) {
  if (auto finding = howItEnded(launch, e, expect)) return finding;
  if (e.peak_memory > 1024 * expect.most_memory)
    return Finding{Verdict::kWrong, fmt::format("took {} MB of memory", e.peak_memory / 1024)};
  for (const auto& [name, text] : {std::pair{"standard output", &e.out}, std::pair{"standard error", &e.error}}) {
    const std::string control = controlCharacterIn(*text);
    if (!control.empty()) return Finding{Verdict::kWrong, fmt::format("a control character on {}: {}", name, control)};
  }
  if (e.signal != 0) return {};
  const bool is_documented = e.exit_code >= 0 && e.exit_code <= 5;
  if (!is_documented || (!e.stopped && !e.struck && !expect.codes.contains(e.exit_code))) {
    return Finding{Verdict::kWrong, fmt::format("exit code {} where {} were expected; {}", e.exit_code,
                                                fmt::join(expect.codes, ", "), e.error.substr(0, 300))};
  }
  if (e.exit_code >= 2 && e.exit_code <= 4) return howItRefused(e, expect);
  return {};
}

std::set<std::string> filesIn(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code ignored;
  for (const auto& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, ignored)) {
    names.insert(fs::relative(entry.path().parent_path(), folder) / entry.path().filename());
  }
  return names;
}

std::string strayIn(const Launch& launch, const Ended& e, const std::set<std::string>& before, const Expect& expect) {
  if (e.signal == SIGKILL) return {};
  const std::set<std::string> files = filesIn(launch.folder);
  for (const std::string& name : files) {
    if (expect.may_keep_journal && isJournalOfOne(name, files)) continue;
    if (!before.contains(name) && (isPart(fs::path(name).filename()) || (e.signal == 0 && e.exit_code == 2)))
      return name;
  }
  return {};
}

}  // namespace pincer::campaign
