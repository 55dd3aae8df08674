#include <pybind11/stl.h>

#include <variant>

#include "pincer/tasks/lab/sweep/scene_sweep.h"
#include "pincer/tasks/lab/sweep/sweep_store.h"
#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/session/column_meanings.h"
#include "pincer/tasks/run/session/columns.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::python {
namespace {

// A table column by column, in the order of the session's (columns.h).
template <class Record>
class Columns {
 public:
  void add(const Record& record) {
    std::size_t column = 0;
    tasks::forEachColumn(record, [&]<class Field>(const tasks::ColumnName& name, const Field& field) {
      if (rows_ == 0) start<Field>(name);
      if constexpr (std::is_same_v<Field, std::int64_t>)
        put(columns_[column++], field + tasks::countsFrom(name));  // as in exports: people count from 1
      else
        put(columns_[column++], field);
    });
    ++rows_;
  }

  // {name: array}, empty where there are no rows.
  py::dict take() const {
    py::dict table;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      table[names_[i].c_str()] = std::visit([](const auto& c) { return arrayFrom(c); }, columns_[i]);
    return table;
  }

 private:
  using Column = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>>;

  static py::object arrayFrom(const std::vector<std::string>& texts) {
    return py::module_::import("numpy").attr("array")(py::cast(texts), py::str("U"));
  }
  template <class Number>
  static py::object arrayFrom(const std::vector<Number>& numbers) {
    return py::array_t<Number>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  }

  template <class Field>
  void start(const tasks::ColumnName& name) {
    names_.push_back(name.text());
    if constexpr (std::is_floating_point_v<Field>)
      columns_.emplace_back(std::vector<double>());
    else if constexpr (std::is_integral_v<Field> && !std::is_same_v<Field, std::uint64_t>)
      columns_.emplace_back(std::vector<std::int64_t>());
    else
      columns_.emplace_back(std::vector<std::string>());
  }

  template <class Field>
  static void put(Column& column, const Field& field) {
    if constexpr (std::is_floating_point_v<Field>)
      std::get<0>(column).push_back(field);
    else if constexpr (std::is_same_v<Field, std::uint64_t>)
      std::get<2>(column).push_back(std::to_string(field));
    else if constexpr (std::is_integral_v<Field>)
      std::get<1>(column).push_back(field);
    else if constexpr (std::is_same_v<Field, tasks::Bytes>)
      std::get<2>(column).push_back(fmt::format("{} bytes", field.value.size()));
    else
      std::get<2>(column).push_back(field);
  }

