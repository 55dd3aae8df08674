// campaign: does to pincer what users, disks, kernels and other programs' files do at
// their worst, and counts what came of it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/row.h"
#include "pincer/tests/campaign/verdicts.h"

namespace pincer::campaign {
namespace {

struct Asked {
  std::vector<std::string> only;
  int one_case = -1, from = 0;
  double minutes = 1e6;  // of a row, at most
  bool json = false;
};

constexpr std::size_t kShown = 5;  // faults per row; the others are in faults.txt

int casesOf(const Row& row, const Ground& ground) {
  const int wanted = std::max(1, static_cast<int>(row.usual * ground.times + 0.5));
  return row.all == nullptr ? wanted : std::min(wanted, std::max(1, row.all(ground)));
}

std::string repeatCommand(const Ground& ground, const Fault& fault) {
  return fmt::format("tests/campaign/run --only {} --case {} --seed {}", fault.row, fault.number, ground.seed);
}

// A message of the program may hold anything: it is shown without what a terminal would obey.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text.substr(0, 400);
}

void tell(const Ground& ground, const Fault& fault) {
  fmt::print(stderr, "  {} {}: {}\n    {}\n    again: {}\n", fault.row,
             kVerdictNames[static_cast<std::size_t>(fault.verdict)], printable(fault.why), printable(fault.command),
             repeatCommand(ground, fault));
}

void keep(const Ground& ground, const Fault& fault) {
  std::ofstream(ground.out / "faults.txt", std::ios::app) << fmt::format(
      "{}\t{}\t{}\t{}\t{}\n", fault.row, fault.number, kVerdictNames[static_cast<std::size_t>(fault.verdict)],
      printable(fault.why), printable(fault.command));
}

void runCase(const Row& row, const Ground& ground, int number, Tally& tally) {
  Case c(ground, row.name, number, tally);
  try {
    row.act(c);
  } catch (const std::exception& e) {
    c.fault(Verdict::kWrong, fmt::format("the campaign itself failed: {}", e.what()));
  }
}

Tally runRow(const Row& row, const Ground& ground, const Asked& asked) {
  Tally tally;
  std::size_t told = 0;
  const int first = asked.one_case < 0 ? asked.from : asked.one_case;
  const int end = asked.one_case < 0 ? casesOf(row, ground) : asked.one_case + 1;
  const auto begin = std::chrono::steady_clock::now();
  for (int n = first; n < end; ++n) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::duration<double>(60 * asked.minutes)) {
      tally.skipped = fmt::format("time is over before case {} of {}", n, end);
      break;
    }
    runCase(row, ground, n, tally);
    ++tally.cases;
    for (; told < tally.faults.size(); ++told) {
      keep(ground, tally.faults[told]);
      if (told < kShown) tell(ground, tally.faults[told]);
    }
  }
  if (tally.faults.size() > kShown)
    fmt::print(stderr, "  ... and {} more: {}\n", tally.faults.size() - kShown, (ground.out / "faults.txt").string());
  return tally;
}

std::string line(const Row& row, const Tally& t) {
  const auto of = [&](Verdict v) { return t.counts[static_cast<std::size_t>(v)]; };
  return fmt::format("{:<20} {:>8} {:>8} {:>8} {:>7} {:>7} {:>5} {:>5} {:>5} {:>7.1f}  {}", row.name, t.runs,
                     of(Verdict::kFine), of(Verdict::kRefused), of(Verdict::kStopped), of(Verdict::kCrashed),
                     of(Verdict::kHung), of(Verdict::kLost), of(Verdict::kWrong), t.seconds,
                     t.faults.empty() ? "ok" : "FAIL");
}

const std::string kHead = fmt::format("{:<20} {:>8} {:>8} {:>8} {:>7} {:>7} {:>5} {:>5} {:>5} {:>7}", "row", "runs",
                                      "fine", "refused", "stopped", "crashed", "hung", "lost", "wrong", "s");

std::string record(const Row& row, const Tally& t) {
  std::string counts;
  for (std::size_t i = 0; i < t.counts.size(); ++i)
    counts += fmt::format(", \"{}\": {}", kVerdictNames[i], t.counts[i]);
  return fmt::format(
      "  {{\"name\": \"{}\", \"what\": \"{}\", \"cases\": {}, \"runs\": {}{}, \"seconds\": {:.1f}, \"ok\": {}}}",
      row.name, row.what, t.cases, t.runs, counts, t.seconds, t.faults.empty());
}

