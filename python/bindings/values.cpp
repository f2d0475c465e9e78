// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/values.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/core.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "stillmap/config/config_io.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/system/output.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr const char* kCameraValues =
    "*, width, height, fx, fy, cx, cy, k1=0.0, k2=0.0, p1=0.0, p2=0.0, k3=0.0, "
    "k4=0.0, k5=0.0, k6=0.0, lens='brown_conrady', depth_factor=5000.0, readout_s=0.0, name='')";
constexpr const char* kCameraDoc =
    R"(A camera, in pixels, with the distortion of OpenCV: k1 to k6, p1 and p2 of a pinhole camera, or
k1 to k4 of a fish-eye (lens="fisheye").

Camera axes: x right, y down, z forward. `depth_factor`: units of a stored depth image in a metre.
`readout_s`: the time of a rolling shutter from the first row to the last, seconds; 0 for a global
shutter, or where it is not known.)";
constexpr const char* kTrajectoryDoc =
    R"(Poses of a camera by their stamps.

`stamps`: N seconds that increase. `poses`: N x 4 x 4, camera to world, metres.)";
constexpr const char* kCloudDoc =
    R"(Points with their colours; labels and normals where it has them.

Its arrays share the memory of this object and cannot be written to. The arguments are copied.)";

// The numbers of a camera by their names in a camera file.
struct CameraNumber {
  const char* key;
  double CameraModel::*member;
  bool required;
};
constexpr std::array<CameraNumber, 14> kCameraNumbers{
    {{"fx", &CameraModel::fx, true},
     {"fy", &CameraModel::fy, true},
     {"cx", &CameraModel::cx, true},
     {"cy", &CameraModel::cy, true},
     {"k1", &CameraModel::k1, false},
     {"k2", &CameraModel::k2, false},
     {"p1", &CameraModel::p1, false},
     {"p2", &CameraModel::p2, false},
     {"k3", &CameraModel::k3, false},
     {"k4", &CameraModel::k4, false},
     {"k5", &CameraModel::k5, false},
     {"k6", &CameraModel::k6, false},
     {"depth_factor", &CameraModel::depth_factor, false},
     {"readout_s", &CameraModel::readout_s, false}}};

py::array camera_matrix(const CameraModel& camera) {
  py::array_t<double> matrix({3, 3});
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.mutable_data()) <<  //
      camera.fx,
      0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return matrix;
}

LensModel lens_of(const std::string& name) {
  if (name == "brown_conrady") return LensModel::kBrownConrady;
  if (name == "fisheye") return LensModel::kFisheye;
  throw Error("Camera: lens is '{}', expected brown_conrady or fisheye", name);
}

CameraModel make_camera(const py::kwargs& values) {
  CameraModel camera;
  std::vector<std::string> known = {"name", "width", "height", "lens"};
  const auto take = [&](const char* key, auto& member, bool required) {
    if (values.contains(key)) {
      member = py::cast<std::remove_reference_t<decltype(member)>>(values[key]);
    } else if (required) {
      throw Error("Camera: {} is missing", key);
    }
  };
  take("name", camera.name, false);
  take("width", camera.width_px, true);
  take("height", camera.height_px, true);
  std::string lens = "brown_conrady";
  take("lens", lens, false);
  camera.lens = lens_of(lens);
  for (const CameraNumber& number : kCameraNumbers) {
    take(number.key, camera.*number.member, number.required);
    known.emplace_back(number.key);
  }
  for (const auto& [key, value] : values) {
    const auto name = py::cast<std::string>(key);
    if (std::ranges::find(known, name) == known.end()) {
      throw Error("Camera: unknown {}: {}", name, name_hint(name, known));
    }
  }
  check_camera(camera, "Camera");
  return camera;
}

Eigen::Isometry3d transform_of(const double* rows, py::ssize_t index) {
  constexpr double kTolerance = 1e-4;
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(rows + 16 * index);
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const bool rigid = matrix.allFinite() && (R.transpose() * R).isIdentity(kTolerance) &&
                     R.determinant() > 0 &&
                     matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), kTolerance);
  if (!rigid) {
    throw Error("poses[{}]: no rigid transform, expected [R t; 0 0 0 1] with a rotation R", index);
  }
  Eigen::Isometry3d transform(Eigen::Quaterniond(R).normalized());
  transform.translation() = matrix.topRightCorner<3, 1>();
  return transform;
}

Poses make_poses(const py::object& stamps, const py::object& poses) {
  const auto seconds = rows_of<double>(stamps, "stamps", 0);
  const auto matrices =
      py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(poses);
  const py::ssize_t count = seconds.shape(0);
  if (!matrices || matrices.ndim() != 3 || matrices.shape(0) != count || matrices.shape(1) != 4 ||
      matrices.shape(2) != 4) {
    PyErr_Clear();
    throw Error("poses: {}, expected {} x 4 x 4, one for each stamp", description_of(poses), count);
  }
  Poses result;
  for (py::ssize_t i = 0; i < count; ++i) {
    const Stamp stamp = stamp_of(py::float_(seconds.at(i)));
    if (i > 0 && stamp.seconds <= result.trajectory.back().stamp.seconds) {
      throw Error("stamps[{}]: {} after {}, expected stamps that increase",
                  i,
                  stamp.text,
                  result.trajectory.back().stamp.text);
    }
    result.trajectory.push_back({stamp, transform_of(matrices.data(), i)});
  }
  return result;
}

