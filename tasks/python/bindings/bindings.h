// bindings: the parts of the module, each of which adds its classes and functions.
#pragma once

namespace pybind11 {
class module_;
}

namespace pincer::python {

void bindStatus(pybind11::module_& module);
void bindModel(pybind11::module_& module);
void bindState(pybind11::module_& module);
void bindHandles(pybind11::module_& module);
void bindInputs(pybind11::module_& module);
void bindStep(pybind11::module_& module);
void bindRollout(pybind11::module_& module);
void bindRender(pybind11::module_& module);
void bindTables(pybind11::module_& module);

}  // namespace pincer::python
