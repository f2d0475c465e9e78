// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <pybind11/pybind11.h>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/system/settings.hpp"

namespace stillmap::python {

/// A trajectory as one object of Python, not a list of poses.
struct Poses {
  Trajectory trajectory;
};

/// A Camera, or the name or file of one. Throws Error as camera_by_name() does.
[[nodiscard]] CameraModel camera_of(const pybind11::object& camera);
/// camera_of(); nothing for None.
[[nodiscard]] std::optional<CameraModel> optional_camera_of(const pybind11::object& camera);

/// Settings from a dict of their keys, or None; and from `more`, which `settings` overrules. Throws
/// Error naming a wrong key or value.
[[nodiscard]] Settings settings_of(const pybind11::object& settings, const pybind11::dict& more);

}  // namespace stillmap::python
