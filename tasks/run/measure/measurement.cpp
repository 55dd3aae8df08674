#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

bool matches(const std::string& name, const std::string& pattern) {
  const std::string p = "*" + pattern + "*";
  std::size_t i = 0, k = 0, star = 0, resume = 0;  // greedy with one way back: to the last star, one character later
  while (i < name.size()) {
    if (k < p.size() && p[k] == '*') {
      star = k++;
      resume = i;
    } else if (k < p.size() && (p[k] == '?' || p[k] == name[i])) {
      ++i;
      ++k;
    } else {
      k = star + 1;
      i = ++resume;
    }
  }
  while (k < p.size() && p[k] == '*') ++k;
  return k == p.size();
}

}  // namespace pincer::tasks
