#include "pincer/tasks/lab/report/html_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pincer::tasks {

namespace {

// One question, of one task and condition if it was asked of each.
struct AskedItem {
  std::vector<const SurveyRecord*> answers;
};

std::ptrdiff_t answeredBy(const AskedItem& item) {
  return std::count_if(item.answers.begin(), item.answers.end(),
                       [](const SurveyRecord* a) { return !a->answer.empty(); });
}

std::string meanWords(const AskedItem& item) {
  double sum = 0, low = 0, high = 0;
  int count = 0;
  for (const SurveyRecord* answer : item.answers) {
    const double value = answer->answer_value;
    if (!std::isfinite(value)) continue;
    low = count == 0 ? value : std::min(low, value);
    high = count == 0 ? value : std::max(high, value);
    sum += value;
    ++count;
  }
  return count == 0 ? "–" : fmt::format("{:.2g} ({:g} to {:g})", sum / count, low, high);
}

// "3: 2 people; 5" and so on, in the order in which they were first given.
std::string answerList(const AskedItem& item) {
  std::vector<std::pair<std::string, int>> given;
  for (const SurveyRecord* answer : item.answers) {
    if (answer->answer.empty()) continue;
    const auto same = [&](const auto& other) { return other.first == answer->answer; };
    const auto known = std::find_if(given.begin(), given.end(), same);
    ++(known == given.end() ? given.emplace_back(answer->answer, 0) : *known).second;
  }
  std::string words;
  for (const auto& [text, count] : given) {
    words += (words.empty() ? "" : "; ") + text + (count > 1 ? fmt::format(" ({} people)", count) : "");
  }
  return words;
}

// The page's style sheet, in it as it is: a report is one file.
constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: #fff; --ink: #222; --dim: #555; --line: #e2e2e2; --mark: #0072B2; --tint: #eef5fa;
  --warn: #D55E00; --warn-tint: #fdf1e9; --code: #f6f6f6; --target: #fff3cd; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181c; --ink: #e6e6e6; --dim: #a8acb3; --line: #343a42; --mark: #56B4E9;
  --tint: #1b2733; --warn: #E69F00; --warn-tint: #332a17; --code: #20242a; --target: #4a421d; } }
body { margin: 2rem auto; max-width: 64rem; padding: 0 1rem; }
body { background: var(--paper); color: var(--ink); font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.5rem; }
table { border-collapse: separate; border-spacing: 0; font-size: 0.8rem; font-variant-numeric: tabular-nums; }
td, th { padding: 0.25rem 0.45rem; text-align: right; vertical-align: top; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { white-space: normal; vertical-align: bottom; } td small { color: var(--dim); }
td:first-child, th:first-child { text-align: left; position: sticky; left: 0; background: var(--paper); }
tr.all td { font-weight: bold; border-bottom: 2px solid var(--dim); } tr.all small { font-weight: normal; }
tr:target td { background: var(--target); }
.facts th { text-align: left; font-weight: normal; color: var(--dim); }
.facts td { text-align: left; white-space: normal; overflow-wrap: anywhere; }
.asked td { text-align: left; white-space: normal; } .asked th { text-align: left; }
.wide { overflow-x: auto; border-right: 1px dashed var(--line); max-width: 100%; }
.finding { font-size: 1.1rem; border-left: 0.4rem solid var(--mark); background: var(--tint); padding: 0.6rem 1rem; }
figure { margin: 1rem 0; } .picture { overflow-x: auto; } img { width: 100%; height: auto; border-radius: 4px; background: #fff; }
figcaption, .note { font-size: 0.85rem; color: var(--dim); }
.warning { border-left: 0.4rem solid var(--warn); background: var(--warn-tint); padding: 0.6rem 1rem; }
pre { background: var(--code); padding: 0.6rem; overflow-x: auto; font-size: 0.8rem; }
a { color: var(--mark); }
@media (max-width: 40rem) { body { font-size: 15px; margin: 1rem auto; } h1 { font-size: 1.3rem; } td:first-child { white-space: normal; }
  .picture img { width: 46rem; max-width: none; } }
@media print { @page { size: A4; margin: 15mm; } html { font-size: 11pt; } body { max-width: none; margin: 0; padding: 0; font-size: 10pt; }
  figure, tr, .finding { break-inside: avoid; } h2 { break-after: avoid; } .wide, .picture { overflow: visible; border: none; }
  table { font-size: 7.5pt; } td, th { padding: 0.15rem 0.2rem; white-space: normal; } td small { white-space: nowrap; }
  table.long { font-size: 6pt; } td:first-child, th:first-child { position: static; } details { display: none; } }
)";

// RFC 4648, section 4.
std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";  // by 6 bits
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

// Apart from tabs and line ends, which pages may hold.
bool isControl(char c) { return (c >= 0 && c < ' ' && c != '\t' && c != '\n' && c != '\r') || c == 0x7f; }

}  // namespace

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
        html += isControl(c) ? ' ' : c;
    }
  }
  return html;
}

