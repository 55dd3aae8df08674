#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/lab/report/report.h"
#include "pincer/tasks/lab/report/study_report.h"

namespace pincer::tasks {
namespace {

constexpr const char* kReportExample = R"(
The table of a session, and a page with plots (needs gnuplot). Sessions that were killed or interrupted get theirs too.

Example:
  pincer report out/first/session.db --html first.html)";

struct ReportArguments {
  std::string session, html;
  bool json = false;
};

int reportStudy(const SessionReader& session, const std::string& html, bool as_json) {
  const StudySummary summary = summariseStudy(session, session.responses());
  print("{}\n", as_json ? studySummaryJson(summary) : formatStudyTable(summary));
  print(as_json ? stderr : stdout, "Report: {}\n", printablePath(writeStudyReport(session, html, {.interrupted = &interruptFlag()}).html));
  return kExitOk;
}

int report(const ReportArguments& arguments) {
  SessionReader session(arguments.session);
  session.heed(interruptFlag());
  const std::string beside = (std::filesystem::path(arguments.session).parent_path() / "report.html").string();
  const std::string html = arguments.html.empty() ? beside : arguments.html;
  if (isStudy(session.info().task)) return reportStudy(session, html, arguments.json);
  const SessionSummary summary = summariseSession(session);
  print("{}\n", arguments.json ? summaryJson(summary) : formatTable(summary));
  const ReportFiles files = writeReport(session, html, {.interrupted = &interruptFlag()});
  print(arguments.json ? stderr : stdout, "Report: {}\n", printablePath(files.html));
  return kExitOk;
}

}  // namespace

void addReportCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "The table and the plots of a session");
  command->add_option("session", arguments->session, "Session file")->required();
  command->add_option("--html", arguments->html, "Where to write the page (default: report.html beside the session)");
  command->add_flag("--json", arguments->json, "Print the table as JSON");
  command->footer(kReportExample);
  command->callback([arguments, &exit_code] { exit_code = report(*arguments); });
}

}  // namespace pincer::tasks
