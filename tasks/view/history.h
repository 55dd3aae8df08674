// history: the snapshots that were seen, to go back in.
#pragma once
#include <deque>

#include "pincer/contact/assert.h"
#include "pincer/tasks/run/tick/snapshot.h"

namespace pincer::tasks {

class History {
 public:
  explicit History(std::size_t most = 7200) : most_(most) {}  // two minutes at 60 pictures a second

  // Of its contacts those that count.
  void add(const Snapshot& snapshot) {
    if (!kept_.empty() && kept_.back().tick == snapshot.tick) return;
    kept_.push_back(snapshot);
    kept_.back().contacts.resize(static_cast<std::size_t>(snapshot.contact_count));
    kept_.back().contacts.shrink_to_fit();
    if (kept_.size() > most_) kept_.pop_front();
  }
  std::size_t size() const { return kept_.size(); }
  const Snapshot& at(std::size_t i) const { return kept_[i]; }

  // The last one at or before `time` [s], the first if there is none. Not of an empty history.
  std::size_t find(double time) const {
    PINCER_ASSERT(!kept_.empty());
    std::size_t low = 0, high = kept_.size();
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (kept_[middle].time <= time ? low : high) = middle;
    }
    return low;
  }

 private:
  std::size_t most_;
  std::deque<Snapshot> kept_;
};

}  // namespace pincer::tasks
