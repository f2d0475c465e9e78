// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <pybind11/pybind11.h>

namespace stillmap::python {

/// A docstring that begins with a signature in the form that Python's inspect and help() read.
[[nodiscard]] inline std::string doc(const std::string& signature, const std::string& text) {
  return signature + "\n--\n\n" + text;
}

// Each function adds a part of the library to the module `stillmap._core`.
void add_values(pybind11::module_& module);
void add_objects(pybind11::module_& module);
void add_slam(pybind11::module_& module);
void add_recordings(pybind11::module_& module);
void add_sessions(pybind11::module_& module);
void add_evaluation(pybind11::module_& module);
void add_mesh(pybind11::module_& module);
void add_commands(pybind11::module_& module);

}  // namespace stillmap::python
