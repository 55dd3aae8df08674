#include <pybind11/stl.h>

#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/inputs.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"
#include "pincer/tasks/run/scene/step_status_text.h"

namespace pincer::python {
namespace {

// The class of status flags: an enum.IntFlag with a member per bit.
py::object statusClass() {
  py::dict members;
  members["OK"] = 0;
  for (const tasks::StatusKind& kind : tasks::kStatusKinds) {
    std::string name(kind.key);
    for (char& c : name) c = c == '_' ? '_' : static_cast<char>(c - 'a' + 'A');
    members[name.c_str()] = kind.bit;
  }
  py::object flags = py::module_::import("enum").attr("IntFlag")("Status", members, py::arg("module") = "pincer");
  flags.attr("__doc__") =
      "What happened in a step that a caller may have to know; pincer.remedies(status) says what to change.";
  return flags;
}

std::vector<std::string> remediesOf(std::uint32_t status) {
  std::vector<std::string> remedies;
  for (const tasks::StatusKind& kind : tasks::kStatusKinds) {
    if (status & kind.bit) remedies.emplace_back(kind.sentence);
  }
  return remedies;
}

// The value that step returns: CPython's own named tuple, which takes a fraction of the time
// that an object of pybind11's takes to make.
PyStructSequence_Field kReportFields[] = {{"status", "Flags of all its ticks together (Status)."},
                                          {"ok", "No flag is up."},
                                          {"remedies", "A sentence per flag: what happened, and what to change."},
                                          {"ticks", "That were done; fewer than asked for where the state broke."},
                                          {"contacts", "In the last tick."},
                                          {"parts", "That the last tick was cut into."},
                                          {"asleep", "The last tick only repeated the one before."},
                                          {nullptr, nullptr}};
PyStructSequence_Desc kReportDescription = {"pincer.StepReport", "What one call of step came to.", kReportFields, 7};
PyTypeObject* report_type = nullptr;  // made with the module, which lives as long as the program
PyObject* status_ok = nullptr;

py::object statusOf(std::uint32_t status) {
  if (status == engine::kStepOk) return py::reinterpret_borrow<py::object>(status_ok);
  return py::module_::import("pincer._core").attr("Status")(status);
}

py::object reportOf(const tasks::StepsReport& report) {
  const bool ok = report.status == engine::kStepOk;
  auto tuple = py::reinterpret_steal<py::object>(PyStructSequence_New(report_type));
  if (!tuple) throw py::error_already_set();
  const auto set = [&](Py_ssize_t field, py::object value) {
    PyStructSequence_SetItem(tuple.ptr(), field, value.release().ptr());
  };
  set(0, statusOf(report.status));
  set(1, py::bool_(ok));
  set(2, ok ? py::tuple() : py::tuple(py::cast(remediesOf(report.status))));
  set(3, py::int_(report.ticks));
  set(4, py::int_(report.contacts));
  set(5, py::int_(report.parts));
  set(6, py::bool_(report.asleep));
  return tuple;
}

py::object step(const Model& model, State& state, std::int64_t nstep, const Inputs* inputs) {
  if (&state.model() != &model)
    throw InputError("step: the state is one of another model. Make it with pincer.State(model).");
  if (inputs && inputs->model.get() != &model)
    throw InputError("step: the inputs are those of another model. Make them with pincer.Inputs(model).");
  if (nstep < 1) throw InputError(fmt::format("step: nstep = {} is out of range [1, inf).", nstep));
  bool interrupted = false;
  const tasks::StepsReport report = [&] {
    const py::gil_scoped_release no_gil;
    return state.step(inputs, nstep, [&] { return interrupted = interruptedByUser(); });
  }();
  if (interrupted) throw py::error_already_set();
  return reportOf(report);
}

}  // namespace

void bindStatus(py::module_& module) {
  module.attr("Status") = statusClass();
  module.def("remedies", &remediesOf, py::arg("status"), "A sentence per flag: what happened, and what to change.");
}

void bindStep(py::module_& module) {
  status_ok = py::object(module.attr("Status")(0)).release().ptr();
  report_type = PyStructSequence_NewType(&kReportDescription);
  if (!report_type) throw py::error_already_set();
  module.attr("StepReport") = py::handle(reinterpret_cast<PyObject*>(report_type));
  module.def("step", &step, py::arg("model"), py::arg("state"), py::arg("nstep") = 1, py::arg("inputs") = py::none(),
             "nstep ticks of the model. Fingers and driven bodies follow the scene's trajectories but where inputs or "
             "targets say otherwise. "
             "Releases the interpreter lock. Returns a StepReport.");
}

}  // namespace pincer::python
