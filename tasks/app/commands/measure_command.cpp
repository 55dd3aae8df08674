#include "pincer/tasks/app/commands/measure_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <limits>

#include "pincer/contact/error.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/process.h"
#include "pincer/tasks/app/progress.h"
#include "pincer/tasks/app/record_text.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/process/interrupted.h"

namespace pincer::tasks {
namespace {

// In the order of `all`, each once.
std::vector<Measurement> selected(const std::vector<Measurement>& all, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return all;
  for (const std::string& pattern : patterns) {
    if (std::any_of(all.begin(), all.end(), [&](const Measurement& m) { return matches(m.name, pattern); })) continue;
    refuseUsage(fmt::format(
        "--only {}: no measurement has a name like this. --list shows all {} of them; * stands for any text.", pattern,
        all.size()));
  }
  std::vector<Measurement> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), [&](const Measurement& m) {
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const std::string& pattern) { return matches(m.name, pattern); });
  });
  return chosen;
}

void printNames(const std::vector<Measurement>& measurements, bool as_json) {
  if (!as_json) {
    for (const Measurement& m : measurements) print("{}\n", m.name);
    return;
  }
  JsonWriter json;
  json.beginArray();
  for (const Measurement& m : measurements) json.value(m.name);
  print("{}", json.endArray().text());
}

void runOne(const Measurement& measurement, MeasureContext& context, std::vector<Record>& records) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Record> measured;
  try {
    measured = measurement.run(context);
  } catch (const Interrupted&) {       // what was whole before is shown
  } catch (const InputError& error) {  // the other figures are wanted all the same
    measured = {
        unbounded(fmt::format("not measured: {}", error.what()), std::numeric_limits<double>::quiet_NaN(), "-")};
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (Record& record : measured) {
    if (record.name.empty()) record.name = measurement.name;
    record.seconds = seconds;
    records.push_back(std::move(record));
  }
}

}  // namespace

void addMeasureOptions(CLI::App& command, MeasureOptions& options) {
  command.add_flag("--json", options.json, "Print the records as JSON");
  command.add_flag("--list", options.list, "Print the measurements' names and run none");
  command.add_option("--only", options.only, "Only measurements whose name holds one of these; * stands for any text");
}

int runMeasurements(const std::vector<Measurement>& measurements, const MeasureOptions& options,
                    const std::string& title) {
  const std::vector<Measurement> chosen = selected(measurements, options.only);
  if (options.list) {
    printNames(chosen, options.json);
    return kExitOk;
  }
  constexpr std::int64_t kSteps = 1000;  // of the progress line per measurement
  const std::atomic<bool>& flag = interruptFlag();
  std::vector<Record> records;
  std::size_t done = 0;
  {
    const StandardOutputAside aside;  // other engines say what they like; the records come after
    Progress progress(title, kSteps * static_cast<std::int64_t>(chosen.size()));
    MeasureContext context;
    context.thorough = options.thorough;
    context.interrupted = [&] { return flag.load(std::memory_order_relaxed); };
    for (; done < chosen.size() && !context.interrupted(); ++done) {
      const auto before = kSteps * static_cast<std::int64_t>(done);
      context.progress = [&](double share) { progress.update(before + static_cast<std::int64_t>(share * kSteps)); };
      context.progress(0);
      std::vector<Record> measured;
      runOne(chosen[done], context, measured);
      if (context.interrupted()) break;
      records.insert(records.end(), measured.begin(), measured.end());
    }
  }
  print("{}", options.json ? recordJson(records) : recordTable(records));
  if (done < chosen.size()) {
    print(stderr, "pincer: interrupted; these are the figures that were whole.\n");
    return kExitInterrupted;
  }
  return allOk(records) ? kExitOk : kExitCheckFailed;
}

}  // namespace pincer::tasks