py::array stamps_array(const Poses& poses) {
  py::array_t<double> array(static_cast<py::ssize_t>(poses.trajectory.size()));
  double* seconds = array.mutable_data();
  for (const StampedPose& pose : poses.trajectory) *seconds++ = pose.stamp.seconds;
  return array;
}

py::array poses_array(const Poses& poses) {
  py::array_t<double> array({static_cast<py::ssize_t>(poses.trajectory.size()),
                             static_cast<py::ssize_t>(4),
                             static_cast<py::ssize_t>(4)});
  double* rows = array.mutable_data();
  for (const StampedPose& pose : poses.trajectory) {
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> target(rows);
    target = pose.T_world_camera.matrix();
    rows += 16;
  }
  return array;
}

// Copies rows of `columns` numbers, or a flat array.
template <class Value, class Element>
void copy_rows(const py::object& object,
               const char* name,
               py::ssize_t columns,
               std::size_t expected,
               std::vector<Element>& target) {
  static_assert(sizeof(Element) % sizeof(Value) == 0);
  const auto rows = rows_of<Value>(object, name, columns);
  const auto count = static_cast<std::size_t>(rows.shape(0));
  if (count != expected) {
    throw Error("{}: {} of them, expected one for each of {} points", name, count, expected);
  }
  target.resize(count);
  std::memcpy(static_cast<void*>(target.data()), rows.data(), count * sizeof(Element));
}

PointCloud make_cloud(const py::object& points,
                      const py::object& colors,
                      const py::object& labels,
                      const py::object& normals) {
  PointCloud cloud;
  const auto count = static_cast<std::size_t>(rows_of<float>(points, "points", 3).shape(0));
  copy_rows<float>(points, "points", 3, count, cloud.positions);
  cloud.colors.assign(count, Rgb{128, 128, 128});
  if (!colors.is_none()) copy_rows<std::uint8_t>(colors, "colors", 3, count, cloud.colors);
  if (!labels.is_none()) copy_rows<std::uint8_t>(labels, "labels", 0, count, cloud.labels);
  if (!normals.is_none()) copy_rows<float>(normals, "normals", 3, count, cloud.normals);
  return cloud;
}

// The arrays of a cloud belong to its Python object, `self`.
template <class Value, class Element>
py::object cloud_array(const py::object& self,
                       std::vector<Element> PointCloud::*member,
                       std::size_t columns) {
  const auto& cloud = py::cast<const PointCloud&>(self);
  const std::vector<Element>& elements = cloud.*member;
  if (elements.empty() && !cloud.empty()) return py::none();
  const auto* values = reinterpret_cast<const Value*>(elements.data());
  return shared_array(values, elements.size(), columns, self);
}

std::string text_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return py::cast<bool>(value) ? "true" : "false";
  return py::cast<std::string>(py::str(value));
}

py::dict default_settings() {
  SystemConfig config;
  py::dict values;
  for (const FieldRef& field : list_fields(config)) {
    std::visit([&](const auto* value) { values[py::str(field.key)] = *value; }, field.value);
  }
  return values;
}

void add_camera(py::module_& module) {
  py::class_<CameraModel> camera(
      module, "Camera", doc(std::string("Camera(") + kCameraValues, kCameraDoc).c_str());
  camera
      .def(py::init(&make_camera),
           doc(std::string("__init__(self, ") + kCameraValues, "See the class.").c_str())
      .def_static("load",
                  &camera_of,
                  py::arg("name_or_file"),
                  doc("load(name_or_file)",
                      "A built-in camera (tum_fr1, tum_fr2, tum_fr3, bonn), or that of a "
                      "camera.yaml.")
                      .c_str())
      .def("yaml",
           &format_camera_yaml,
           doc("yaml(self)", "The text of a camera file, which load() reads back.").c_str())
      .def_property_readonly("matrix", &camera_matrix, "fx 0 cx; 0 fy cy; 0 0 1.")
      .def_readonly("name", &CameraModel::name, "Of a built-in camera, or of its file.")
      .def_readonly("width", &CameraModel::width_px, "Columns of both images.")
      .def_readonly("height", &CameraModel::height_px, "Rows of both images.")
      .def_property_readonly(
          "lens",
          [](const CameraModel& self) {
            return self.lens == LensModel::kFisheye ? "fisheye" : "brown_conrady";
          },
          "brown_conrady or fisheye.")
      .def("__repr__", [](const CameraModel& self) {
        return fmt::format("<stillmap.Camera {}{}{} x {}>",
                           self.name,
                           self.name.empty() ? "" : ", ",
                           self.width_px,
                           self.height_px);
      });
  for (const CameraNumber& number : kCameraNumbers) {
    camera.def_readonly(number.key, number.member, "See Camera.");
  }
}

