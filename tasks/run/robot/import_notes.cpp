#include "pincer/tasks/run/robot/import_notes.h"

#include <algorithm>

namespace pincer::tasks {

void ImportNotes::add(const std::string& what, const std::string& why, const std::string& place, int count) {
  const auto same =
      std::find_if(notes_.begin(), notes_.end(), [&](const ImportNote& n) { return n.what == what && n.why == why; });
  if (same == notes_.end()) {
    notes_.push_back({what, why, place, count});
  } else {
    same->count += count;
  }
}

}  // namespace pincer::tasks
