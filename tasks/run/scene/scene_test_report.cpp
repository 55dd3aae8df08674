// Verdicts for CI servers, and logs of failed scenes.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/scene/scene_test.h"
#include "pincer/tasks/run/session/build_info.h"

namespace pincer::tasks {
namespace {

// XML 1.0 knows no control characters but tab and line ends.
std::string xmlText(std::string_view text) {
  std::string out;
  for (const char c : printable(text, kLongestMessage)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += (all.empty() ? "" : "\n") + xmlText(line);
  return all;
}

std::string testCase(const SceneVerdict& verdict) {
  const std::filesystem::path path(verdict.file);
  const std::string folder = path.parent_path().string();
  std::string text =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                  xmlText(folder.empty() ? "pincer" : folder), xmlText(path.stem().string()), verdict.seconds);
  if (verdict.isGood()) return text + "/>\n";
  text += ">\n";
  if (!verdict.error.empty()) {
    text += fmt::format("      <error message=\"{}\"/>\n", xmlText(verdict.error));
  } else if (!verdict.run) {
    text += "      <skipped message=\"interrupted\"/>\n";
  } else {
    text += fmt::format("      <failure message=\"{}\">{}</failure>\n", xmlText(verdict.failures.front()),
                        joined(verdict.failures));
  }
  return text + "    </testcase>\n";
}

constexpr std::int64_t kMostHashes = 100'000;  // of a log: 2 MB

// The hash at the start and after each `every` ticks.
std::vector<std::string> hashesOf(Scene scene, std::int64_t every, const std::atomic<bool>& interrupted) {
  Simulation simulation(std::move(scene));
  std::vector<std::string> hashes{hashText(simulation.state().world)};
  for (bool finite = true; finite && simulation.ticks() < simulation.scene().ticks() && !interrupted;) {
    finite = (simulation.tick().status & engine::kStateNotFinite) == 0;
    if (simulation.ticks() % every == 0) hashes.push_back(hashText(simulation.state().world));
  }
  return hashes;
}

// 64 MB: 3 million ticks, nearly an hour at 1 kHz.
constexpr InputKind kSceneLog = {"a log of a failed scene (a JSON file that `pincer test --out` wrote)", 64 * kMegabyte,
                                 true, "A log has 20 bytes per tick."};

}  // namespace

std::string junitText(const std::vector<SceneVerdict>& verdicts) {
  const auto count = [&](auto is) { return std::count_if(verdicts.begin(), verdicts.end(), is); };
  double seconds = 0;
  for (const SceneVerdict& verdict : verdicts) seconds += verdict.seconds;
  const std::string totals =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"", verdicts.size(),
                  count([](const SceneVerdict& v) { return !v.failures.empty(); }),
                  count([](const SceneVerdict& v) { return !v.error.empty(); }),
                  count([](const SceneVerdict& v) { return !v.run && v.error.empty(); }), seconds);
  std::string text =
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite name=\"pincer\" {}>\n",
                  totals, totals);
  for (const SceneVerdict& verdict : verdicts) text += testCase(verdict);
  return text + "  </testsuite>\n</testsuites>\n";
}

std::string sceneLog(const std::string& file) {
  const std::atomic<bool> never{false};
  Scene scene = readSceneOrBuiltin(file);
  const std::int64_t every = scene.ticks() / kMostHashes + 1;
  JsonWriter json;
  json.beginObject()
      .key("scene")
      .value(file)
      .key("build")
      .value(versionText())
      .key("sources")
      .value(kBuildInfo.sources);
  json.key("every").value(every).key("hashes").beginArray();
  for (const std::string& hash : hashesOf(std::move(scene), every, never)) json.value(hash);
  return json.endArray().endObject().text() + "\n";
}

std::string replaySceneLog(const std::string& log, const std::atomic<bool>& interrupted) {
  const JsonValue json = readJson(log, kSceneLog);
  const std::vector<JsonValue>& expected = json.at("hashes", "Is this a log that `pincer test --out` wrote?").array();
  Scene scene = readSceneOrBuiltin(json.at("scene").text());
  const std::int64_t every = json.at("every").integer(1, 1'000'000'000, "Ticks between two hashes.");
  const double h = scene.options.h * static_cast<double>(every);
  const std::vector<std::string> measured = hashesOf(std::move(scene), every, interrupted);
  for (std::size_t i = 0; i < std::min(expected.size(), measured.size()); ++i) {
    if (expected[i].text() == measured[i]) continue;
    return fmt::format("tick {} ({:g} s) differs first: {} then, {} now.{}", static_cast<std::int64_t>(i) * every,
                       static_cast<double>(i) * h, expected[i].text(), measured[i],
                       json.at("sources").text() == kBuildInfo.sources ? "" : " The log is another build's.");
  }
  if (expected.size() == measured.size() || interrupted) return "";
  return fmt::format("{} hashes then, {} now: the scene's duration was changed.", expected.size(), measured.size());
}

}  // namespace pincer::tasks
