// import_notes: what of a robot's file has no effect here, counted, so that nothing is skipped in silence.
#pragma once
#include <string>
#include <vector>

namespace pincer::tasks {

struct ImportNote {
  std::string what;   // "geom solref", "sensor"
  std::string why;    // a sentence; may be empty
  std::string place;  // of the first one
  int count = 0;
};

class ImportNotes {
 public:
  void add(const std::string& what, const std::string& why, const std::string& place, int count = 1);
  const std::vector<ImportNote>& all() const { return notes_; }  // in the order of their first places

 private:
  std::vector<ImportNote> notes_;
};

}  // namespace pincer::tasks
