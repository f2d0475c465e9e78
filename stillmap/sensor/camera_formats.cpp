// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/camera_formats.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stillmap/core/ascii_lower.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Member = double CameraModel::*;

constexpr std::array kBrownCoefficients = {&CameraModel::k1,
                                           &CameraModel::k2,
                                           &CameraModel::p1,
                                           &CameraModel::p2,
                                           &CameraModel::k3,
                                           &CameraModel::k4,
                                           &CameraModel::k5,
                                           &CameraModel::k6};
constexpr std::array kFisheyeCoefficients = {
    &CameraModel::k1, &CameraModel::k2, &CameraModel::k3, &CameraModel::k4};

bool all_zero(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return number == 0; });
}

// Coefficients in OpenCV's order, as many as there are. What stillmap has no place for must be 0.
void set_coefficients(CameraModel& camera,
                      std::span<const double> numbers,
                      const std::string& place) {
  const std::span<const Member> members = camera.lens == LensModel::kFisheye
                                              ? std::span<const Member>(kFisheyeCoefficients)
                                              : std::span<const Member>(kBrownCoefficients);
  const std::size_t used = std::min(numbers.size(), members.size());
  for (std::size_t i = 0; i < used; ++i) camera.*members[i] = numbers[i];
  if (!all_zero(numbers.subspan(used))) {
    throw Error("{}: {} coefficients of distortion, expected at most {} that are not 0",
                place,
                numbers.size(),
                members.size());
  }
}

void set_matrix(CameraModel& camera,
                std::span<const double> m,
                bool by_columns,
                const std::string& place) {
  if (m.size() != 9) {
    throw Error("{}: {} numbers, expected the 9 of a camera matrix", place, m.size());
  }
  camera.fx = m[0];
  camera.fy = m[4];
  camera.cx = by_columns ? m[6] : m[2];
  camera.cy = by_columns ? m[7] : m[5];
  const double skew = by_columns ? m[3] : m[1];
  const bool last_row = by_columns ? m[2] == 0 && m[5] == 0 : m[6] == 0 && m[7] == 0;
  if (skew != 0 || !last_row || m[8] != 1) {
    throw Error("{}: expected the {} [fx 0 cx; 0 fy cy; 0 0 1]",
                place,
                by_columns ? "columns of" : "rows of");
  }
}

void set_depth_factor(CameraModel& camera,
                      const CameraValues& values,
                      std::initializer_list<std::string_view> keys) {
  camera.depth_factor_given = false;
  for (const std::string_view key : keys) {
    if (!values.has(key)) continue;
    camera.depth_factor = values.number(key);
    camera.depth_factor_given = true;
  }
}

LensModel lens_named(const CameraValues& values,
                     std::string_view key,
                     std::initializer_list<std::pair<std::string_view, LensModel>> known) {
  const std::string& name = values.text(key);
  std::string names;
  for (const auto& [its_name, lens] : known) {
    if (its_name == name) return lens;
    names += (names.empty() ? "" : ", ") + std::string(its_name);
  }
  throw Error("{}: {} is '{}', expected one of {}", values.place(key), key, name, names);
}

// fx, k1 and so on as keys with a prefix; what is missing of the distortion is 0.
void set_by_names(CameraModel& camera, const CameraValues& values, const std::string& prefix) {
  constexpr std::array<std::pair<std::string_view, Member>, 12> kNames = {
      {{"fx", &CameraModel::fx},
       {"fy", &CameraModel::fy},
       {"cx", &CameraModel::cx},
       {"cy", &CameraModel::cy},
       {"k1", &CameraModel::k1},
       {"k2", &CameraModel::k2},
       {"p1", &CameraModel::p1},
       {"p2", &CameraModel::p2},
       {"k3", &CameraModel::k3},
       {"k4", &CameraModel::k4},
       {"k5", &CameraModel::k5},
       {"k6", &CameraModel::k6}}};
  for (const auto& [name, member] : kNames) {
    const std::string key = prefix + std::string(name);
    if (values.has(key)) camera.*member = values.number(key);
  }
  if (camera.lens == LensModel::kFisheye) camera.p1 = camera.p2 = camera.k5 = camera.k6 = 0;
}

// https://github.com/UZ-SLAMLab/ORB_SLAM3: Calibration_Tutorial.pdf, section 4, and the files of
// both versions before File.version 1.0.
CameraModel read_orb_slam(const CameraValues& values) {
  const std::string prefix = values.has_prefix("Camera1.") ? "Camera1." : "Camera.";
  const std::array<std::string, 6> required = {
      prefix + "fx", prefix + "fy", prefix + "cx", prefix + "cy", "Camera.width", "Camera.height"};
  values.require(required, "; ORB-SLAM2 works without the size, here it needs lines with it");
  CameraModel camera;
  if (values.has("Camera.type")) {
    camera.lens = lens_named(values,
                             "Camera.type",
                             {{"PinHole", LensModel::kBrownConrady},
                              {"Rectified", LensModel::kBrownConrady},
                              {"KannalaBrandt8", LensModel::kFisheye}});
  }
  camera.width_px = values.whole("Camera.width");
  camera.height_px = values.whole("Camera.height");
  set_by_names(camera, values, prefix);
  set_depth_factor(camera, values, {"DepthMapFactor", "RGBD.DepthMapFactor"});
  return camera;
}

