// The table of a sweep: for a terminal, as CSV, as a picture.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/sweep/sweep.h"
#include "pincer/tasks/run/csv.h"
#include "pincer/tasks/run/files/json_writer.h"

namespace pincer::tasks {
namespace {

std::string rightAligned(const std::string& text, std::size_t width) {
  return std::string(width > text.size() ? width - text.size() : 0, ' ') + text;
}

void addHeadings(const SweepTable& table, CsvTable& csv) {
  for (const std::string& name : table.parameters) csv.add(name);
  for (const std::string& name : table.measures) csv.add(name);
}

void addNumbers(const SweepTable& table, std::size_t i, CsvTable& csv) {
  for (const double value : table.points[i]) csv.add(value);
  for (const double value : table.results[i].values) csv.add(value);
}

}  // namespace

std::string sweepText(const SweepTable& table) {
  std::vector<std::vector<std::string>> rows{table.parameters};
  rows[0].insert(rows[0].end(), table.measures.begin(), table.measures.end());
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    if (!table.results[i].done) continue;
    rows.emplace_back();
    for (const double value : table.points[i]) rows.back().push_back(fmt::format("{:.6g}", value));
    for (const double value : table.results[i].values) rows.back().push_back(fmt::format("{:.6g}", value));
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::size_t width = 0;
      for (const auto& other : rows) width = std::max(width, other[c].size());
      text += (c ? "  " : "") + rightAligned(row[c], width);
    }
    text += '\n';
  }
  return text;
}

std::string sweepCsv(const SweepTable& table) {
  CsvTable csv;
  addHeadings(table, csv);
  csv.add("state_hash");
  csv.add("error");
  csv.endRow();
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    if (!table.results[i].done) continue;
    addNumbers(table, i, csv);
    csv.add(table.results[i].state_hash);
    csv.add(table.results[i].error);
    csv.endRow();
  }
  return csv.take();
}

std::string sweepJson(const SweepTable& table) {
  JsonWriter json;
  json.beginObject().key("what").value(table.what).key("parameters").beginArray();
  for (const std::string& name : table.parameters) json.value(name);
  json.endArray().key("measures").beginArray();
  for (const std::string& name : table.measures) json.value(name);
  json.endArray().key("cases").beginArray();
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    if (!table.results[i].done) continue;
    json.beginObject().key("case").value(static_cast<std::int64_t>(i)).key("parameters").beginArray();
    for (const double value : table.points[i]) json.value(value);
    json.endArray().key("measures").beginArray();
    for (const double value : table.results[i].values) json.value(value);
    json.endArray()
        .key("state_hash")
        .value(table.results[i].state_hash)
        .key("error")
        .value(table.results[i].error)
        .endObject();
  }
  return json.endArray().endObject().text() + "\n";
}

std::vector<std::string> writeSweep(const SweepTable& table, const std::string& directory, SweepFormat format) {
  makeDirectory(directory);
  constexpr std::array kEndings = {"csv", "json", "h5"};  // by SweepFormat
  std::vector<std::string> paths{fmt::format("{}/sweep.{}", directory, kEndings[static_cast<std::size_t>(format)])};
  if (format == SweepFormat::kHdf5)
    writeSweepHdf5(table, paths[0]);
  else
    writeAtomically(paths[0], format == SweepFormat::kJson ? sweepJson(table) : sweepCsv(table));
  const bool is_plotted = std::find(table.plotted.begin(), table.plotted.end(), true) != table.plotted.end();
  if (!is_plotted || !isDrawable(table)) return paths;
  Gnuplot gnuplot;
  const Figure figure = sweepFigure(table);
  for (const char* ending : {"png", "svg"}) paths.push_back(fmt::format("{}/sweep.{}", directory, ending));
  writeAtomically(paths[1], gnuplot.plot(figure));
  writeAtomically(paths[2], gnuplot.svg(figure));
  return paths;
}

}  // namespace pincer::tasks
