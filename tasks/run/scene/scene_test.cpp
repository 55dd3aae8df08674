#include "pincer/tasks/run/scene/scene_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <mutex>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tasks/run/process/threads.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/scene/expectation_text.h"

namespace pincer::tasks {
namespace {

namespace fs = std::filesystem;

// Of a folder's files those that expect something; others may be studies, or what scenes are made of.
// One that can't be read is a test: it fails.
bool expectsSomething(const std::string& path) {
  try {
    const JsonValue json = readJson(path, kSceneFile);
    return json.kind() == JsonValue::Kind::kObject && json.find("bodies") && json.find("expect");
  } catch (const InputError&) {
    return true;
  }
}

std::vector<std::string> scenesBelow(const std::string& folder) {
  std::vector<std::string> found;
  std::error_code ignored;  // a folder that may not be looked into has nothing to offer
  for (const auto& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, ignored)) {
    if (entry.path().extension() == ".json" && entry.is_regular_file(ignored) &&
        expectsSomething(entry.path().string()))
      found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

// The text with `to` in place of `from` in line `line`, counted from 1, both in quotes.
std::string replacedInLine(std::string text, int line, const std::string& from, const std::string& to) {
  std::size_t begin = 0;
  for (int l = 1; l < line; ++l) begin = text.find('\n', begin) + 1;
  const std::size_t key = text.find("\"hash\"", begin);
  const std::size_t at = text.find('"' + from + '"', key == std::string::npos ? begin : key + 6);
  if (at == std::string::npos)
    throw InputError(fmt::format("line {}: the hash isn't written plainly; put it in by hand: {}", line, to));
  return text.replace(at + 1, from.size(), to);
}

// Several hashes on one line are told apart by what they were.
void writeHashes(const std::string& file, const ExpectationLog& log) {
  std::string text = readInputFile(file, kSceneFile);
  bool changed = false;
  for (std::size_t i = 0; i < log.expectations().size(); ++i) {
    const Expectation& expected = log.expectations()[i];
    const Outcome& outcome = log.outcomes()[i];
    if (!expected.hash || !outcome.reached || outcome.holds()) continue;
    text = replacedInLine(text, expected.hash_line, *expected.hash, outcome.hash);
    changed = true;
  }
  if (changed) writeAtomically(file, text);
}

std::vector<std::string> failuresOf(const SimResult& result, bool hashes_are_renewed) {
  std::vector<std::string> failures;
  for (std::size_t i = 0; i < result.log.expectations().size(); ++i) {
    const Expectation& expected = result.log.expectations()[i];
    const Outcome& outcome = result.log.outcomes()[i];
    if (outcome.holds() || (expected.hash && hashes_are_renewed && outcome.reached)) continue;
    failures.push_back(outcomeText(expected, outcome) +
                       (expected.because.empty() ? "" : ", because " + expected.because));
  }
  if (result.broke) failures.push_back("the state isn't finite any more");
  return failures;
}

class SceneTests {
 public:
  SceneTests(const std::vector<std::string>& files, const SceneTestOptions& options,
             const std::atomic<bool>& interrupted)
      : files_(files), options_(options), interrupted_(interrupted), verdicts_(files.size()) {}

  std::vector<SceneVerdict> run() {
    onThreads(options_.jobs, [this] {
      for (std::size_t i = next_++; i < files_.size() && !interrupted_; i = next_++) runOne(i);
    });
    for (std::size_t i = 0; i < files_.size(); ++i) verdicts_[i].file = files_[i];
    return std::move(verdicts_);
  }

 private:
  void runOne(std::size_t index) {
    SceneVerdict& verdict = verdicts_[index];
    verdict.file = files_[index];
    const double start = steadySeconds();
    try {
      judge(verdict);
    } catch (const InputError& error) {
      verdict.error = error.what();
    }
    verdict.seconds = steadySeconds() - start;
    const std::lock_guard lock(mutex_);
    if (options_.progress) options_.progress(verdict, ++done_, files_.size());
  }

  void judge(SceneVerdict& verdict) {
    Simulation simulation(readSceneOrBuiltin(verdict.file));
    verdict.expectations = simulation.scene().expectations.size();
    if (verdict.expectations == 0)
      throw InputError(
          fmt::format("{}: expects nothing, so it tests nothing. Add \"expect\" (docs/scenes.md).", verdict.file));
    const SimResult result = runScene(simulation, {}, interrupted_, [](std::int64_t) {});
    if (result.interrupted) return;
    verdict.run = true;
    if (options_.update_hashes) writeHashes(verdict.file, result.log);
    verdict.failures = failuresOf(result, options_.update_hashes);
    if (verdict.failures.empty() || !options_.failed) return;
    const std::lock_guard lock(mutex_);
    options_.failed(verdict, simulation);
  }

  const std::vector<std::string>& files_;
  const SceneTestOptions& options_;
  const std::atomic<bool>& interrupted_;
  std::vector<SceneVerdict> verdicts_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  // guards what is called, and the rest
  std::size_t done_ = 0;
};

}  // namespace

std::vector<std::string> findSceneTests(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) {
      files.push_back(path);
      continue;
    }
    const std::vector<std::string> found = scenesBelow(path);
    if (found.empty())
      throw InputError(fmt::format("{}: no scene in this folder expects anything, so there is nothing to test.", path));
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

std::vector<SceneVerdict> runSceneTests(const std::vector<std::string>& files, const SceneTestOptions& options,
                                        const std::atomic<bool>& interrupted) {
  return SceneTests(files, options, interrupted).run();
}

}  // namespace pincer::tasks