// https://stella-cv.readthedocs.io/en/latest/parameters.html
CameraModel read_stella_vslam(const CameraValues& values) {
  const std::array<std::string, 7> required = {"Camera.model",
                                               "Camera.fx",
                                               "Camera.fy",
                                               "Camera.cx",
                                               "Camera.cy",
                                               "Camera.cols",
                                               "Camera.rows"};
  CameraModel camera;
  values.require(std::span(required).first(1));
  camera.lens =
      lens_named(values,
                 "Camera.model",
                 {{"perspective", LensModel::kBrownConrady}, {"fisheye", LensModel::kFisheye}});
  values.require(required);
  camera.width_px = values.whole("Camera.cols");
  camera.height_px = values.whole("Camera.rows");
  if (values.has("Camera.name")) camera.name = values.text("Camera.name");
  set_by_names(camera, values, "Camera.");
  set_depth_factor(camera,
                   values,
                   {"Preprocessing.depthmap_factor", "Camera.depthmap_factor", "depthmap_factor"});
  return camera;
}

LensModel ros_lens(const CameraValues& values) {
  if (!values.has("distortion_model") || values.text("distortion_model").empty()) {
    return LensModel::kBrownConrady;
  }
  return lens_named(values,
                    "distortion_model",
                    {{"plumb_bob", LensModel::kBrownConrady},
                     {"rational_polynomial", LensModel::kBrownConrady},
                     {"equidistant", LensModel::kFisheye},
                     {"fisheye", LensModel::kFisheye}});
}

// Where a kind of file keeps size, matrix and distortion.
struct MatrixKeys {
  std::string width, height, matrix, distortion;
};

CameraModel read_matrix(const CameraValues& values, const MatrixKeys& keys) {
  const std::array<std::string, 3> required = {keys.width, keys.height, keys.matrix};
  values.require(required);
  CameraModel camera;
  camera.lens = ros_lens(values);
  camera.width_px = values.whole(keys.width);
  camera.height_px = values.whole(keys.height);
  if (values.has("camera_name")) camera.name = values.text("camera_name");
  set_matrix(camera, values.numbers(keys.matrix), false, values.place(keys.matrix));
  if (values.has(keys.distortion)) {
    set_coefficients(camera, values.numbers(keys.distortion), values.place(keys.distortion));
  }
  camera.depth_factor_given = false;
  return camera;
}

// The files of camera_calibration and of OpenCV's samples, and a printed sensor_msgs/CameraInfo of
// ROS 1 (K, D) or ROS 2 (k, d).
CameraModel read_ros(const CameraValues& values) {
  if (values.has("K")) return read_matrix(values, {"width", "height", "K", "D"});
  if (values.has("k")) return read_matrix(values, {"width", "height", "k", "d"});
  const std::string nested = values.has("camera_matrix.data") ? ".data" : "";
  return read_matrix(values,
                     {"image_width",
                      "image_height",
                      "camera_matrix" + nested,
                      "distortion_coefficients" + nested});
}

// open3d.camera.PinholeCameraIntrinsic, alone or within PinholeCameraParameters, and the metadata
// of its recorder for RealSense. The matrix is written by columns.
CameraModel read_open3d(const CameraValues& values) {
  const std::string prefix = values.has("intrinsic_matrix") ? "" : "intrinsic.";
  const std::string matrix = prefix + "intrinsic_matrix";
  const std::array<std::string, 2> required = {prefix + "width", prefix + "height"};
  values.require(required);
  CameraModel camera;
  camera.width_px = values.whole(prefix + "width");
  camera.height_px = values.whole(prefix + "height");
  set_matrix(camera, values.numbers(matrix), true, values.place(matrix));
  set_depth_factor(camera, values, {"depth_scale"});
  return camera;
}

// The fields of librealsense's rs2_intrinsics (rs.h), as scripts write them. `model` is the name of
// the enumerator with or without its words before: "distortion.brown_conrady", "Brown Conrady".
CameraModel read_realsense(const CameraValues& values) {
  const std::array<std::string, 6> required = {"width", "height", "fx", "fy", "ppx", "ppy"};
  values.require(required);
  CameraModel camera;
  camera.width_px = values.whole("width");
  camera.height_px = values.whole("height");
  camera.fx = values.number("fx");
  camera.fy = values.number("fy");
  camera.cx = values.number("ppx");
  camera.cy = values.number("ppy");
  camera.depth_factor_given = false;
  if (!values.has("coeffs")) return camera;
  const std::vector<double> coefficients = values.numbers("coeffs");
  if (all_zero(coefficients)) return camera;
  std::string model = values.has("model") ? values.text("model") : "";
  model = ascii_lower(std::move(model));
  std::ranges::replace(model, ' ', '_');
  if (model.ends_with("kannala_brandt4")) {
    camera.lens = LensModel::kFisheye;
  } else if (!model.ends_with("brown_conrady") || model.ends_with("inverse_brown_conrady") ||
             model.ends_with("modified_brown_conrady")) {
    throw Error(
        "{}: model is '{}' with coefficients that are not 0, expected brown_conrady or "
        "kannala_brandt4",
        values.place("model"),
        model);
  }
  set_coefficients(camera, coefficients, values.place("coeffs"));
  return camera;
}

}  // namespace

std::optional<CameraModel> read_foreign_camera(const CameraValues& values) {
  if (values.has("Camera.model") || values.has("Camera.cols")) return read_stella_vslam(values);
  if (values.has_prefix("Camera.") || values.has_prefix("Camera1.")) return read_orb_slam(values);
  if (values.has("intrinsic_matrix") || values.has("intrinsic.intrinsic_matrix")) {
    return read_open3d(values);
  }
  if (values.has("ppx")) return read_realsense(values);
  const bool is_ros = values.has_prefix("camera_matrix") || values.has("K") || values.has("k");
  return is_ros ? std::optional(read_ros(values)) : std::nullopt;
}

}  // namespace stillmap