int runRows(Ground ground, const Asked& asked) {
  std::vector<std::pair<const Row*, Tally>> done;
  fmt::print(stderr, "{}\n", kHead);
  for (const Row& row : rows()) {
    if (!asked.only.empty() && std::find(asked.only.begin(), asked.only.end(), row.name) == asked.only.end()) continue;
    done.emplace_back(&row, runRow(row, ground, asked));
    fmt::print(stderr, "{}\n", line(row, done.back().second));
  }
  std::string table;
  Row sum{"all", "", 0, nullptr};
  Tally total;
  for (const auto& [row, tally] : done) {
    table += asked.json ? fmt::format("{}{}", table.empty() ? "" : ",\n", record(*row, tally))
                        : fmt::format("{}  {}\n", line(*row, tally), row->what);
    if (!asked.json) table += fmt::format("{:<20} {} cases\n", "", tally.cases);
    if (!asked.json && tally.hits > 0) table += fmt::format("{:<20} it hit {} times\n", "", tally.hits);
    if (!asked.json && !tally.skipped.empty()) table += fmt::format("{:<20} {}\n", "", tally.skipped);
    for (std::size_t i = 0; i < total.counts.size(); ++i) total.counts[i] += tally.counts[i];
    total.runs += tally.runs, total.seconds += tally.seconds;
    total.faults.insert(total.faults.end(), tally.faults.begin(), tally.faults.end());
  }
  fmt::print("{}", asked.json ? "[\n" + table + "\n]\n" : kHead + "\n" + table + line(sum, total) + "\n");
  return total.faults.empty() ? 0 : 1;
}

bool devicesAreAttached(const Ground& ground) {
  Launch launch;
  launch.program = ground.pincer;
  launch.arguments = {"devices", "list"};
  launch.folder = ground.inputs();
  launch.log = ground.inputs() / "log";
  return run(launch).out.find("\n") != std::string::npos;
}

void requireKnown(const std::vector<std::string>& only) {
  for (const std::string& name : only) {
    const auto is_it = [&](const Row& row) { return row.name == name; };
    if (std::none_of(rows().begin(), rows().end(), is_it))
      throw CLI::ValidationError("--only", "there is no row " + name + "; see --list");
  }
}

}  // namespace
}  // namespace pincer::campaign

int main(int argc, char** argv) {
  using namespace pincer::campaign;
  CLI::App app(
      "Does to pincer what users, disks and other programs' files do at their worst, and counts what came of it.",
      "tests/campaign/run");
  Ground ground;
  Asked asked;
  bool list = false;
  ground.build = PINCER_BINARY_DIR;
  ground.source = PINCER_SOURCE_DIR;
  ground.pincer = ground.build / "pincer";
  ground.out = ground.build / "campaign-out";
  app.add_option("--times", ground.times, "So many times the usual number of cases")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  app.add_option("--only", asked.only, "Only these rows");
  app.add_option("--case", asked.one_case, "Only this case of the rows")->check(CLI::NonNegativeNumber);
  app.add_option("--from", asked.from, "From this case of the rows on")->check(CLI::NonNegativeNumber);
  app.add_option("--minutes", asked.minutes, "Of each row, at most")->check(CLI::Range(0.01, 1e6));
  app.add_option("--seed", ground.seed, "Of all that is drawn")->capture_default_str();
  app.add_option("--pincer", ground.pincer, "The program")->check(CLI::ExistingFile);
  app.add_option("--out", ground.out, "Where cases work, and where those that failed stay");
  app.add_flag("--json", asked.json, "The table as JSON");
  app.add_flag("--list", list, "Only the rows' names and what they do");
  app.footer(
      "\nExit code 1 if a row fails. What failed stays in --out, with the command that repeats it.\n\nExamples:\n  "
      "tests/campaign/run\n"
      "  tests/campaign/run --only scenes kills --times 10\n"
      "  tests/campaign/run --only every-failure --times 100 --from 800 --minutes 60\n");
  try {
    app.parse(argc, argv);
    requireKnown(asked.only);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (list) {
    for (const Row& row : rows()) fmt::print("{:<20} {}\n", row.name, row.what);
    return 0;
  }
  std::signal(SIGPIPE, SIG_IGN);
  fs::remove(ground.out / "faults.txt");
  ground.out = fs::absolute(ground.out);
  ground.pincer = fs::absolute(ground.pincer);
  try {
    makeInputs(ground);
    ground.has_devices = devicesAreAttached(ground);
    return runRows(ground, asked);
  } catch (const std::exception& error) {
    fmt::print(stderr, "campaign: {}\n", error.what());
    return 1;
  }
}
