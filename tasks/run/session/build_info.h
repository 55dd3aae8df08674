// build_info: which program this is, and what else the bits of a session may depend on:
// compiler and flags, C library, processor.
//
// A session keeps it, so that a replay can say why bits differ. Two programs with the same `sources` do the same
// arithmetic, whatever their commits say; `commit` is for people.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

// Made at each build by build_info.cmake.
struct BuildInfo {
  const char *version, *commit, *sources, *flags;
};
extern const BuildInfo kBuildInfo;

// Fills in version, commit, sources, build, flags, c_library and processor: of this program, here and now.
void tellBuild(SessionInfo& info);

// Of a session that this program goes on with: where it isn't the one that the session names, "<that>;
// then <this>". What was never told stays so.
void addBuild(SessionInfo& info);

// "pincer 0.1.0 (commit 1f19997a0b2c)"; without a commit "(made without its repository, sources 3f2a9c0d11e2)".
std::string programOf(const SessionInfo& info);

// The text that `pincer --version` prints.
std::string versionText();

// Differences between two runs of a program, a line each: "processor: X then, Y now".
// A fact that one of them doesn't know isn't there.
std::vector<std::string> surroundingsThatDiffer(const SessionInfo& then, const SessionInfo& now);

}  // namespace pincer::tasks
