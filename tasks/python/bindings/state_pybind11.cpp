#include <pybind11/stl.h>

#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/handles.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"
#include "pincer/tasks/run/rollout/state_bytes.h"

namespace pincer::python {
namespace {

py::array_t<double> placesOf(const py::object& self) {
  auto& state = self.cast<State&>();
  return viewOf(state.places(), {static_cast<py::ssize_t>(state.model().scene.bodies.size()), 7}, self, false);
}

py::array_t<double> ratesOf(const py::object& self) {
  auto& state = self.cast<State&>();
  return viewOf(state.rates(), {static_cast<py::ssize_t>(state.model().scene.bodies.size()), 6}, self, false);
}

py::array_t<double> jointRow(const py::object& self, double* (State::*row)()) {
  auto& state = self.cast<State&>();
  return viewOf((state.*row)(), {static_cast<py::ssize_t>(state.model().joints.size())}, self, false);
}

py::array_t<ContactRow> contactsOf(const State& state) {
  const std::vector<ContactRow> rows = state.contacts();
  return py::array_t<ContactRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

double measure(const State& state, const std::string& quantity) {
  return tasks::quantityOf(quantity, state.model().scene).measure(state.moment());
}

py::bytes bytesOf(const State& state) {
  const std::string bytes = tasks::bytesOf(state.scene());
  return py::bytes(bytes);
}

std::unique_ptr<State> unpickled(const py::tuple& parts) {
  auto state = std::make_unique<State>(parts[0].cast<std::shared_ptr<Model>>());
  state->setBytes(parts[1].cast<std::string>());
  return state;
}

}  // namespace

void bindState(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ContactRow, id, body, shape, other_body, other_shape, finger, place, normal, gap, force, moment,
                       mu, pushes, slips);
  py::class_<State>(module, "State",
                    "All of a world that evolves, a value: copy() is a snapshot, hash() its fingerprint; it pickles.")
      .def(py::init([](std::shared_ptr<Model> model) { return std::make_unique<State>(std::move(model)); }),
           py::arg("model"), "The start of the scene.")
      .def_property_readonly("model", [](const State& s) { return std::const_pointer_cast<Model>(s.sharedModel()); })
      .def_property_readonly(
          "time", [](const State& s) { return s.scene().time(); }, "[s]")
      .def_property_readonly(
          "tick", [](const State& s) { return s.scene().grasp.world.tick; }, "Ticks since the start.")
      .def_property_readonly(
          "position", &placesOf,
          "Live, read-only view (nbody, 7): x, y, z [m] and quaternion w, x, y, z of each body's frame in the world.")
      .def_property_readonly("velocity", &ratesOf,
                             "Live, read-only view (nbody, 6): velocity of the centre of mass [m/s] and angular "
                             "velocity [rad/s], world axes.")
      .def_property_readonly(
          "joint_position", [](const py::object& self) { return jointRow(self, &State::jointPositions); },
          "Live, read-only view (njoint): coordinates of the pivots [rad] and sliders [m].")
      .def_property_readonly(
          "joint_velocity", [](const py::object& self) { return jointRow(self, &State::jointVelocities); },
          "Live, read-only view (njoint): their rates [rad/s, m/s].")
      .def_property_readonly("contacts", &contactsOf,
                             "Copy: structured array of the last tick's contacts; force [N] and moment [N m] act on "
                             "what touches, `body` feels "
                             "the negative; normal points out of `body`; finger or other_body is -1.")
      .def("body", &bodyOf, py::arg("name"), py::keep_alive<0, 1>(), "The body of this name (or index).")
      .def("body", &bodyAt, py::arg("index"), py::keep_alive<0, 1>())
      .def("joint", &jointOf, py::arg("name"), py::keep_alive<0, 1>(), "The pivot or slider of this name (or index).")
      .def("joint", &jointAt, py::arg("index"), py::keep_alive<0, 1>())
      .def("finger", &fingerOf, py::arg("name"), py::keep_alive<0, 1>(), "The finger of this name (or index).")
      .def("finger", &fingerAt, py::arg("index"), py::keep_alive<0, 1>())
      .def("measure", &measure, py::arg("quantity"),
           "A quantity by the name that scenes record it with: \"energy\", \"ball.p_z\".")
      .def("hash", &State::hash, "16 hexadecimal digits over every bit of the state, as `pincer sim --json` has them.")
      .def(
          "copy", [](const State& s) { return std::make_unique<State>(s); }, "A snapshot, with memory of its own.")
      .def("__copy__", [](const State& s) { return std::make_unique<State>(s); })
      .def(
          "__deepcopy__", [](const State& s, const py::dict&) { return std::make_unique<State>(s); }, py::arg("memo"))
      .def("restore", &State::restore, py::arg("snapshot"),
           "Back to a snapshot of the same model; views stay valid and follow.")
      .def("reset", &State::reset, "Back to the start of the scene.")
      .def("__repr__",
           [](const State& s) {
             return fmt::format("<pincer.State of {} at {:g} s>", s.model().name, s.scene().time());
           })
      .def(py::pickle(
          [](const State& s) { return py::make_tuple(std::const_pointer_cast<Model>(s.sharedModel()), bytesOf(s)); },
          &unpickled));
}

}  // namespace pincer::python
