#include "pincer/tests/campaign/session_checks.h"

#include <fmt/format.h>

#include "pincer/tests/campaign/inputs.h"

namespace pincer::campaign {

void compareTrials(Case& c, const SessionState& before, const SessionState& after) {
  for (const auto& [trial, row] : before.trials) {
    const auto found = after.trials.find(trial);
    if (found == after.trials.end()) c.fault(Verdict::kLost, fmt::format("trial {} was finished and is gone", trial));
    if (found != after.trials.end() && found->second != row)
      c.fault(Verdict::kLost, fmt::format("trial {} has changed", trial));
  }
  if (!after.doubled.empty()) c.fault(Verdict::kLost, fmt::format("trial {} stands there twice", after.doubled[0]));
  if (!before.integrity.empty() && before.readable && before.integrity != "ok")
    c.fault(Verdict::kLost, "integrity: " + before.integrity);
}

void requireWhole(Case& c) {
  const SessionState state = stateOf(c.folder / "out/session.db");
  if (state.state != "complete") c.fault(Verdict::kWrong, "the session is \"" + state.state + "\" after all was run");
  compareTrials(c, stateOf(pickupSession(c.ground)), state);
  if (state.trials.size() != kPickupTrials)
    c.fault(Verdict::kLost, fmt::format("{} trials of {}", state.trials.size(), kPickupTrials));
}

void completeSession(Case& c) {
  const SessionState before = stateOf(c.folder / "out/session.db");
  const Ended ended = c.run(c.pincer(resumedPickup("out")), {.name = "out"});
  if (ended.stopped) return c.fault(Verdict::kHung, "going on takes longer than its limit");
  if (ended.exit_code == 0 && ended.signal == 0) {
    compareTrials(c, before, stateOf(c.folder / "out/session.db"));
    return requireWhole(c);
  }
  if (before.readable && before.state == "running")
    return c.fault(Verdict::kLost, "can't be gone on with: " + ended.error);
  if (before.state == "complete") return;  // --resume says that nothing is left
  fs::remove_all(c.folder / "out");
  const Ended anew = c.run(c.pincer(pickupArguments("out")), {.codes = {0}});
  if (anew.stopped) return c.fault(Verdict::kHung, "beginning anew takes longer than its limit");
  requireWhole(c);
}

}  // namespace pincer::campaign
