// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <pybind11/numpy.h>

#include "python/bindings/lent_arrays.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap::python {

// Arrays in. Each throws Error, in one line that says what the array is and what was expected.

/// The pixels of a colour image, red, green, blue: an array of height x width x 3 uint8. They are
/// shared where each pixel's bytes follow each other, else copied.
[[nodiscard]] ColorImage color_image(const pybind11::object& array, LentArrays& lent);
/// A depth image: an array of height x width, float32 in metres (0, NaN, infinite or negative:
/// missing) or uint16 in units of `depth_factor` a metre. Pixels are shared where they are float32
/// and all finite.
[[nodiscard]] DepthImage depth_image(const pybind11::object& array,
                                     double depth_factor,
                                     LentArrays& lent);
/// A time: a number of seconds, or the text of one, which is kept.
[[nodiscard]] Stamp stamp_of(const pybind11::object& value);

// Arrays out. They cannot be written to.

/// The pixels of an image of one or three channels, shared with it; None for an empty one.
[[nodiscard]] pybind11::object image_array(const cv::Mat& image);
/// A transform as 4 x 4.
[[nodiscard]] pybind11::array matrix_array(const Eigen::Isometry3d& transform);

/// An array over `data`, which belongs to `owner`, in rows of `columns` (0: a flat array).
template <class T>
[[nodiscard]] pybind11::array shared_array(const T* data,
                                           std::size_t rows,
                                           std::size_t columns,
                                           pybind11::handle owner) {
  std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(rows)};
  if (columns > 0) shape.push_back(static_cast<pybind11::ssize_t>(columns));
  pybind11::array array(pybind11::dtype::of<T>(), std::move(shape), data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// The array as `rows x columns` of T (columns 0: flat), copied only if it is something else.
/// Throws Error that begins with `name` for other shapes.
template <class T>
[[nodiscard]] pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast> rows_of(
    const pybind11::object& object, const std::string& name, pybind11::ssize_t columns);

/// What an object is, for a message: "480 x 640 x 4 uint8", "a str".
[[nodiscard]] std::string description_of(const pybind11::object& object);

}  // namespace stillmap::python
