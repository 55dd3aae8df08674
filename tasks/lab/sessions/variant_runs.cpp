#include "pincer/tasks/lab/sessions/variant_runs.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/findings/claims.h"
#include "pincer/tasks/lab/sessions/manipulation_session.h"
#include "pincer/tasks/lab/sessions/session_runs.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

struct VariantRuns {
  const FindingsVariant* variant;
  std::vector<std::string> paths;
};

SessionRun runOf(const FindingsOptions& options, const FindingsVariant& variant, int experiment,
                 const std::string& path, const std::atomic<bool>& interrupted, std::atomic<std::uint64_t>& ticks) {
  ManipulationSessionOptions session;
  session.study = experimentOf(options, variant, experiment);
  session.sample_rate = 0;
  session.claims = claimsHash();
  return {path, manipulationSessionInfo(session), [=, &interrupted, &ticks](bool resume, const ShareDone& share) {
            const auto progress = [&](const TrialProgress& p) {
              share(static_cast<double>(p.done) / static_cast<double>(p.total));
            };
            const auto run = resume ? resumeManipulationSession : runManipulationSession;
            ticks += run(session, path, interrupted, progress).servo.ticks;
          }};
}

// One experiment of each variant after the other, but all of the primary analysis first.
std::vector<SessionRun> runsOf(const FindingsOptions& options, std::vector<VariantRuns>& variants,
                               const std::string& directory, const std::atomic<bool>& interrupted,
                               std::atomic<std::uint64_t>& ticks) {
  std::vector<SessionRun> runs;
  const auto add = [&](VariantRuns& v, int experiment) {
    v.paths.push_back(fmt::format("{}/{}-{}.db", directory, v.variant->name, experiment));
    runs.push_back(runOf(options, *v.variant, experiment, v.paths.back(), interrupted, ticks));
  };
  const auto isPrimary = [](const VariantRuns& v) { return v.variant == &findingsVariants().front(); };
  for (VariantRuns& v : variants) {
    for (int e = 0; isPrimary(v) && e < options.experiments; ++e) add(v, e);
  }
  for (int e = 0; e < options.control_experiments; ++e) {
    for (VariantRuns& v : variants) {
      if (!isPrimary(v)) add(v, e);
    }
  }
  return runs;
}

}  // namespace

FindingsResult runVariants(const FindingsOptions& options, const std::string& directory,
                           const std::atomic<bool>& interrupted,
                           const std::function<void(std::int64_t, std::int64_t)>& progress) {
  validate(options);
  std::vector<VariantRuns> variants;
  for (const FindingsVariant& variant : findingsVariants()) {
    if (isWanted(variant.name, options.only)) variants.push_back({&variant, {}});
  }
  FindingsResult result{options, experimentOf(options, findingsVariants().front(), 0), {}, 0, 0, 0, false};
  if (variants.empty() || interrupted) return result;
  makeDirectory(directory);
  std::atomic<std::uint64_t> ticks{0};
  const auto runs = runsOf(options, variants, directory, interrupted, ticks);
  const auto start = std::chrono::steady_clock::now();
  const double processor = processCpuSeconds();
  runSessions(runs, options.threads, interrupted, progress);
  result.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.processor = processCpuSeconds() - processor;
  result.simulated = static_cast<double>(ticks) / ServoOptions{}.rate;
  result.interrupted = interrupted;
  for (VariantRuns& v : variants) {
    std::erase_if(v.paths, [](const std::string& path) { return !std::filesystem::exists(path); });
    VariantResult judged = judgeVariant(*v.variant, v.paths);
    if (!judged.findings.empty()) result.variants.push_back(std::move(judged));
  }
  return result;
}

}  // namespace pincer::tasks
