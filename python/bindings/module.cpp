// SPDX-License-Identifier: Apache-2.0
// The extension module of the Python package: python/stillmap has the rest, and its documentation.
#include <string>

#include "python/bindings/bindings.hpp"
#include "stillmap/core/error.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  py::options options;
  options.disable_function_signatures();  // doc() has them
  module.doc() = "The C++ part of stillmap. Use the package `stillmap`, which has all names of it.";
  module.attr("__version__") = STILLMAP_VERSION;
  const py::object error =
      py::register_exception<stillmap::Error>(module, "Error", PyExc_ValueError);
  error.attr("__module__") = "stillmap";
  error.attr("__doc__") =
      "Wrong data from outside: one line that names the file, key or argument, says what was\n"
      "expected and what to do.";
  stillmap::python::add_values(module);
  stillmap::python::add_objects(module);
  stillmap::python::add_slam(module);
  stillmap::python::add_recordings(module);
  stillmap::python::add_sessions(module);
  stillmap::python::add_evaluation(module);
  stillmap::python::add_mesh(module);
  stillmap::python::add_commands(module);
}