std::string htmlRow(const std::vector<std::string>& fields, const char* tag, const std::string& attributes) {
  std::string html = fmt::format("<tr{}>", attributes);
  for (const std::string& field : fields) html += fmt::format("<{0}>{1}</{0}>", tag, escaped(field));
  return html + "</tr>\n";
}

std::string htmlRowOfIntervals(const std::vector<std::string>& fields, const std::string& attributes) {
  std::string html = fmt::format("<tr{}>", attributes);
  for (const std::string& field : fields) {
    const std::size_t bracket = field.rfind(" (");
    if (bracket == std::string::npos || field.find(" to ", bracket) == std::string::npos) {
      html += fmt::format("<td>{}</td>", escaped(field));
    } else {
      html += fmt::format("<td>{}<br><small>{}</small></td>", escaped(field.substr(0, bracket)),
                          escaped(field.substr(bracket + 1)));
    }
  }
  return html + "</tr>\n";
}

std::string htmlFacts(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::string html = "<table class=\"facts\">\n";
  for (const auto& [name, value] : rows)
    html += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(name), escaped(value));
  return html + "</table>\n";
}

std::string htmlFigure(const Picture& p, const std::string& figures_name) {
  std::string links = fmt::format("<a href=\"{0}/{1}.png\">PNG</a>, <a href=\"{0}/{1}.svg\">SVG</a>",
                                  escaped(figures_name), p.figure.name);
  for (const auto& [name, content] : p.figure.data)
    links += fmt::format(", <a href=\"{}/{}\">{}</a>", escaped(figures_name), name, name);
  if (!p.anchor_trial.empty())
    links += fmt::format("; <a href=\"#trial-{0}\">trial {0} in the list</a>", p.anchor_trial);
  return fmt::format(
      "<h2>{}</h2>\n<figure id=\"figure-{}\">\n<div class=\"picture\"><img alt=\"{}\" width=\"{}\" height=\"{}\" "
      "src=\"data:image/png;base64,{}\"></div>\n"
      "<figcaption>{} <span class=\"note\">({})</span></figcaption>\n</figure>\n",
      escaped(p.figure.title), p.figure.name, escaped(p.figure.title), p.figure.width / 2, p.figure.height / 2,
      base64(p.png), escaped(p.figure.caption), links);
}

std::string buildFacts(const SessionInfo& info) {
  std::string facts = info.build;
  for (const std::string* more : {&info.flags, &info.c_library, &info.processor, &info.commit}) {
    if (!more->empty()) facts += (more == &info.commit ? "; commit " : "; ") + *more;
  }
  return facts;
}

std::string htmlNotDrawn(const std::vector<std::string>& titles) {
  if (titles.empty()) return "";
  return fmt::format("<p class=\"note\">Not drawn, since no finished trial has numbers for it: {}.</p>\n",
                     escaped(fmt::format("{}", fmt::join(titles, "; "))));
}

std::string htmlDetails(const char* title, const std::string& json) {
  return json.empty() ? ""
                      : fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", title, escaped(json));
}

std::string htmlSurvey(const std::vector<SurveyRecord>& answers) {
  if (answers.empty()) return "";
  std::vector<AskedItem> items;
  for (const SurveyRecord& answer : answers) {
    const auto same = [&](const AskedItem& item) {
      const SurveyRecord& other = *item.answers.front();
      return other.moment == answer.moment && other.item == answer.item && other.task == answer.task &&
             other.condition == answer.condition;
    };
    const auto known = std::find_if(items.begin(), items.end(), same);
    (known == items.end() ? items.emplace_back() : *known).answers.push_back(&answer);
  }
  std::string html = "<h2>Asked beside the trials</h2>\n<div class=\"wide\"><table class=\"asked\">\n" +
                     htmlRow({"question", "task", "condition", "answered", "mean (least to most)", "answers"}, "th");
  for (const AskedItem& item : items) {
    const SurveyRecord& first = *item.answers.front();
    html += htmlRowOfIntervals({first.question, first.task, first.condition, std::to_string(answeredBy(item)),
                                meanWords(item), answerList(item)});
  }
  return html +
         "</table></div>\n<p class=\"note\">People's own words and ratings, as they gave them; no test is made of "
         "them.</p>\n";
}

std::string htmlReplay(const ReplayPage& replay) {
  if (replay.name.empty()) return "";
  return fmt::format(
      "<p><a href=\"{}\">Play the session</a> in three dimensions; the page needs this file beside it, and nothing "
      "else.</p>\n",
      escaped(replay.name));
}

std::string htmlHead(const std::string& title, const std::string& warning) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
      escaped(title), kStyle);
  if (!warning.empty()) html += fmt::format("<p class=\"warning\">{}</p>\n", escaped(warning));
  return html;
}

std::string htmlFoot(const SessionInfo& info, const std::string& facts) {
  return "<h2>What was run</h2>\n" + facts + htmlDetails("scene", info.scene_json) +
         htmlDetails("protocol", info.protocol_json) + htmlDetails("devices", info.devices_json) +
         htmlDetails("participants", info.participants_json) + "</body>\n</html>\n";
}

}  // namespace pincer::tasks
