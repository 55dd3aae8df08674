#include "pincer/tasks/share/web_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/share/columns.h"
#include "pincer/tasks/share/packed_text.h"

namespace pincer::tasks {
namespace {

constexpr int kDataVersion = 1;  // of the format of the page's data

std::string_view nameOf(Layer layer) {
  constexpr std::string_view kNames[] = {"solid", "mark", "ground"};  // by Layer
  return kNames[static_cast<std::size_t>(layer)];
}

std::string_view nameOf(Part part) {
  constexpr std::string_view kNames[] = {"thing", "contact", "force", "cone", "joint", "device", "goal"};  // by Part
  return kNames[static_cast<std::size_t>(part)];
}

// Meshes that nothing is drawn with aren't in the page: the others, numbered anew.
struct UsedMeshes {
  std::vector<int> used, place_of;
  UsedMeshes(const WebPage& page, const MeshTable& meshes) : place_of(meshes.size(), -1) {
    for (const PageRecording& recording : page.recordings) {
      for (const PageGroup& group : recording.groups()) {
        int& place = place_of[static_cast<std::size_t>(group.look.mesh)];
        if (place >= 0) continue;
        place = static_cast<int>(used.size());
        used.push_back(group.look.mesh);
      }
    }
  }
};

void writeGroup(JsonWriter& json, const PageGroup& group, int mesh) {
  const Paint& paint = group.look.paint;
  const Vec3 colour = paint.colour.cast<double>();
  json.beginObject().key("mesh").value(mesh).key("items").value(static_cast<std::int64_t>(group.items.size()));
  json.key("layer")
      .value(nameOf(group.look.layer))
      .key("part")
      .value(nameOf(group.look.part))
      .key("colour")
      .value(colour);
  const std::pair<const char*, float> numbers[] = {{"alpha", paint.alpha},
                                                   {"gloss", paint.gloss},
                                                   {"octants", paint.octants},
                                                   {"glow", paint.glow},
                                                   {"fade", paint.fade}};
  for (const auto& [name, value] : numbers) json.key(name).value(static_cast<double>(value));
  json.endObject();
}

void writeCamera(JsonWriter& json, const PageRecording& recording) {
  const Camera& camera = recording.camera();
  json.key("camera").beginObject().key("target").value(camera.target_W).key("eye").value(camera.eye_W());
  json.key("opening").value(camera.opening).key("radius").value(recording.radius()).endObject();
}

void writeRecording(JsonWriter& json, std::string& bytes, const PageRecording& recording, const UsedMeshes& meshes) {
  json.beginObject().key("title").value(recording.title()).key("times").row(recording.times());
  writeCamera(json, recording);
  json.key("groups").beginArray();
  for (const PageGroup& group : recording.groups()) {
    writeGroup(json, group, meshes.place_of[static_cast<std::size_t>(group.look.mesh)]);
    for (const PlacedItem& item : group.items) {
      for (const auto& column : item) appendColumn(bytes, column);
    }
  }
  json.endArray().key("charts").beginArray();
  for (const PageChart& chart : recording.charts()) {
    json.beginObject().key("name").value(chart.name).key("unit").value(chart.unit).endObject();
    appendColumn(bytes, chart.values);
  }
  json.endArray().key("pads").beginArray();
  for (const PagePad& pad : recording.pads()) {
    json.beginObject()
        .key("finger")
        .value(pad.finger)
        .key("reach")
        .value(pad.reach)
        .key("display")
        .value(pad.has_display)
        .endObject();
    for (const auto* column : {&pad.place_L[0], &pad.place_L[1], &pad.tactor_L[0], &pad.tactor_L[1], &pad.sliding}) {
      appendColumn(bytes, *column);
    }
  }
  json.endArray().key("captions").beginArray();
  for (const PageCaption& caption : recording.captions()) {
    json.beginObject()
        .key("picture")
        .value(static_cast<std::int64_t>(caption.picture))
        .key("text")
        .value(caption.text)
        .endObject();
  }
  json.endArray().endObject();
}

// Stands in a script element, which ends at the first "</script".
std::string safeInScript(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

void put(std::string& page, std::string_view mark, std::string_view text) {
  const std::size_t at = page.find(mark);
  if (at != std::string::npos) page.replace(at, mark.size(), text);
}

std::string filledIn(const WebPage& page, const PageData& data) {
  std::string html;
  for (const std::string_view piece : kPageShell.pieces) html += piece;
  // from the end on, so that no text that was put in is searched for marks
  put(html, "{{pincer-data}}", packed(data.bytes));
  put(html, "{{pincer-index}}", safeInScript(data.index));
  put(html, "{{pincer-title}}", escaped(page.title));
  return html;
}

// True if every recording can spare pictures.
bool canHalve(const WebPage& page) {
  return std::all_of(page.recordings.begin(), page.recordings.end(), [](const PageRecording& recording) {
    const std::vector<double>& times = recording.times();
    const double seconds = times.empty() ? 0 : times.back() - times.front();
    return times.size() > 2 && static_cast<double>(times.size()) >= 2 * kFewestPictures * seconds;
  });
}

}  // namespace

void requirePageShell() {
  if (kPageShell.missing)
    throw InputError(fmt::format("share: this pincer was built without its web page: {}", kPageShell.missing));
}

PageData dataOf(const WebPage& page, const MeshTable& meshes) {
  PageData data;
  JsonWriter json;
  json.beginObject()
      .key("version")
      .value(kDataVersion)
      .key("title")
      .value(page.title)
      .key("made_by")
      .value(page.made_by);
  json.key("notes").beginArray();
  for (const std::string& note : page.notes) json.value(note);
  json.endArray().key("meshes").beginArray();
  const UsedMeshes used(page, meshes);
  for (const int mesh : used.used) {
    const PageMesh written = appendMesh(data.bytes, meshes.at(mesh));
    json.beginObject().key("vertices").value(static_cast<std::int64_t>(written.vertices));
    json.key("indices").value(static_cast<std::int64_t>(written.indices)).endObject();
  }
  json.endArray().key("recordings").beginArray();
  for (const PageRecording& recording : page.recordings) writeRecording(json, data.bytes, recording, used);
  json.endArray().endObject();
  data.index = json.text();
  return data;
}

std::string htmlOf(WebPage& page, const MeshTable& meshes, std::size_t largest) {
  requirePageShell();
  for (;;) {
    std::string html = filledIn(page, dataOf(page, meshes));
    if (html.size() <= largest || !canHalve(page)) return html;
    for (PageRecording& recording : page.recordings) recording.halve();
  }
}

}  // namespace pincer::tasks
