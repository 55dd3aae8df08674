// The table of claims: for a terminal, for machines, as Markdown, for the page.
#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/lab/findings/claim_judge.h"
#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

std::string number(double x) {
  if (!std::isfinite(x)) return "-";
  return std::abs(x) >= 100 ? fmt::format("{:.0f}", x) : fmt::format("{:.3g}", x);
}

std::string plusMinus(double mean, double half) {
  return std::isfinite(half) ? fmt::format("{} ± {}", number(mean), number(half)) : number(mean);
}

bool isJudged(const Claim& c) {
  return c.kind == ClaimKind::kFigure || c.kind == ClaimKind::kOrder || c.kind == ClaimKind::kNull;
}

std::string publishedText(const Claim& c) {
  if (c.kind == ClaimKind::kFigure)
    return std::isnan(c.half_width) ? number(c.mean) + " ± lost" : plusMinus(c.mean, c.half_width);
  return c.kind == ClaimKind::kOrder ? "this order" : c.kind == ClaimKind::kNull ? "no difference" : "-";
}

bool hasEvidence(const Claim& c, const ClaimEvidence& e) { return isJudged(c) && e.studies > 0; }

std::string foundText(const Claim& c, const ClaimEvidence& e) {
  if (!hasEvidence(c, e)) return "";
  if (c.kind == ClaimKind::kFigure) {
    const char* bound = 2 * e.unsettled > e.studies ? "no threshold: " : "";
    return bound + plusMinus(e.mean_a, e.half_a) +
           (c.half_width > 0 ? fmt::format(" (h_sim/h {:.2g})", e.own_half / c.half_width) : "");
  }
  const std::string means = fmt::format("{} and {}", number(e.mean_a), number(e.mean_b));
  const bool ratio = c.margin_kind == MarginKind::kRatio;
  const std::string difference = ratio ? fmt::format("ratio {} [{}, {}]", number(math::exp(e.difference)),
                                                     number(math::exp(e.difference - e.difference_half)),
                                                     number(math::exp(e.difference + e.difference_half)))
                                       : "difference " + plusMinus(e.difference, e.difference_half);
  const std::string effect = std::isfinite(e.effect) ? fmt::format(", d_z {:.2g}", e.effect) : "";
  return fmt::format("{}; {}{}", means, difference, effect);
}

std::string countsText(const Claim& c, const ClaimEvidence& e) {
  if (!hasEvidence(c, e)) return "";
  if (c.kind == ClaimKind::kFigure) return fmt::format("hits {} of {}", e.hits, e.studies);
  if (c.kind == ClaimKind::kNull) return fmt::format("significant {} of {}", e.significant, e.studies);
  const std::string way = fmt::format("that way {} of {}", e.that_way, e.studies);
  return c.test == ClaimTest::kNone ? way
                                    : fmt::format("{}, significant {}{}", way, e.significant_that_way,
                                                  e.paired > 0 ? fmt::format(", paired {}", e.paired) : "");
}

// An order or a figure that rests on touch must be gone.
std::string controlText(const Claim& c, const ClaimEvidence& e) {
  if (!hasEvidence(c, e)) return "";
  return c.kind == ClaimKind::kFigure ? (2 * e.unsettled > e.studies ? "no threshold" : number(e.mean_a))
                                      : countsText(c, e);
}

std::vector<std::string> claimCells(const ClaimRow& row) {
  const Claim& c = *row.claim;
  const std::string unit = *c.unit && *c.unit != '-' ? fmt::format(" [{}]", c.unit) : "";
  const char* mark = c.mark == ClaimMark::kPilot ? " (pilot)" : "";
  return {c.id,
          c.what + unit + mark,
          publishedText(c),
          foundText(c, row.evidence),
          countsText(c, row.evidence),
          controlText(c, row.parked),
          controlText(c, row.unrelated),
          verdictOn(c, row.evidence),
          c.note};
}

std::vector<std::string> claimHeads() {
  return {"claim", "finding", "published", "pincer", "studies", "tactor parked", "model drawn", "verdict", "note"};
}

std::string markdownLine(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string originText(const ClaimTable& table) {
  std::string text = fmt::format("Claims {}", claimsHash());
  if (!table.commit.empty()) text += fmt::format(", studies run at commit {}", table.commit);
  for (const std::string& line : table.participants) text += fmt::format("; people of {}", line);
  return text + ".\n";
}

}  // namespace

std::string claimTableText(const ClaimTable& table) {
  std::string text = "\nPublished findings\n";
  for (const ClaimRow& row : table.rows) {
    const auto cells = claimCells(row);
    text += fmt::format("  {:<5} {:<75} {:<14} {}\n", cells[0], cells[1], cells[2], cells[7]);
    if (cells[3].empty()) continue;
    text += fmt::format("        {}; {}", cells[3], cells[4]);
    if (!cells[5].empty()) text += "; tactor parked: " + cells[5];
    if (!cells[6].empty()) text += "; model drawn: " + cells[6];
    text += "\n";
  }
  return text + originText(table);
}

std::string claimTableCsv(const ClaimTable& table) {
  CsvTable csv{"claim",
               "study",
               "finding",
               "unit",
               "published",
               "published_ci95",
               "studies",
               "hits",
               "that_way",
               "significant",
               "significant_that_way",
               "paired",
               "mean_a",
               "mean_b",
               "difference",
               "difference_ci95",
               "h_sim",
               "d_z",
               "verdict"};
  for (const ClaimRow& row : table.rows) {
    const Claim& c = *row.claim;
    const ClaimEvidence& e = row.evidence;
    csv.row(c.id, c.study, c.what, c.unit, c.mean, c.half_width, e.studies, e.hits, e.that_way, e.significant,
            e.significant_that_way, e.paired, e.mean_a, e.mean_b, e.difference, e.difference_half, e.own_half, e.effect,
            verdictOn(c, e));
  }
  return csv.take();
}

std::string claimTableMarkdown(const ClaimTable& table) {
  std::string text = markdownLine(claimHeads()) + markdownLine(std::vector<std::string>(claimHeads().size(), "---"));
  for (const ClaimRow& row : table.rows) text += markdownLine(claimCells(row));
  return text + "\n" + originText(table);
}

std::string claimTableHtml(const ClaimTable& table) {
  std::string html = "<h2>Published findings</h2>\n<div class=\"wide\"><table>\n" + htmlRow(claimHeads(), "th");
  for (const ClaimRow& row : table.rows) html += htmlRow(claimCells(row), "td");
  return html + fmt::format("</table></div>\n<p class=\"note\">{}</p>\n", escaped(originText(table)));
}

}  // namespace pincer::tasks
