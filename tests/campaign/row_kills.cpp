// Ends that nobody chose: kill -9, two programs on one session, signals. Finished trials must be
// there, each once, as if nothing had been.
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/rows.h"
#include "pincer/tests/campaign/session_checks.h"

namespace pincer::campaign {

void killSession(Case& c) {
  const fs::path session = c.folder / "out/session.db";
  Launch launch = c.pincer(pickupArguments("out"));
  // Every third one in the first 30 ms, where the session is being made.
  launch.blow =
      Blow{SIGKILL, c.number % 3 == 0 ? c.random.uniform(0, 0.03) : c.random.uniform(0, c.ground.session_time)};
  if (c.runUnjudged(launch).struck) c.hit();
  SessionState before = stateOf(session);
  if (before.readable && before.state == "running" && c.chance(0.5)) {
    Launch again = c.pincer(resumedPickup("out"));
    again.blow = Blow{SIGKILL, c.random.uniform(0, c.ground.session_time / 2)};
    c.runUnjudged(again);
    const SessionState after = stateOf(session);
    compareTrials(c, before, after);
  }
  c.count(Verdict::kStopped, 0);
  completeSession(c);
}

void runTwoPrograms(Case& c) {
  const fs::path session = c.folder / "out/session.db";
  const bool both_resume = c.number % 2 == 1;
  if (both_resume) {
    Launch launch = c.pincer(pickupArguments("out"));
    launch.blow = Blow{SIGKILL, 0.4 * c.ground.session_time};
    c.runUnjudged(launch);
    // a quick machine: nothing is left to go on with
    if (stateOf(session).state != "running") return c.count(Verdict::kFine, 0);
  }
  Launch first = c.pincer(both_resume ? resumedPickup("out") : pickupArguments("out"));
  first.log += "-first";
  RunningProgram other(first);
  ::usleep(static_cast<useconds_t>(c.random.uniform(0.05e6, 0.5e6) * c.ground.session_time));
  const Ended second = c.run(c.pincer(resumedPickup("out")), {.name = "out"});
  const Ended one = other.wait();
  c.judge(first, one, {.name = "out"});
  c.count(Verdict::kFine);
  const int wins = (one.exit_code == 0 && one.signal == 0) + (second.exit_code == 0 && second.signal == 0);
  if (wins != 1)
    c.fault(Verdict::kWrong, fmt::format("{} of two programs ran the session: exit codes {} and {}", wins,
                                         one.exit_code, second.exit_code));
  requireWhole(c);
}

void signalProgram(Case& c) {
  const std::vector<std::vector<std::string>> programs = {
      pickupArguments("out"),
      {"run", "repeated-localisation", "--participants", "1", "--sample-rate", "10", "--out", "out"},
      {"report", pickupSession(c.ground), "--html", "report.html"},
      {"export", pickupSession(c.ground), "--out", "csv"},
      {"export", studySession(c.ground), "--bids", "bids"},
      {"sweep", "s4_pinch", "--vary", "sphere.material.mu_s=0.1:0.5:9", "--out", "out"},
      {"sim", "s4_pinch", "--out", "table.csv"},
      {"replay", pickupSession(c.ground)}};
  constexpr double kSpans[] = {1, 1, 1.2, 0.06, 0.1, 0.5, 1, 1.2};  // [s] that each takes
  const auto which = static_cast<std::size_t>(c.number) % programs.size();
  Launch launch = c.pincer(programs[which]);
  launch.blow = Blow{c.anyOf(std::vector<int>{SIGINT, SIGTERM, SIGHUP}), c.random.uniform(0, kSpans[which])};
  launch.limit = 10;
  const Ended ended = c.run(launch, {.codes = {0, 5}});
  if (ended.struck) c.hit();
  const SessionState state = stateOf(c.folder / "out/session.db");
  // In its first milliseconds a program has no handler yet, and nothing to keep.
  if (state.readable && state.state == "running") c.fault(Verdict::kWrong, "the session is left \"running\"");
  if (!state.doubled.empty()) c.fault(Verdict::kLost, "a trial stands there twice");
  if (ended.struck && which == 0 && state.readable && state.state != "complete") {
    completeSession(c);
  }
}

}  // namespace pincer::campaign
