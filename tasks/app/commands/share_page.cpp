#include "pincer/tasks/app/commands/share_page.h"

#include <fmt/format.h>

#include <cstdint>
#include <memory>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/contact/io/counted.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/run/process/interrupted.h"
#include "pincer/tasks/run/session/build_info.h"
#include "pincer/tasks/share/share_session.h"

namespace pincer::tasks {
namespace {

std::string programText() {
  SessionInfo info;
  tellBuild(info);
  return programOf(info);
}

// One sentence for a person: did the session come again?
std::string verdictOn(const ReplayResult& replay) {
  if (!replay.first) {
    return fmt::format("Replayed from its session and the same to the bit: {}, {}.", counted(replay.trials, "trial"),
                       counted(replay.samples, "sample"));
  }
  return fmt::format("The replay differs from the session in trial {} at {:.3f} s ({}), and isn't what was recorded.",
                     replay.first->trial + 1, replay.first->time, replay.first->what);
}

}  // namespace

void writePage(WebPage& page, const MeshTable& meshes, const std::string& out, std::FILE* say) {
  page.made_by = programText();
  const std::string html = htmlOf(page, meshes);
  writeAtomically(out, html);
  print(say, "{}: {}, {:.2f} MB\n", printablePath(out),
        counted(static_cast<std::int64_t>(page.recordings.size()), "recording"),
        1e-6 * static_cast<double>(html.size()));
  if (html.size() > kLargestPage) {
    print(stderr,
          "pincer: this is more than {:.0f} MB even with {:.0f} pictures a second. Share one trial (--trial), a "
          "shorter run (--duration), or "
          "meshes of fewer triangles (pincer mesh simplify).\n",
          1e-6 * static_cast<double>(kLargestPage), kFewestPictures);
  }
}

SessionPage writeSessionPage(const SessionReader& session, const ReplayOptions& options, const std::string& title,
                             const std::string& out, std::FILE* say) {
  MeshTable meshes;
  std::unique_ptr<Progress> line;
  SharedSession shared =
      recordSession(session, options, meshes, interruptFlag(), [&](std::int64_t done, std::int64_t total) {
        if (!line) line = std::make_unique<Progress>("trials", total);
        line->update(done);
      });
  line.reset();
  throwIf(interruptFlag());
  if (shared.recordings.empty())
    throw InputError(fmt::format("{}: no trial of it can be replayed.", printablePath(session.path())));
  WebPage page;
  page.title = title.empty() ? session.info().task : title;
  page.recordings = std::move(shared.recordings);
  for (const std::string& note : shared.replay.notes) page.notes.push_back(note);
  const std::string verdict = verdictOn(shared.replay);
  page.notes.push_back(verdict);
  const bool same = !shared.replay.first;
  if (!same) print(stderr, "pincer: {}\n", verdict);
  writePage(page, meshes, out, say);
  return {std::move(shared.trials), same};
}

}  // namespace pincer::tasks
