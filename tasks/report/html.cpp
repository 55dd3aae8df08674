#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tasks/report/report.h"

namespace pincer::tasks {

namespace {

constexpr const char* kStyle = R"(
body { margin: 2rem auto; max-width: 60rem; padding: 0 1rem; }
body { background: #fff; color: #222; font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.5rem; }
table { border-collapse: collapse; font-size: 0.8rem; font-variant-numeric: tabular-nums; }
td, th { padding: 0.25rem 0.55rem; text-align: right; border-bottom: 1px solid #e2e2e2; white-space: nowrap; }
td:first-child, th:first-child { text-align: left; }
tr.all td { font-weight: bold; border-bottom: 2px solid #999; }
tr:target td { background: #fff3cd; }
.facts th { text-align: left; font-weight: normal; color: #666; }
.facts td { text-align: left; white-space: normal; overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
figure { margin: 1rem 0; } img { width: 100%; height: auto; } figcaption, .note { font-size: 0.85rem; color: #444; }
.warning { border-left: 0.4rem solid #D55E00; background: #fdf1e9; padding: 0.6rem 1rem; }
pre { background: #f6f6f6; padding: 0.6rem; overflow-x: auto; font-size: 0.8rem; }
a { color: #0072B2; }
)";

std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

// RFC 4648, section 4.
std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string row(const std::vector<std::string>& fields, const char* tag, const std::string& attributes = "") {
  std::string html = fmt::format("<tr{}>", attributes);
  for (const std::string& field : fields) html += fmt::format("<{0}>{1}</{0}>", tag, escaped(field));
  return html + "</tr>\n";
}

std::string facts(const SessionSummary& s) {
  const std::vector<std::pair<const char*, std::string>> rows{{"task", s.info.task},
                                                              {"seed", std::to_string(s.info.seed)},
                                                              {"started (UTC)", s.started_utc},
                                                              {"state of the session", s.state},
                                                              {"participants", std::to_string(s.participants)},
                                                              {"finished trials", std::to_string(s.trials)},
                                                              {"pincer", s.info.version},
                                                              {"build", s.info.build},
                                                              {"session file", s.path}};
  std::string html = "<table class=\"facts\">\n";
  for (const auto& [name, value] : rows) html += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", name, escaped(value));
  return html + "</table>\n";
}

std::string cellTable(const SessionSummary& s) {
  if (s.cells.empty()) return "<p>No trial was finished.</p>\n";
  std::string html = "<div class=\"wide\"><table>\n" + row(tableHeads(), "th");
  for (const CellSummary& cell : s.cells) html += row(tableRow(cell), "td", cell.allFrictions() ? " class=\"all\"" : "");
  return fmt::format("{}</table></div>\n<p class=\"note\">{}</p>\n", html, escaped(tableNote(s)));
}

std::string figureHtml(const Picture& p, const std::string& figures_name) {
  std::string links = fmt::format("<a href=\"{0}/{1}.png\">picture</a>", escaped(figures_name), p.figure.name);
  for (const auto& [name, content] : p.figure.data) links += fmt::format(", <a href=\"{}/{}\">{}</a>", escaped(figures_name), name, name);
  if (!p.anchor_trial.empty()) links += fmt::format("; <a href=\"#trial-{0}\">trial {0} in the list</a>", p.anchor_trial);
  return fmt::format(
      "<h2>{}</h2>\n<figure id=\"figure-{}\">\n<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">\n"
      "<figcaption>{} <span class=\"note\">({})</span></figcaption>\n</figure>\n",
      escaped(p.figure.title), p.figure.name, escaped(p.figure.title), p.figure.width / 2, p.figure.height / 2, base64(p.png),
      escaped(p.figure.caption), links);
}

std::string number(double value, double scale, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", scale * value, digits) : "–";
}

std::string trialList(const std::vector<TrialRecord>& trials) {
  std::string html = "<h2>All trials</h2>\n<div class=\"wide\"><table>\n" +
                     row({"trial", "participant", "condition", "µₛ", "outcome", "squeezes", "lifts", "tries > 5 mm", "time [s]", "slips",
                          "drops", "peak grip [N]", "grip ratio [-]", "offset [mm]"},
                         "th");
  for (const TrialRecord& t : trials) {
    const auto text = [](std::int64_t n) { return std::to_string(n); };
    html += row({text(t.trial), text(t.participant), conditionLabel(t.condition), number(t.mu_s, 1, 2), t.outcome, text(t.squeezes),
                 text(t.lifts), text(t.tries_5mm), number(t.duration, 1, 2), text(t.slips), text(t.drops), number(t.peak_grip, 1, 2),
                 number(t.grip_ratio, 1, 2), number(t.offset_at_squeeze, 1e3, 1)},
                "td", fmt::format(" id=\"trial-{}\"", t.trial));
  }
  return html +
         "</table></div>\n<p class=\"note\">Grip ratio: grip while held over the smallest that holds, m g / (2 µₛ). Offset: of the "
         "contacts from "
         "the antipodal line at the last squeeze.</p>\n";
}

std::string details(const char* title, const std::string& json) {
  return json.empty() ? "" : fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", title, escaped(json));
}

}  // namespace

std::string reportHtml(const SessionSummary& s, const std::vector<TrialRecord>& trials, const std::vector<Picture>& pictures,
                       const std::string& figures_name) {
  const std::string title = fmt::format("{}, seed {}", s.info.task, s.info.seed);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
      escaped(title), kStyle);
  if (!s.warning.empty()) html += fmt::format("<p class=\"warning\">{}</p>\n", escaped(s.warning));
  html += facts(s) + "<h2>Per condition and friction</h2>\n" + cellTable(s);
  for (const Picture& picture : pictures) html += figureHtml(picture, figures_name);
  if (!trials.empty()) html += trialList(trials);
  html += "<h2>What was run</h2>\n" + details("scene", s.info.scene_json) + details("protocol", s.info.protocol_json) +
          details("devices", s.info.devices_json);
  return html + "</body>\n</html>\n";
}

}  // namespace pincer::tasks
