#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/share_page.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/lab/report/report.h"
#include "pincer/tasks/lab/report/study_report.h"

namespace pincer::tasks {
namespace {

constexpr const char* kReportExample = R"(
The table of a session, and a page with plots (needs gnuplot). Sessions that were killed or interrupted get
theirs too.

Examples:
  pincer report out/first/session.db --html first.html
  pincer report out/first/session.db --web)";

struct ReportArguments {
  std::string session, html;
  bool json = false, web = false;
};

// The page that plays the session, beside the report, and what the report says of it.
SessionPage writePageBeside(const SessionReader& session, const std::string& html, std::FILE* say, ReplayPage& link) {
  const std::filesystem::path path(html);
  link.name = path.stem().string() + "_replay.html";
  SessionPage page = writeSessionPage(session, {}, "", (path.parent_path() / link.name).string(), say);
  link.trials = page.trials;
  return page;
}

void reportStudy(const SessionReader& session, const std::string& html, bool as_json, const ReportOptions& options) {
  const StudySummary summary = summariseStudy(session, session.responses());
  print("{}\n", as_json ? studySummaryJson(summary) : formatStudyTable(summary));
  print(as_json ? stderr : stdout, "Report: {}\n", printablePath(writeStudyReport(session, html, options).html));
}

void reportSession(const SessionReader& session, const std::string& html, bool as_json, const ReportOptions& options) {
  const SessionSummary summary = summariseSession(session);
  print("{}\n", as_json ? summaryJson(summary) : formatTable(summary));
  print(as_json ? stderr : stdout, "Report: {}\n", printablePath(writeReport(session, html, options).html));
}

int report(const ReportArguments& arguments) {
  if (arguments.web) requirePageShell();
  SessionReader session(arguments.session);
  session.heed(interruptFlag());
  const std::string beside = (std::filesystem::path(arguments.session).parent_path() / "report.html").string();
  const std::string html = arguments.html.empty() ? beside : arguments.html;
  ReportOptions options{.interrupted = &interruptFlag()};
  bool same = true;
  if (arguments.web) same = writePageBeside(session, html, arguments.json ? stderr : stdout, options.replay).same;
  (isStudy(session.info().task) ? reportStudy : reportSession)(session, html, arguments.json, options);
  return same ? kExitOk : kExitCheckFailed;
}

}  // namespace

void addReportCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "The table and the plots of a session");
  command->add_option("session", arguments->session, "Session file")->required();
  command->add_option("--html", arguments->html, "Where to write the page (default: report.html beside the session)");
  command->add_flag("--json", arguments->json, "Print the table as JSON");
  command->add_flag("--web", arguments->web,
                    "Also a page beside it that plays the session in a browser, linked from the list of trials");
  command->footer(kReportExample);
  command->callback([arguments, &exit_code] { exit_code = report(*arguments); });
}

}  // namespace pincer::tasks
