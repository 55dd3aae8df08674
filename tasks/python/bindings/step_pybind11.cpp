#include <pybind11/stl.h>

#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/inputs.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"
#include "pincer/tasks/run/scene/step_status_text.h"

namespace pincer::python {
namespace {

tasks::StepsReport step(const Model& model, State& state, std::int64_t nstep, const Inputs* inputs) {
  if (&state.model() != &model) throw InputError("step: the state is one of another model. Make it with pincer.State(model).");
  if (inputs && inputs->model.get() != &model)
    throw InputError("step: the inputs are those of another model. Make them with pincer.Inputs(model).");
  if (nstep < 1) throw InputError(fmt::format("step: nstep = {} is out of range [1, inf).", nstep));
  bool interrupted = false;
  const auto report = [&] {
    const py::gil_scoped_release no_gil;
    return state.step(inputs, nstep, [&] { return interrupted = interruptedByUser(); });
  }();
  if (interrupted) throw py::error_already_set();
  return report;
}

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
  flags.attr("__doc__") = "What happened in a step that a caller may have to know; pincer.remedies(status) says what to change.";
  return flags;
}

std::vector<std::string> remediesOf(std::uint32_t status) {
  std::vector<std::string> remedies;
  for (const tasks::StatusKind& kind : tasks::kStatusKinds) {
    if (status & kind.bit) remedies.emplace_back(kind.sentence);
  }
  return remedies;
}

py::object statusOf(const tasks::StepsReport& report) { return py::module_::import("pincer._core").attr("Status")(report.status); }

std::string stepRepr(const tasks::StepsReport& report) {
  return fmt::format("<pincer.StepReport: {} ticks, status {}, {} contacts{}>", report.ticks, report.status, report.contacts,
                     report.asleep ? ", asleep" : "");
}

}  // namespace

void bindStatus(py::module_& module) {
  module.attr("Status") = statusClass();
  module.def("remedies", &remediesOf, py::arg("status"), "A sentence per flag: what happened, and what to change.");
}

void bindStep(py::module_& module) {
  using tasks::StepsReport;
  py::class_<StepsReport>(module, "StepReport", "What one call of step came to.")
      .def_property_readonly("status", &statusOf, "Flags of all its ticks together (Status).")
      .def_property_readonly(
          "ok", [](const StepsReport& r) { return r.status == engine::kStepOk; }, "No flag is up.")
      .def_property_readonly(
          "remedies", [](const StepsReport& r) { return remediesOf(r.status); }, "A sentence per flag.")
      .def_readonly("ticks", &StepsReport::ticks, "That were done; fewer than asked for where the state broke.")
      .def_readonly("contacts", &StepsReport::contacts, "In the last tick.")
      .def_readonly("parts", &StepsReport::parts, "That the last tick was cut into.")
      .def_readonly("asleep", &StepsReport::asleep, "The last tick only repeated the one before.")
      .def("__repr__", &stepRepr);
  module.def(
      "step", &step, py::arg("model"), py::arg("state"), py::arg("nstep") = 1, py::arg("inputs") = py::none(),
      "nstep ticks of the model. Fingers and driven bodies follow the scene's trajectories but where inputs or targets say otherwise. "
      "Releases the interpreter lock.");
}

}  // namespace pincer::python
