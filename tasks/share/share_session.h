// share_session: trials of a session as recordings for a page. The session is replayed, compared to
// the bit as `pincer replay` does, and seen.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "pincer/tasks/lab/sessions/replay.h"
#include "pincer/tasks/share/page_recording.h"

namespace pincer::tasks {

struct SharedSession {
  std::vector<PageRecording> recordings;  // a trial each
  std::vector<std::int64_t> trials;       // which, from 0
  ReplayResult replay;
};

// Throws InputError for a session that can't be replayed.
SharedSession recordSession(const SessionReader& session, const ReplayOptions& options, MeshTable& meshes,
                            const std::atomic<bool>& interrupted,
                            const std::function<void(std::int64_t done, std::int64_t total)>& progress);

}  // namespace pincer::tasks
