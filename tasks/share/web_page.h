// web_page: recordings as one HTML file that needs nothing else: the replay program, what is drawn, and how it moves.
//
// The file holds an index (JSON) and data (base64 of zlib's format). The data, in order:
//   per mesh         appendMesh (mesh_table.h)
//   per recording    per group, per item: 12 columns (columns.h); per chart a column; per pad 5: place, tactor, sliding
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/tasks/share/page_recording.h"

namespace pincer::tasks {

// The page without its index and data, made when pincer was built (page/bundle.cmake).
struct PageShell {
  std::span<const std::string_view> pieces;
  const char* missing;  // why there is none; null if there is
};
extern const PageShell kPageShell;

// Throws InputError with the remedy when pincer was built without it.
void requirePageShell();

struct WebPage {
  std::string title;
  std::vector<std::string> notes;  // sentences below the title
  std::string made_by;             // which program
  std::vector<PageRecording> recordings;
};

constexpr std::size_t kLargestPage = 5'000'000;  // [bytes]: goes through by mail, and opens at once
constexpr double kFewestPictures = 10;           // a second; with fewer, motion isn't seen as one

// The page. If it is larger than `largest`, with every second picture, and so on, down to
// kFewestPictures; then as large as it is.
std::string htmlOf(WebPage& page, const MeshTable& meshes, std::size_t largest = kLargestPage);

// The index and the data apart, as they stand in the page.
struct PageData {
  std::string index, bytes;
};
PageData dataOf(const WebPage& page, const MeshTable& meshes);

}  // namespace pincer::tasks
