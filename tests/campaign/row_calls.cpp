// Calls of the operating system that fail, allocations that fail. Then: a sentence, nothing
// half-made, and what was finished is there.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <iterator>

#include "pincer/tests/campaign/failing_works.h"
#include "pincer/tests/campaign/rows.h"

namespace pincer::campaign {
namespace {

const std::vector<int> kErrors = {ENOSPC, EIO, EMFILE, EINTR, EACCES, EROFS, ENOMEM, EDQUOT};

// Half of the draws are sessions. A report takes seconds, so it is rare.
const Work& draw(Case& c, const std::vector<Work>& all) {
  if (c.chance(0.5)) return all[0];
  return all[c.chance(0.06) ? all.size() - 1 : static_cast<std::size_t>(1 + c.below(all.size() - 2))];
}

// Evenly on a logarithmic scale, 1 .. most: the first calls, and then ever fewer.
long drawNumber(Case& c, long most) {
  return static_cast<long>(std::exp(c.random.uniform(0, std::log(static_cast<double>(most) + 1))));
}

// The failures that are most frequent: of a full disk, of a table of files that is full.
int usualErrorOf(const std::string& call) {
  if (call == "write" || call == "ftruncate" || call == "mkdir") return ENOSPC;
  if (call == "open") return EMFILE;
  return call == "mmap" || call == "start" || call == "thread" ? ENOMEM : EIO;
}

// Of each kind of call at most so many, from the first on.
constexpr long kMostEach = 1000;

// Every failure that there is: of each work, each call, each number; of writes a disk that stays full besides.
struct Every {
  const Work& work;
  Failure failure;
};

template <class Take>
void forEveryFailure(const Ground& ground, const std::vector<Work>& all, Take take) {
  for (const Work& work : all) {
    for (const auto& [call, count] : callsOf(ground, work)) {
      for (long at = 1; at <= std::min(count, kMostEach); ++at) {
        take(Every{work, {call, at, usualErrorOf(call), false}});
        if (call == "write") take(Every{work, {call, at, ENOSPC, true}});
      }
    }
  }
}

}  // namespace

void failCall(Case& c) {
  const std::vector<Work> all = works(c.ground);
  const Work& work = draw(c, all);
  Counts counts = callsOf(c.ground, work);
  counts.erase(kAllocation);
  const auto& [call, most] = *std::next(counts.begin(), c.below(counts.size()));
  const int error = call == "write" && c.chance(0.2) ? 0 : c.anyOf(kErrors);
  const bool lasts = error != EINTR && c.chance(0.4);
  runWithFailure(c, work, {call, drawNumber(c, most), error, lasts});
}

void failAllocation(Case& c) {
  const std::vector<Work> all = works(c.ground);
  const Work& work = draw(c, all);
  const bool lasts = c.chance(0.3);
  runWithFailure(c, work, {kAllocation, drawNumber(c, callsOf(c.ground, work).at(kAllocation)), 0, lasts});
}

int allFailures(const Ground& ground) {
  int n = 0;
  forEveryFailure(ground, works(ground), [&](const Every&) { ++n; });
  return n;
}

void failEach(Case& c) {
  const std::vector<Work> all = works(c.ground);
  const std::size_t wanted = scattered(c.ground, c.number, static_cast<std::size_t>(allFailures(c.ground)));
  std::size_t i = 0;
  forEveryFailure(c.ground, all, [&](const Every& every) {
    if (i++ == wanted) runWithFailure(c, every.work, every.failure);
  });
}

}  // namespace pincer::campaign
