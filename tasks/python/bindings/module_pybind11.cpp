#include <pybind11/pybind11.h>

#include "pincer/contact/error.h"
#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/run/session/build_info.h"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  using namespace pincer::python;
  module.doc() = "The compiled part of pincer; import pincer.";
  module.attr("__version__") = pincer::tasks::kBuildInfo.version;
  module.def("version_text", &pincer::tasks::versionText,
             "Version, commit, compiler, C library, processor and flags, as `pincer --version`.");
  py::register_exception<pincer::InputError>(module, "InputError", PyExc_ValueError).attr("__doc__") =
      "Bad input: the message says what, where, the allowed range and what helps, as the program's does.";
  bindStatus(module);
  bindModel(module);
  bindInputs(module);
  bindState(module);
  bindHandles(module);
  bindStep(module);
  bindRollout(module);
  bindRender(module);
  bindTables(module);
}
