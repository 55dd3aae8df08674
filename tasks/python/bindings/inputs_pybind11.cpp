#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/inputs.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"

namespace pincer::python {
namespace {

// The numbers of a table of inputs and how many to a row.
using Table = std::pair<double*, std::vector<py::ssize_t>>;
template <class Row>
Table tableOf(std::vector<Row>& rows) {
  constexpr py::ssize_t kColumns = sizeof(Row) / sizeof(double);  // numbers of a row: it holds nothing but doubles
  return {reinterpret_cast<double*>(rows.data()), {static_cast<py::ssize_t>(rows.size()), kColumns}};
}
Table tableOf(std::vector<double>& row) { return {row.data(), {static_cast<py::ssize_t>(row.size())}}; }
Table tableOf(Vec3& row) { return {row.data(), {3}}; }

// Adds a property that is a live view, and takes what can be assigned to it.
template <class Member>
void addTable(py::class_<Inputs>& inputs, const char* name, Member tasks::SceneInputs::*member, const char* doc) {
  const auto view = [member](const py::object& self) {
    auto [data, shape] = tableOf(self.cast<Inputs&>().*member);
    return viewOf(data, shape, self, true);
  };
  inputs.def_property(
      name, view, [view](const py::object& self, const py::object& value) { assign(view(self), value); }, doc);
}

}  // namespace

void bindInputs(py::module_& module) {
  py::class_<Inputs> inputs(module, "Inputs",
                            "What a step is to do in place of the scene's trajectories. NaN: not said.");
  inputs
      .def(py::init([](std::shared_ptr<Model> model) { return std::make_unique<Inputs>(std::move(model)); }),
           py::arg("model"), "Nothing is said.")
      .def("clear", &Inputs::clear, "Nothing is said any more; views stay valid.");
  addTable(inputs, "finger_position", &tasks::SceneInputs::finger_place,
           "(nfinger, 3) places of the devices at the end of the step [m]; over several ticks they go there evenly. "
           "NaN: State.finger().target, "
           "else the scene's trajectory.");
  addTable(inputs, "finger_velocity", &tasks::SceneInputs::finger_velocity,
           "(nfinger, 3) of the devices [m/s]; NaN: that of the way.");
  addTable(inputs, "finger_rotation", &tasks::SceneInputs::finger_turn,
           "(nfinger, 4) quaternions w, x, y, z of the finger frames; NaN: the scene's.");
  addTable(inputs, "finger_force", &tasks::SceneInputs::finger_force,
           "(nfinger, 3) on each fingertip, besides the scene's [N].");
  addTable(inputs, "body_force", &tasks::SceneInputs::body_force,
           "(nbody, 6) force through the centre of mass [N] and torque [N m], world axes, all through the step.");
  addTable(inputs, "motion_position", &tasks::SceneInputs::motion_place,
           "(len(model.driven), 7) x, y, z [m], quaternion w, x, y, z of driven bodies at the end of every tick; NaN: "
           "the scene's.");
  addTable(inputs, "motion_velocity", &tasks::SceneInputs::motion_rate,
           "(len(model.driven), 6) velocity of the body's origin [m/s], angular velocity [rad/s]; counts where "
           "motion_position is said.");
  addTable(inputs, "drive_target", &tasks::SceneInputs::drive_target,
           "(ndrive) what each drive is told all through the step: a position, a rate or a force, as its type has it; "
           "NaN: what the scene "
           "tells it.");
  addTable(inputs, "gravity", &tasks::SceneInputs::gravity, "(3) [m/s^2]; NaN: the scene's.");
}

}  // namespace pincer::python
