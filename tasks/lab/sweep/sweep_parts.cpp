#include "pincer/tasks/lab/sweep/sweep_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/files/fingerprint.h"
#include "pincer/tasks/run/session/build_info.h"

namespace pincer::tasks {

SweepTable tableOf(const std::string& what, const SweepGrid& grid) {
  SweepTable table;
  table.what = what;
  table.parameters = grid.paths;
  table.points = grid.points;
  return table;
}

void addMeasure(SweepTable& table, const std::string& label, bool plotted) {
  if (std::find(table.measures.begin(), table.measures.end(), label) != table.measures.end())
    throw InputError(fmt::format("sweep: {} is measured twice. Name each quantity once.", label));
  table.measures.push_back(label);
  table.plotted.push_back(plotted);
}

void writeGrid(const SweepTable& table, JsonWriter& json) {
  json.key("sources").value(kBuildInfo.sources).key("parameters").beginArray();
  for (const std::string& name : table.parameters) json.value(name);
  json.endArray().key("cases").value(static_cast<std::int64_t>(table.points.size()));
  std::string points;
  for (const std::vector<double>& point : table.points) {
    for (const double value : point) points += fmt::format("{} ", value);
    points += '\n';
  }
  json.key("points").value(fingerprint(points));
}

void placeWritten(const std::string& written, const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(written, std::ios::binary).rdbuf();
  writeAtomically(path, bytes.str());
}

std::string studyDefinition(const SweepTable& table, const std::string& task, int participants, std::uint64_t seed) {
  JsonWriter json;
  json.beginObject().key("task").value(task).key("participants").value(participants).key("seed").value(seed);
  writeGrid(table, json);
  return json.endObject().text();
}

}  // namespace pincer::tasks
