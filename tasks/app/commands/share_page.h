// share_page: a session as a page that plays it, for the commands that write one.
#pragma once
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/report.h"
#include "pincer/tasks/lab/sessions/replay.h"
#include "pincer/tasks/share/mesh_table.h"
#include "pincer/tasks/share/web_page.h"

namespace pincer::tasks {

// Writes the page to `out` and tells `say`; made_by is filled in.
void writePage(WebPage& page, const MeshTable& meshes, const std::string& out, std::FILE* say = stdout);

struct SessionPage {
  std::vector<std::int64_t> trials;  // which trial each recording is, from 0
  bool same = false;                 // the replay was the session to the bit; otherwise what differs was printed
};

// Replays the session with a line of progress. `title` empty: the session's task. Throws InputError where
// no trial can be replayed, and Interrupted.
SessionPage writeSessionPage(const SessionReader& session, const ReplayOptions& options, const std::string& title,
                             const std::string& out, std::FILE* say = stdout);

}  // namespace pincer::tasks
