#include <pybind11/stl.h>

#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/objects.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"

namespace pincer::python {
namespace {

std::vector<std::string> bodyNames(const Model& model) {
  std::vector<std::string> names;
  for (const engine::BodySpec& body : model.scene.bodies) names.push_back(body.name);
  return names;
}

std::vector<std::string> fingerNames(const Model& model) {
  std::vector<std::string> names;
  for (const tasks::SceneFinger& finger : model.scene.fingers) names.push_back(finger.model.name);
  return names;
}

std::vector<std::string> drivenNames(const Model& model) {
  std::vector<std::string> names;
  for (const int body : model.driven) names.push_back(model.scene.bodies[static_cast<std::size_t>(body)].name);
  return names;
}

std::vector<std::string> jointNames(const Model& model) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.joints.size(); ++i) names.push_back(nameOfJoint(model, i));
  return names;
}

std::vector<std::string> driveNames(const Model& model) {
  std::vector<std::string> names;
  for (const tasks::SceneDrive& drive : model.scene.drives) names.push_back(drive.model.name);
  return names;
}

std::vector<std::string> sensorNames(const Model& model) {
  std::vector<std::string> names;
  for (const tasks::Quantity& quantity : model.scene.record.quantities) names.push_back(quantity.name);
  return names;
}

std::vector<double> masses(const Model& model) {
  std::vector<double> masses;
  for (const engine::BodyModel& body : model.grasp.world.bodies) masses.push_back(body.mass);
  return masses;
}

std::string reprOf(const Model& model) {
  return fmt::format("<pincer.Model {}: {} bodies, {} fingers, ticks of {} s>", model.name, model.scene.bodies.size(),
                     model.scene.fingers.size(), model.scene.options.h);
}

}  // namespace

void bindModel(py::module_& module) {
  py::class_<Model, std::shared_ptr<Model>>(
      module, "Model", "A scene, built and checked once, then constant; any number of states may step it.")
      .def_readonly("name", &Model::name, "Path or name that it was loaded from.")
      .def_readonly("text", &Model::text, "Of the scene, as it was read.")
      .def_property_readonly(
          "description", [](const Model& m) { return m.scene.description; }, "For people.")
      .def_property_readonly("bodies", &bodyNames, "Names of the bodies, in the order of State.position.")
      .def_property_readonly("fingers", &fingerNames, "Names of the fingers, in the order of Inputs.finger_position.")
      .def_property_readonly("driven", &drivenNames,
                             "Names of the bodies that follow motions, in the order of Inputs.motion_position.")
      .def_property_readonly("joints", &jointNames,
                             "Names of the pivots and sliders, in the order of State.joint_position.")
      .def_property_readonly("drives", &driveNames, "Names of the drives, in the order of Inputs.drive_target.")
      .def_property_readonly("sensors", &sensorNames,
                             "Quantities that the scene records, in the order of rollout's sensordata.")
      .def_property_readonly(
          "remarks", [](const Model& m) { return m.scene.remarks; },
          "What of its robots' files has no effect, a line each.")
      .def_property_readonly("masses", &masses, "Of the bodies [kg]; 0 for those that don't move freely.")
      .def_property_readonly(
          "tick", [](const Model& m) { return m.scene.options.h; }, "Length of a step [s].")
      .def_property_readonly(
          "duration", [](const Model& m) { return m.scene.duration; }, "Of the scene [s].")
      .def_property_readonly(
          "ticks", [](const Model& m) { return m.scene.ticks(); }, "In the scene's duration.")
      .def_property_readonly(
          "nbody", [](const Model& m) { return m.scene.bodies.size(); }, "Number of bodies.")
      .def_property_readonly(
          "nfinger", [](const Model& m) { return m.scene.fingers.size(); }, "Number of fingers.")
      .def_property_readonly(
          "njoint", [](const Model& m) { return m.joints.size(); }, "Number of pivots and sliders.")
      .def_property_readonly(
          "ndrive", [](const Model& m) { return m.scene.drives.size(); }, "Number of drives.")
      .def_property_readonly(
          "ncontrol", [](const Model& m) { return tasks::controlSize(m); }, "Columns of rollout's controls.")
      .def_property_readonly(
          "nstate", [](const Model& m) { return tasks::stateSize(m); }, "Columns of rollout's state.")
      .def_property_readonly(
          "nsensor", [](const Model& m) { return tasks::sensorSize(m); }, "Columns of rollout's sensordata.")
      .def("__repr__", &reprOf)
      .def(py::pickle([](const Model& m) { return py::make_tuple(m.text, m.name); },
                      [](const py::tuple& source) {
                        return std::const_pointer_cast<Model>(
                            parseModel(source[0].cast<std::string>(), source[1].cast<std::string>()));
                      }));
  module.def(
      "load_file", [](const std::string& path) { return std::const_pointer_cast<Model>(loadModel(path)); },
      py::arg("path"));
  module.def(
      "load_text",
      [](const std::string& text, const std::string& name) {
        return std::const_pointer_cast<Model>(parseModel(text, name));
      },
      py::arg("text"), py::arg("name"));
}

}  // namespace pincer::python
