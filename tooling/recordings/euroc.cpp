// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/euroc.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/parse_number.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/io/text_file.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/camera_values.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/image_list.hpp"
#include "tooling/eval/trajectory_files.hpp"
#include "tooling/recordings/stereo_images.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = std::size_t{64} << 20U, kMaxRows = 2'000'000;

// mav0/ in the folder, or the folder itself.
fs::path root_of(const fs::path& folder) {
  const fs::path inner = folder / "mav0";
  return path_exists(inner / "cam0" / "data.csv") ? inner : folder;
}

using FilesByStamp = std::map<std::uint64_t, fs::path>;  // ns

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = std::min(text.find_first_not_of(kBlank), text.size());
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

void add_row(FilesByStamp& files,
             std::string_view row,
             const fs::path& camera,
             const std::string& place) {
  const std::size_t comma = row.find(',');
  const std::string_view stamp = trimmed(row.substr(0, comma));
  const std::optional<std::uint64_t> stamp_ns = parse_number<std::uint64_t>(stamp);
  if (comma == std::string_view::npos || !stamp_ns) {
    throw Error("{}: '{}', expected a stamp in nanoseconds, a comma and the name of an image",
                place,
                row.substr(0, 60));
  }
  const std::string name(trimmed(row.substr(comma + 1)));
  if (files.size() == kMaxRows) throw Error("{}: more than {} images", place, kMaxRows);
  if (name.empty()) throw Error("{}: no name of an image", place);
  files.emplace(*stamp_ns, listed_file(camera / "data", {std::nullopt, name, place}));
}

FilesByStamp read_list(const fs::path& camera) {
  const fs::path list = camera / "data.csv";
  const std::string text = read_text(list, kMaxListBytes);
  FilesByStamp files;
  std::string_view rest = text;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view row = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (row.empty() || row.front() == '#') continue;
    add_row(files, row, camera, fmt::format("{}:{}", list.string(), line));
  }
  return files;
}

std::vector<double> numbers_of(const CameraValues& values,
                               std::string_view key,
                               std::size_t count) {
  std::vector<double> numbers = values.numbers(key);
  if (numbers.size() == count) return numbers;
  throw Error("{}: {} has {} numbers, expected {}", values.place(key), key, numbers.size(), count);
}

struct CameraOnBody {
  CameraModel camera;
  Eigen::Isometry3d T_body_camera;
};

CameraOnBody read_sensor(const fs::path& folder) {
  const CameraValues values = CameraValues::read(folder / "sensor.yaml");
  const std::vector<std::string> keys = {
      "T_BS.data", "intrinsics", "resolution", "distortion_model", "distortion_coefficients"};
  values.require(keys);
  if (values.text("distortion_model") != "radial-tangential") {
    throw Error("{}: the distortion_model is {}, expected radial-tangential",
                values.place("distortion_model"),
                values.text("distortion_model"));
  }
  const std::vector<double> size = numbers_of(values, "resolution", 2);
  const std::vector<double> intrinsics = numbers_of(values, "intrinsics", 4);
  const std::vector<double> distortion = numbers_of(values, "distortion_coefficients", 4);
  const std::vector<double> pose = numbers_of(values, "T_BS.data", 16);
  CameraOnBody sensor;
  CameraModel& camera = sensor.camera;
  camera.name = folder.filename().string();
  if (!(size[0] >= 1 && size[0] <= 8192 && size[1] >= 1 && size[1] <= 8192)) {
    throw Error("{}: expected 1 to 8192 pixels a side", values.place("resolution"));
  }
  camera.width_px = static_cast<int>(size[0]);
  camera.height_px = static_cast<int>(size[1]);
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  camera.k1 = distortion[0];
  camera.k2 = distortion[1];
  camera.p1 = distortion[2];
  camera.p2 = distortion[3];
  check_camera(camera, values.file());
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> T(pose.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  if (!(R * R.transpose()).isIdentity(1e-3) || !(R.determinant() > 0)) {
    throw Error("{}: T_BS is no rigid transform", values.place("T_BS.data"));
  }
  sensor.T_body_camera = make_pose(Eigen::Quaterniond(R), T.topRightCorner<3, 1>());
  return sensor;
}

GroundTruth read_poses(const fs::path& file, const Eigen::Isometry3d& T_body_camera) {
  return groundtruth_or_warning([&] {
    GroundTruth truth{read_any_trajectory(file).poses, {}};
    for (StampedPose& pose : truth.poses) pose.T_world_camera = pose.T_world_camera * T_body_camera;
    return truth;
  });
}

}  // namespace

bool is_euroc(const fs::path& folder) {
  const fs::path root = root_of(folder);
  return path_exists(root / "cam0" / "data.csv") && path_exists(root / "cam1" / "data.csv");
}

SequenceContent open_euroc(const fs::path& folder, const ReadingOptions& /*options*/) {
  const fs::path root = root_of(folder);
  const CameraOnBody left = read_sensor(root / "cam0"), right = read_sensor(root / "cam1");
  const StereoCalibration calibration{
      left.camera, right.camera, left.T_body_camera.inverse() * right.T_body_camera};
  const auto rig = std::make_shared<const StereoRig>(calibration, root.string());
  const FilesByStamp lefts = read_list(root / "cam0"), rights = read_list(root / "cam1");
  std::vector<SequenceEntry> entries;
  for (const auto& [stamp_ns, file] : lefts) {
    const auto partner = rights.find(stamp_ns);
    if (partner == rights.end()) continue;
    constexpr std::uint64_t kNsPerS = 1'000'000'000;
    const Stamp stamp =
        parse_stamp(fmt::format("{}.{:09}", stamp_ns / kNsPerS, stamp_ns % kNsPerS)).value();
    entries.push_back({stamp, stamp.seconds, file, partner->second});
  }
  if (entries.empty()) {
    throw Error("{}: no stamp is in both cam0/data.csv and cam1/data.csv", root.string());
  }
  const std::size_t alone = lefts.size() - entries.size();
  SequenceContent content = stereo_content(std::move(entries), rig);
  if (alone > 0) {
    content.remarks.notes.push_back(
        fmt::format("{} images of cam0 have no partner in cam1 and are left out", alone));
  }
  const fs::path poses = root / "state_groundtruth_estimate0" / "data.csv";
  if (path_exists(poses)) {
    const Eigen::Isometry3d T = left.T_body_camera * rig->T_left_rectified();
    content.groundtruth = [poses, T] { return read_poses(poses, T); };
  }
  return content;
}

}  // namespace stillmap
