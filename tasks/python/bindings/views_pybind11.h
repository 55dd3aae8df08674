// views: memory of pincer's as NumPy arrays without a copy. An array keeps the object alive whose memory it shows.
#pragma once
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/math.h"

namespace pincer::python {

namespace py = pybind11;

inline py::array_t<double> viewOf(double* data, std::vector<py::ssize_t> shape, const py::handle& owner,
                                  bool writeable) {
  py::array_t<double> view(std::move(shape), data, owner);
  if (!writeable) py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

// Puts `value` into `view` by NumPy's rules, so that one number or row may stand for many.
inline void assign(py::array_t<double> view, const py::object& value) { view[py::ellipsis()] = value; }

// A vector of `size` numbers, from whatever NumPy makes one of. Throws InputError with what it is for.
inline std::vector<double> numbersOf(const py::object& value, py::ssize_t size, const char* what) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array || array.ndim() != 1 || array.shape(0) != size) {
    PyErr_Clear();
    throw InputError(fmt::format("{} takes {} numbers, got {}.", what, size, std::string(py::repr(value))));
  }
  return {array.data(), array.data() + size};
}

// True once the user has pressed Ctrl-C; the exception is Python's then. For work
// that has let go of the interpreter lock.
inline bool interruptedByUser() {
  const py::gil_scoped_acquire gil;
  return PyErr_CheckSignals() != 0;
}

inline py::array_t<double> arrayOf(const Vec3& v) { return py::array_t<double>(3, v.data()); }

}  // namespace pincer::python