  std::size_t rows_ = 0;
  std::vector<std::string> names_;
  std::vector<Column> columns_;
};

template <class Record>
py::dict tableOf(const std::vector<Record>& records) {
  Columns<Record> columns;
  for (const Record& record : records) columns.add(record);
  return columns.take();
}

// As columns.csv has them.
py::dict describedColumns(const tasks::SessionInfo& info) {
  py::list table, column, unit, description, levels;
  for (const tasks::DescribedColumn& c : tasks::allColumns(tasks::conditionLabels(info))) {
    table.append(c.table);
    column.append(c.column);
    unit.append(c.meaning.unit);
    description.append(c.meaning.description);
    levels.append(tasks::levelText(c.meaning));
  }
  py::dict columns;
  columns["table"] = table;
  columns["column"] = column;
  columns["unit"] = unit;
  columns["description"] = description;
  columns["levels"] = levels;
  return columns;
}

py::dict readSession(const std::string& path, std::int64_t stride) {
  if (stride < 1) throw InputError(fmt::format("read_session: stride = {} is out of range [1, inf).", stride));
  const tasks::SessionReader session(path);
  py::dict tables;
  tables["info"] = tableOf(std::vector<tasks::SessionInfo>{session.info()});
  tables["trials"] = tableOf(session.trials());
  tables["responses"] = tableOf(session.responses());
  tables["events"] = tableOf(session.events());
  tables["readings"] = tableOf(session.readings());
  tables["survey"] = tableOf(session.survey());
  Columns<tasks::SampleRecord> samples;
  session.forEachSample({{}, stride}, [&](const tasks::SampleRecord& sample) { samples.add(sample); });
  tables["samples"] = samples.take();
  tables["columns"] = describedColumns(session.info());
  tables["state"] = session.state();
  tables["warning"] = session.warning();
  return tables;
}

// A sweep's table: names, values by row, texts.
py::dict tableOf(const tasks::SweepTable& table) {
  std::vector<std::int64_t> cases;
  std::vector<std::vector<double>> points, values;
  std::vector<std::string> hashes, errors;
  for (std::size_t i = 0; i < table.results.size(); ++i) {
    const tasks::CaseResult& result = table.results[i];
    if (!result.done) continue;
    cases.push_back(static_cast<std::int64_t>(i));
    points.push_back(table.points[i]);
    values.push_back(result.values);
    hashes.push_back(result.state_hash);
    errors.push_back(result.error);
  }
  py::dict out;
  out["what"] = table.what;
  out["parameters"] = table.parameters;
  out["measures"] = table.measures;
  out["case"] = cases;
  out["points"] = points;
  out["values"] = values;
  out["state_hash"] = hashes;
  out["error"] = errors;
  return out;
}

tasks::SweepJob jobOf(const std::string& scene, const std::string& text, const std::vector<std::string>& paths,
                      const std::vector<std::vector<double>>& points, const std::vector<std::string>& measures) {
  const tasks::SceneSweep sweep{{paths, points}, measures};
  if (text.empty()) return tasks::sceneSweep(tasks::parseSceneOrBuiltin(scene), tasks::sceneText(scene), sweep);
  return tasks::sceneSweep({scene, tasks::parseJson(text, scene)}, text, sweep);
}

// Cases of a sweep: all, or those in `only`. `text`: of the scene; empty: that of the file or built-in scene `scene`.
// With `out` every finished case is kept there at once.
py::dict runSweep(const std::string& scene, const std::string& text, const std::vector<std::string>& paths,
                  const std::vector<std::vector<double>>& points, const std::vector<std::string>& measures,
                  const std::vector<std::size_t>& only, int threads, const std::string& out, bool resume) {
  tasks::SweepJob job = jobOf(scene, text, paths, points, measures);
  std::atomic<bool> interrupted{false};
  tasks::SweepOptions options;
  options.threads = threads;
  {
    const py::gil_scoped_release no_gil;
    std::unique_ptr<tasks::SweepStore> store;
    if (!out.empty()) store = std::make_unique<tasks::SweepStore>(out, job, options.shard, resume);
    options.finished = [&](std::size_t point, const tasks::CaseResult& result) {
      if (store) store->add(point, result);
    };
    options.progress = [&](std::int64_t, std::int64_t) {
      if (!interrupted && interruptedByUser()) interrupted = true;
    };
    job.table.results.resize(points.size());
    if (only.empty()) {
      tasks::runSweep(job, options, interrupted);
      if (store && !interrupted) store->finish(job.table);
    } else {
      for (const std::size_t point : only) job.table.results.at(point) = tasks::measuredCase(job, point, interrupted);
    }
  }
  if (interrupted) throw py::error_already_set();
  return tableOf(job.table);
}

void writeSweep(const std::string& out, const std::string& scene, const std::string& text,
                const std::vector<std::string>& paths, const std::vector<std::vector<double>>& points,
                const std::vector<std::string>& measures,
                const std::vector<std::tuple<std::size_t, std::vector<double>, std::string, std::string>>& rows) {
  tasks::SweepJob job = jobOf(scene, text, paths, points, measures);
  job.table.results.resize(points.size());
  for (const auto& [point, values, hash, error] : rows) job.table.results.at(point) = {true, values, hash, error};
  tasks::SweepStore(out, job, {}, false).finish(job.table);
}

}  // namespace

void bindTables(py::module_& module) {
  module.def("read_session", &readSession, py::arg("path"), py::arg("stride"));
  module.def(
      "read_sweep", [](const std::string& directory) { return tableOf(tasks::readSweep(directory).table); },
      py::arg("directory"));
  module.def(
      "values_of", [](const std::string& vary) { return tasks::parseVariation("x=" + vary).values; }, py::arg("vary"));
  module.def("run_sweep", &runSweep, py::arg("scene"), py::arg("text"), py::arg("paths"), py::arg("points"),
             py::arg("measures"), py::arg("only"), py::arg("threads"), py::arg("out"), py::arg("resume"));
  module.def("sweep_table",
             [](const std::string& scene, const std::string& text, const std::vector<std::string>& paths,
                const std::vector<std::vector<double>>& points, const std::vector<std::string>& measures) {
               return tableOf(jobOf(scene, text, paths, points, measures).table);
             });
  module.def("write_sweep", &writeSweep, py::arg("out"), py::arg("scene"), py::arg("text"), py::arg("paths"),
             py::arg("points"), py::arg("measures"), py::arg("rows"));
}

}  // namespace pincer::python
