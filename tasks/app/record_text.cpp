#include "pincer/tasks/app/record_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/tasks/app/terminal.h"
#include "pincer/tasks/run/files/json_writer.h"

namespace pincer::tasks {
namespace {

// Whole numbers as they are, others with four digits.
std::string numberText(double x) {
  if (x == std::round(x) && std::abs(x) < 1e9) return fmt::format("{:.0f}", x);
  return fmt::format("{:.4g}", x);
}

std::string boundText(const Record& r) {
  if (std::isinf(r.bound) && r.relation == "<=") return "";
  return fmt::format("{} {}", r.relation, numberText(r.bound));
}

constexpr std::size_t kColumns = 5;  // name, metric, value, unit, bound
using Row = std::array<std::string, kColumns>;

Row rowOf(const Record& r) { return {r.name, r.metric, numberText(r.value), r.unit, boundText(r)}; }

// Columns of code points, not bytes: units may hold a degree sign.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
  const std::string space(width - widthOf(text), ' ');
  return to_the_right ? space + text : text + space;
}

std::string line(const Row& row, const std::array<std::size_t, kColumns>& widths) {
  std::string out;
  for (std::size_t i = 0; i < kColumns; ++i) out += padded(row[i], widths[i], i == 2) + (i == 2 ? " " : "  ");
  return out;
}

}  // namespace

std::string recordTable(const std::vector<Record>& records) {
  std::vector<Row> rows = {{"what", "figure", "value", "unit", "bound"}};
  for (const Record& r : records) rows.push_back(rowOf(r));
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], widthOf(row[i]));
  }
  std::string out = line(rows.front(), widths) + "\n";
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (i > 0 && records[i].name == records[i - 1].name) rows[i + 1][0].clear();  // a name once, above its figures
  }
  for (std::size_t i = 0; i < records.size(); ++i)
    out += line(rows[i + 1], widths) + (records[i].ok ? good("ok") : bad("FAIL")) + "\n";
  return out;
}

std::string recordJson(const std::vector<Record>& records) {
  JsonWriter json;
  json.beginArray();
  for (const Record& r : records) {
    json.beginObject()
        .key("name")
        .value(r.name)
        .key("metric")
        .value(r.metric)
        .key("value")
        .value(r.value)
        .key("unit")
        .value(r.unit);
    json.key("relation")
        .value(r.relation)
        .key("bound")
        .value(r.bound)
        .key("ok")
        .value(r.ok)
        .key("seconds")
        .value(r.seconds)
        .endObject();
  }
  return json.endArray().text();
}

}  // namespace pincer::tasks
