#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/session/bids_export.h"
#include "pincer/tasks/run/session/csv_export.h"

namespace pincer::tasks {
namespace {

constexpr const char* kExportExample = R"(
Writes session.csv, trial.csv, sample.csv, event.csv, response.csv and reading.csv, with units in the column
names, and columns.csv, which says what each column means; of people also hands.csv and input.csv, every tick
of their hands.

Example:
  pincer export out/first/session.db --trial 3 --every 10 --out trial3)";

struct ExportArguments {
  std::string session, directory, bids;
  std::optional<std::int64_t> trial;  // from 1
  SampleFilter filter;
};

int exportSession(const ExportArguments& arguments) {
  SessionReader session(arguments.session);
  session.heed(interruptFlag());
  if (!arguments.bids.empty()) {
    for (const std::string& file : exportBids(session, arguments.bids)) print("{}\n", printablePath(file));
    return kExitOk;
  }
  const std::string beside = (std::filesystem::path(arguments.session).parent_path() / "csv").string();
  for (const std::string& file :
       exportCsv(session, arguments.directory.empty() ? beside : arguments.directory, arguments.filter)) {
    print("{}\n", printablePath(file));
  }
  if (!session.warning().empty()) print(stderr, "pincer: {}\n", session.warning());
  return kExitOk;
}

}  // namespace

void addExportCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "A session as CSV tables");
  command->add_option("session", arguments->session, "Session file")->required();
  command->add_option("--out", arguments->directory, "Directory for the tables (default: csv beside the session)");
  command->add_option("--bids", arguments->bids,
                      "The trials as a BIDS data set in this directory, in place of CSV tables");
  command->add_option("--trial", arguments->trial, "Samples of this trial only, from 1")
      ->check(wholeWithin(1, 1'000'000'000));
  command->add_option("--every", arguments->filter.stride, "Every n-th sample only")
      ->check(wholeWithin(1, 1'000'000'000))
      ->capture_default_str();
  command->footer(kExportExample);
  command->callback([arguments, &exit_code] {
    if (arguments->trial) arguments->filter.trial = *arguments->trial - 1;
    exit_code = exportSession(*arguments);
  });
}

}  // namespace pincer::tasks
