# SPDX-License-Identifier: Apache-2.0
# STILLMAP_BUILD_PYTHON: on where pybind11 and Python's headers are. Its functions are commands of the
# program, so that it needs tooling and simulation; a sanitizer's library cannot be loaded by a
# Python without it.
if(NOT DEFINED Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3) # Debian's, which has its packages; the PATH may begin with another
endif()
set(PYBIND11_NOPYTHON ON) # its headers alone
find_package(pybind11 2.10 CONFIG QUIET)
set(with_python OFF)
if(pybind11_FOUND AND STILLMAP_BUILD_TOOLING AND STILLMAP_BUILD_SIMULATION AND NOT STILLMAP_SANITIZE)
  find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
  set(with_python ${Python_FOUND})
endif()
option(STILLMAP_BUILD_PYTHON "Build the Python package (needs pybind11, Python's headers, tooling, simulation)"
  ${with_python})
if(STILLMAP_BUILD_PYTHON)
  if(NOT (STILLMAP_BUILD_TOOLING AND STILLMAP_BUILD_SIMULATION))
    message(FATAL_ERROR "The Python package needs tooling and simulation: set STILLMAP_BUILD_PYTHON to OFF, or "
      "STILLMAP_BUILD_TOOLING and STILLMAP_BUILD_SIMULATION to ON")
  endif()
  find_package(pybind11 2.10 CONFIG REQUIRED)
  find_package(Python 3.9 REQUIRED COMPONENTS Interpreter Development.Module)
endif()
set(STILLMAP_PYTHON_DIR lib/python3/dist-packages CACHE STRING "Where the Python package is installed, below the prefix")