void add_trajectory(py::module_& module) {
  py::class_<Poses>(module, "Trajectory", doc("Trajectory(stamps, poses)", kTrajectoryDoc).c_str())
      .def(py::init(&make_poses),
           py::arg("stamps"),
           py::arg("poses"),
           doc("__init__(self, stamps, poses)", "See the class.").c_str())
      .def_static(
          "load",
          [](const std::filesystem::path& file) { return Poses{read_trajectory(file)}; },
          py::arg("file"),
          doc("load(file)", "Reads a file in the format of the TUM RGB-D benchmark.").c_str())
      .def(
          "save",
          [](const Poses& self, const std::filesystem::path& file) {
            save_trajectory(file, self.trajectory);
          },
          py::arg("file"),
          doc("save(self, file)", "Writes a file in the format of the TUM RGB-D benchmark.")
              .c_str())
      .def_property_readonly("stamps", &stamps_array, "Seconds, N float64.")
      .def_property_readonly("poses", &poses_array, "Camera to world, metres, N x 4 x 4 float64.")
      .def("__len__", [](const Poses& self) { return self.trajectory.size(); })
      .def("__repr__", [](const Poses& self) {
        return fmt::format("<stillmap.Trajectory of {} poses>", self.trajectory.size());
      });
}

void add_cloud(py::module_& module) {
  const auto points = [](const py::object& self) {
    return cloud_array<float>(self, &PointCloud::positions, 3);
  };
  const auto colors = [](const py::object& self) {
    return cloud_array<std::uint8_t>(self, &PointCloud::colors, 3);
  };
  const auto labels = [](const py::object& self) {
    return cloud_array<std::uint8_t>(self, &PointCloud::labels, 0);
  };
  const auto normals = [](const py::object& self) {
    return cloud_array<float>(self, &PointCloud::normals, 3);
  };
  py::class_<PointCloud>(
      module,
      "PointCloud",
      doc("PointCloud(points, colors=None, labels=None, normals=None)", kCloudDoc).c_str())
      .def(py::init(&make_cloud),
           py::arg("points"),
           py::arg("colors") = py::none(),
           py::arg("labels") = py::none(),
           py::arg("normals") = py::none(),
           doc("__init__(self, points, colors=None, labels=None, normals=None)", "See the class.")
               .c_str())
      .def_static("load",
                  &read_ply,
                  py::arg("file"),
                  py::call_guard<py::gil_scoped_release>(),
                  doc("load(file)", "Reads a PLY file.").c_str())
      .def(
          "save",
          [](const PointCloud& self, const std::filesystem::path& file) { save_map(file, self); },
          py::arg("file"),
          py::call_guard<py::gil_scoped_release>(),
          doc("save(self, file)", "Writes a binary PLY file, as the program's map.ply.").c_str())
      .def_property_readonly("points", points, "Metres, N x 3 float32.")
      .def_property_readonly("colors", colors, "Red, green, blue, N x 3 uint8.")
      .def_property_readonly("labels", labels, "Places in CLASS_NAMES, N uint8; None: no labels.")
      .def_property_readonly("normals", normals, "Unit length, N x 3 float32; None: no normals.")
      .def("__len__", &PointCloud::size)
      .def("__repr__", [](const PointCloud& self) {
        return fmt::format("<stillmap.PointCloud of {} points>", self.size());
      });
}

// The label of a map's point is a place in this list.
py::tuple class_names() {
  py::list names;
  names.append("");
  for (const std::string_view name : coco_class_names()) names.append(name);
  return py::tuple(names);
}

}  // namespace

CameraModel camera_of(const py::object& camera) {
  if (py::isinstance<CameraModel>(camera)) return py::cast<CameraModel>(camera);
  if (py::isinstance<py::str>(camera) || py::hasattr(camera, "__fspath__")) {
    return camera_by_name(py::cast<std::string>(py::str(camera)));
  }
  throw Error("camera: {}, expected a Camera, or the name or file of one", description_of(camera));
}

std::optional<CameraModel> optional_camera_of(const py::object& camera) {
  return camera.is_none() ? std::nullopt : std::optional(camera_of(camera));
}

Settings settings_of(const py::object& settings, const py::dict& more) {
  Settings result;
  for (const auto& [key, value] : more) {
    result.set(py::cast<std::string>(py::str(key)), text_of(value));
  }
  if (settings.is_none()) return result;
  if (!py::hasattr(settings, "keys")) {
    throw Error("settings: {}, expected a dict such as {{\"tracking.features\": 1500}}",
                description_of(settings));
  }
  for (const auto& [key, value] : py::dict(settings)) {
    result.set(py::cast<std::string>(py::str(key)), text_of(value));
  }
  return result;
}

void add_values(py::module_& module) {
  add_camera(module);
  add_trajectory(module);
  add_cloud(module);
  module.attr("CLASS_NAMES") = class_names();
  module.def("default_settings",
             &default_settings,
             doc("default_settings()",
                 "Every setting by its key, with its default. docs/settings.md has their meanings.")
                 .c_str());
}

}  // namespace stillmap::python
