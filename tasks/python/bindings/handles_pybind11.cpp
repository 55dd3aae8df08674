#include <pybind11/stl.h>

#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/handles.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"

namespace pincer::python {
namespace {

int checked(int index, std::size_t count, const char* what) {
  const int size = static_cast<int>(count), place = index < 0 ? index + size : index;
  if (place < 0 || place >= size)
    throw InputError(fmt::format("{} {} is out of range: this scene has {}.", what, index, count));
  return place;
}

// A row of the state's views keeps the handle alive, which keeps the state.
py::array_t<double> bodyPlace(const py::object& self) {
  const auto& body = self.cast<const BodyHandle&>();
  return viewOf(body.state->places() + 7 * body.index, {7}, self, false);
}

py::array_t<double> bodyRate(const py::object& self) {
  const auto& body = self.cast<const BodyHandle&>();
  return viewOf(body.state->rates() + 6 * body.index, {6}, self, false);
}

void setPlace(const BodyHandle& body, const py::object& value) {
  engine::BodyStart start = body.state->startOf(body.index);
  const bool turns = py::len(value) != 3;
  const std::vector<double> p = numbersOf(value, turns ? 7 : 3, "position (x, y, z, or x, y, z, qw, qx, qy, qz)");
  start.X_WB.p = Vec3(p[0], p[1], p[2]);
  if (turns) start.X_WB.q = Quat(p[3], p[4], p[5], p[6]);
  body.state->place(body.index, start);
}

void setRate(const BodyHandle& body, const py::object& value) {
  engine::BodyStart start = body.state->startOf(body.index);
  const std::vector<double> v = numbersOf(value, 6, "velocity (vx, vy, vz, wx, wy, wz)");
  start.v_W = Vec3(v[0], v[1], v[2]);
  start.w_W = Vec3(v[3], v[4], v[5]);
  body.state->place(body.index, start);
}

double jointPosition(const JointHandle& joint) {
  return tasks::jointPosition(joint.state->model(), joint.state->scene(), joint.index);
}
double jointVelocity(const JointHandle& joint) {
  return tasks::jointVelocity(joint.state->model(), joint.state->scene(), joint.index);
}
void setJointPosition(const JointHandle& joint, double value) {
  joint.state->setJoint(joint.index, value, jointVelocity(joint));
}
void setJointVelocity(const JointHandle& joint, double value) {
  joint.state->setJoint(joint.index, jointPosition(joint), value);
}

const engine::PointState& pointOf(const FingerHandle& finger) {
  return finger.state->scene().grasp.world.points[static_cast<std::size_t>(finger.index)];
}

void setTarget(const FingerHandle& finger, const py::object& value) {
  if (value.is_none())
    return finger.state->hold(finger.index, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  const std::vector<double> p = numbersOf(value, 3, "target (x, y, z, or None)");
  if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
    throw InputError(fmt::format(
        "target = {}, {}, {} isn't finite. Give a place [m], or None to follow the scene again.", p[0], p[1], p[2]));
  }
  finger.state->hold(finger.index, Vec3(p[0], p[1], p[2]));
}

py::array_t<double> pressureOf(const FingerHandle& finger) {
  const grasp::PressureGrid& grid =
      finger.state->model().scene.fingers[static_cast<std::size_t>(finger.index)].model.taxels;
  py::array_t<double> map({grid.rows, grid.columns});
  std::fill_n(map.mutable_data(), map.size(), 0.0);
  const FingerFelt felt = finger.state->felt(finger.index);
  for (std::size_t i = 0; i < felt.pressure.size(); ++i) map.mutable_data()[i] = felt.pressure[i].normal;
  return map;
}

// A member of the last report as a read-only property.
template <class Value>
auto report(Value grasp::FingerReport::*member) {
  return [member](const FingerHandle& f) { return f.state->felt(f.index).report.*member; };
}
auto reportVector(Vec3 grasp::FingerReport::*member) {
  return [member](const FingerHandle& f) { return arrayOf(f.state->felt(f.index).report.*member); };
}

}  // namespace

BodyHandle bodyOf(State& state, const std::string& name) { return {&state, state.model().bodyNamed(name)}; }
BodyHandle bodyAt(State& state, int index) {
  return {&state, checked(index, state.model().scene.bodies.size(), "body")};
}
JointHandle jointOf(State& state, const std::string& name) { return {&state, state.model().jointNamed(name)}; }
JointHandle jointAt(State& state, int index) { return {&state, checked(index, state.model().joints.size(), "joint")}; }
FingerHandle fingerOf(State& state, const std::string& name) { return {&state, state.model().fingerNamed(name)}; }
FingerHandle fingerAt(State& state, int index) {
  return {&state, checked(index, state.model().scene.fingers.size(), "finger")};
}

void bindHandles(py::module_& module) {
  py::class_<BodyHandle>(module, "Body", "One body of a state.")
      .def_readonly("index", &BodyHandle::index)
      .def_property_readonly(
          "name",
          [](const BodyHandle& b) { return b.state->model().scene.bodies[static_cast<std::size_t>(b.index)].name; })
      .def_property("position", &bodyPlace, &setPlace,
                    "Live view (7): x, y, z [m], quaternion w, x, y, z. Assign 3 or 7 numbers to place it: contacts "
                    "forget what they remembered.")
      .def_property("velocity", &bodyRate, &setRate,
                    "Live view (6): of the centre of mass [m/s], angular [rad/s], world axes. Assign 6 numbers.");
  py::class_<JointHandle>(module, "Joint", "One pivot or slider of a state: it has one coordinate [rad] or [m].")
      .def_readonly("index", &JointHandle::index)
      .def_property_readonly(
          "name", [](const JointHandle& j) { return nameOfJoint(j.state->model(), static_cast<std::size_t>(j.index)); })
      .def_property(
          "position", &jointPosition, &setJointPosition,
          "Its coordinate [rad, m]. Assign a number: what it carries goes along, contacts forget what they remembered.")
      .def_property("velocity", &jointVelocity, &setJointVelocity, "Its rate [rad/s, m/s]. Assign a number.");
  py::class_<FingerHandle>(module, "Finger",
                           "One finger of a state: where its device is to go, and what it felt in the last tick.")
      .def_readonly("index", &FingerHandle::index)
      .def_property_readonly("name",
                             [](const FingerHandle& f) {
                               return f.state->model().scene.fingers[static_cast<std::size_t>(f.index)].model.name;
                             })
      .def_property(
          "target", [](const FingerHandle& f) { return arrayOf(pointOf(f).p_target_W); }, &setTarget,
          "Where the device is [m]. Assign a place: the next step takes it there evenly, and it stays; None: it "
          "follows the scene again.")
      .def_property_readonly(
          "position", [](const FingerHandle& f) { return arrayOf(pointOf(f).p_W); },
          "Of the fingertip (the proxy) [m].")
      .def_property_readonly(
          "velocity", [](const FingerHandle& f) { return arrayOf(pointOf(f).v_W); }, "Of the fingertip [m/s].")
      .def_property_readonly("touching", report(&grasp::FingerReport::touching))
      .def_property_readonly("slips", report(&grasp::FingerReport::sliding))
      .def_property_readonly("body", report(&grasp::FingerReport::body),
                             "Index of the body that carries the largest force; -1: none.")
      .def_property_readonly("place", reportVector(&grasp::FingerReport::p_WC), "Of the contact [m].")
      .def_property_readonly("normal", reportVector(&grasp::FingerReport::n_W), "Out of the body there.")
      .def_property_readonly("force", reportVector(&grasp::FingerReport::f_contact_W),
                             "Sum of the contacts' on the finger [N].")
      .def_property_readonly("user_force", reportVector(&grasp::FingerReport::f_user_W),
                             "To be rendered on a person's finger [N].")
      .def_property_readonly("normal_force", report(&grasp::FingerReport::normal_force), "[N]")
      .def_property_readonly("tangential_force", report(&grasp::FingerReport::tangential_force), "[N]")
      .def_property_readonly("torsion", report(&grasp::FingerReport::torsion), "[N m]")
      .def_property_readonly("gap", report(&grasp::FingerReport::gap),
                             "To the nearest body [m]; beyond the finger's reach a lower bound.")
      .def_property_readonly("pressure", &pressureOf, "Copy: (rows, columns) of the taxels' normal forces [N].");
}

}  // namespace pincer::python
