#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "pincer/contact/io/counted.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/sessions/replay.h"
#include "pincer/tasks/lab/sessions/session_hash.h"
#include "pincer/tasks/run/scene/scene_ranges.h"
#include "pincer/tasks/view/trial_recording.h"

namespace pincer::tasks {
namespace {

constexpr const char* kReplayExample = R"(
Runs the trials of a session again, through the same tick, and compares every kept sample and every trial to
the bit: simulated participants do theirs again, people's hands are given as they were recorded. Exit code 1
when something differs; then the first differing tick is named. A session of another version is refused: its
bits may differ. With --other-version it is compared all the same.

With --view the trial is played in a window, to be paused and scrubbed; --screenshot writes a picture of it at
the time of --at.

Examples:
  pincer replay out/first/session.db --trial 3
  pincer replay out/first/session.db --trial 3 --view
  pincer replay out/first/session.db --trial 3 --at 2.5 --screenshot grasp.png)";

constexpr std::int64_t kLastTrial = 1'000'000'000;  // chosen: more than any session has

struct ReplayArguments {
  std::string session;
  std::optional<std::int64_t> trial;  // from 1
  ReplayOptions options;
  double at = 0;  // [s]
  ViewOptions view;
  bool looks() const { return view.view || !view.screenshot.empty(); }
};

// One trial is looked at: the one that was named, or the first.
ReplayResult replayAndLook(const ReplayArguments& arguments, const SessionReader& session) {
  const std::vector<TrialRecord> trials = session.trials();
  ReplayOptions wanted = arguments.options;
  if (!wanted.trial) wanted.trial = trials.empty() ? 0 : trials.front().trial;
  ViewOptions options = arguments.view;
  const auto hands = [&](HandsCycle& cycle, const TrialRecord& row) {
    options.title = fmt::format("{}, trial {}", row.task, row.trial + 1);
    TrialRecording recording = recordTrial(cycle, static_cast<std::size_t>(row.trial), trials.size(), interruptFlag());
    showRecording(cycle.trial().scene().model.grasp, std::move(recording.history), arguments.at, options,
                  interruptFlag());
    return recording.report;
  };
  const auto finger = [&](FingerTrial& trial) {
    options.title = fmt::format("{}, trial {}", session.info().task, *wanted.trial + 1);
    TrialRecording recording = recordFinger(trial, interruptFlag());
    showRecording(trial.pictured(), std::move(recording.history), arguments.at, options, interruptFlag());
    return recording.report;
  };
  return replaySession(session, wanted, interruptFlag(), {}, hands, finger);
}

ReplayResult replayAll(const ReplayArguments& arguments, const SessionReader& session) {
  std::unique_ptr<Progress> line;
  return replaySession(session, arguments.options, interruptFlag(), [&](std::int64_t done, std::int64_t total) {
    if (!line) line = std::make_unique<Progress>("trials", total);
    line->update(done);
  });
}

int replay(const ReplayArguments& arguments) {
  SessionReader session(arguments.session);
  session.heed(interruptFlag());
  const ReplayResult result = arguments.looks() ? replayAndLook(arguments, session) : replayAll(arguments, session);
  for (const std::string& note : result.notes) print(stderr, "pincer: {}\n", note);
  if (result.first) {
    const ReplayDifference& d = *result.first;
    print("Differs first in trial {}, {}: {}\n", d.trial + 1,
          d.tick < 0 ? fmt::format("after {:.3f} s", d.time) : fmt::format("tick {} ({:.3f} s)", d.tick, d.time),
          d.what);
    for (const std::string& line : result.surroundings) print(stderr, "pincer: Not the same: {}.\n", line);
    if (result.notes.empty() && result.surroundings.empty()) {
      print(stderr, "pincer: Version, sources, compiler, flags, C library and processor are those of the session.\n");
    }
    return kExitCheckFailed;
  }
  print("The same to the bit: {}{}, {}{}\n", counted(result.trials, "trial"),
        result.cut_short > 0 ? fmt::format(" and {} that was cut short", result.cut_short) : "",
        counted(result.samples, "sample"),
        result.inputs > 0 ? fmt::format(", {} of a person's hands", counted(result.inputs, "tick")) : "");
  print("state_hash {}\n", sessionHash(session));
  if (!interruptFlag()) return kExitOk;
  print(stderr, "pincer: interrupted; these are the trials that were whole.\n");
  return kExitInterrupted;
}

}  // namespace

void addReplayCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command = app.add_subcommand("replay", "A session again, compared to the bit");
  command->add_option("session", arguments->session, "Session file")->required();
  command->add_option("--trial", arguments->trial, "Only this trial, from 1")->check(wholeWithin(1, kLastTrial));
  command->add_flag("--other-version", arguments->options.other_version,
                    "Also a session that another version made: bits may differ");
  addViewOptions(*command, arguments->view);
  command->add_option("--at", arguments->at, "Begin there [s]")->check(within(ranges::kTime));
  command->footer(kReplayExample);
  command->callback([arguments, &exit_code] {
    if (arguments->trial) arguments->options.trial = *arguments->trial - 1;
    exit_code = replay(*arguments);
  });
}

}  // namespace pincer::tasks
