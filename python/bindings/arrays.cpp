// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/arrays.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "python/bindings/pixels.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/stamp_text.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr int kMaxSide_px = 8192;

// An array of T with this number of dimensions; nothing else is converted.
template <class T>
bool is_array_of(const py::object& object, py::ssize_t dimensions) {
  return py::isinstance<py::array_t<T>>(object) &&
         py::reinterpret_borrow<py::array>(object).ndim() == dimensions;
}

void check_sides(const py::array& array, const char* name) {
  for (const int axis : {0, 1}) {
    if (array.shape(axis) < 1 || array.shape(axis) > kMaxSide_px) {
      throw Error(
          "{}: {}, expected 1 to {} pixels a side", name, description_of(array), kMaxSide_px);
    }
  }
}

// Whether OpenCV can address the pixels: pixels of a row follow each other, and so do rows.
bool is_image(const py::array& array) {
  const py::ssize_t channels = array.ndim() == 3 ? array.shape(2) : 1;
  const py::ssize_t item = array.itemsize(), pixel = item * channels;
  const bool packed = array.strides(1) == pixel && (array.ndim() < 3 || array.strides(2) == item);
  const bool aligned =
      reinterpret_cast<std::uintptr_t>(array.data()) % item == 0 && array.strides(0) % item == 0;
  return packed && aligned && array.strides(0) >= pixel * array.shape(1);
}

template <class T>
cv::Mat shared_or_copied(const py::array& array, int type, LentArrays& lent) {
  if (is_image(array)) return lent.lend(array, type);
  return lent.lend(py::array_t<T, py::array::c_style | py::array::forcecast>(array), type);
}

}  // namespace

std::string description_of(const py::object& object) {
  if (!py::isinstance<py::array>(object)) {
    return "a " + py::cast<std::string>(py::type::of(object).attr("__name__"));
  }
  const auto array = py::reinterpret_borrow<py::array>(object);
  std::string text;
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
    text += fmt::format("{}{}", axis > 0 ? " x " : "", array.shape(axis));
  }
  return text + " " + py::cast<std::string>(py::str(array.dtype()));
}

ColorImage color_image(const py::object& object, LentArrays& lent) {
  if (!is_array_of<std::uint8_t>(object, 3) ||
      py::reinterpret_borrow<py::array>(object).shape(2) != 3) {
    throw Error("color: {}, expected height x width x 3 uint8 (red, green, blue)",
                description_of(object));
  }
  const auto array = py::reinterpret_borrow<py::array>(object);
  check_sides(array, "color");
  return ColorImage(cv::Mat3b(shared_or_copied<std::uint8_t>(array, CV_8UC3, lent)));
}

DepthImage depth_image(const py::object& object, double depth_factor, LentArrays& lent) {
  const bool raw = is_array_of<std::uint16_t>(object, 2);
  if (!raw && !is_array_of<float>(object, 2)) {
    throw Error(
        "depth: {}, expected height x width, float32 in metres or uint16 in units of the camera's "
        "depth_factor",
        description_of(object));
  }
  const auto array = py::reinterpret_borrow<py::array>(object);
  check_sides(array, "depth");
  if (raw) {
    const cv::Mat1w units(shared_or_copied<std::uint16_t>(array, CV_16UC1, lent));
    return DepthImage(in_metres(units, depth_factor));
  }
  const cv::Mat1f metres(shared_or_copied<float>(array, CV_32FC1, lent));
  return DepthImage(with_missing_as_zero(metres));
}

Stamp stamp_of(const py::object& value) {
  if (py::isinstance<py::str>(value)) {
    if (std::optional<Stamp> stamp = parse_stamp(py::cast<std::string>(value))) {
      return *std::move(stamp);
    }
    throw Error("stamp: {}, expected a finite number", py::cast<std::string>(py::repr(value)));
  }
  const double seconds = PyFloat_AsDouble(py::float_(value).ptr());
  if (!std::isfinite(seconds)) throw Error("stamp: {}, expected seconds", seconds);
  return {seconds, fmt::format("{:.6f}", seconds)};
}

py::object image_array(const cv::Mat& image) {
  if (image.empty()) return py::none();
  const py::capsule owner(new cv::Mat(image), [](void* mat) { delete static_cast<cv::Mat*>(mat); });
  const bool real = image.depth() == CV_32F;
  const auto item = static_cast<py::ssize_t>(image.elemSize1());
  std::vector<py::ssize_t> shape{image.rows, image.cols};
  std::vector<py::ssize_t> strides{static_cast<py::ssize_t>(image.step[0]),
                                   item * image.channels()};
  if (image.channels() > 1) {
    shape.push_back(image.channels());
    strides.push_back(item);
  }
  const py::dtype dtype = real ? py::dtype::of<float>() : py::dtype::of<std::uint8_t>();
  py::array array(dtype, shape, strides, image.data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::array matrix_array(const Eigen::Isometry3d& transform) {
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.mutable_data()) =
      transform.matrix();
  return array;
}

template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> rows_of(const py::object& object,
                                                                  const std::string& name,
                                                                  py::ssize_t columns) {
  using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
  // Colours of 0 to 1 would all become 0.
  const bool lossy = std::is_integral_v<T> && !py::isinstance<py::array_t<T>>(object);
  const Array array = lossy ? Array() : Array::ensure(object);
  const bool fits =
      !lossy && array &&
      (columns == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == columns);
  if (fits) return array;
  PyErr_Clear();
  throw Error("{}: {}, expected {} {}",
              name,
              description_of(object),
              columns == 0 ? std::string("N") : fmt::format("N x {}", columns),
              py::cast<std::string>(py::str(py::dtype::of<T>())));
}
template py::array_t<double, py::array::c_style | py::array::forcecast> rows_of<double>(
    const py::object&, const std::string&, py::ssize_t);
template py::array_t<float, py::array::c_style | py::array::forcecast> rows_of<float>(
    const py::object&, const std::string&, py::ssize_t);
template py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast> rows_of<std::uint8_t>(
    const py::object&, const std::string&, py::ssize_t);

}  // namespace stillmap::python
