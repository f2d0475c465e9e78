// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/kitti.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/parse_number.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/text_table.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/numbered_images.hpp"
#include "tooling/eval/trajectory_files.hpp"
#include "tooling/recordings/stereo_images.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

struct CameraPair {
  int left = 0, right = 1;  // numbers of folders and matrices
};

fs::path images_of(const fs::path& folder, int camera) {
  return folder / fmt::format("image_{}", camera);
}

std::optional<CameraPair> find_cameras(const fs::path& folder) {
  for (const CameraPair& pair : {CameraPair{2, 3}, CameraPair{0, 1}}) {
    std::error_code ignored;
    if (fs::is_directory(images_of(folder, pair.left), ignored) &&
        fs::is_directory(images_of(folder, pair.right), ignored)) {
      return pair;
    }
  }
  return std::nullopt;
}

using Projection = Eigen::Matrix<double, 3, 4>;

// The matrix of a camera in calib.txt, a row of "P2:" and twelve numbers.
Projection read_projection(const fs::path& calibration, int camera) {
  const std::string key = fmt::format("P{}:", camera);
  const std::string text = read_file(calibration, std::size_t{1} << 20U);
  const std::size_t begin = text.starts_with(key) ? 0 : text.find("\n" + key) + 1;
  if (begin == 0 && !text.starts_with(key)) {
    throw Error("{}: no row {}, expected it and twelve numbers", calibration.string(), key);
  }
  std::string_view row(text);
  row = row.substr(begin + key.size(), text.find('\n', begin) - begin - key.size());
  std::vector<double> numbers;
  constexpr std::string_view kBlank = " \t\r";
  for (std::size_t at = 0; (at = row.find_first_not_of(kBlank, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(row.find_first_of(kBlank, at), row.size());
    const std::optional<double> number = parse_number<double>(row.substr(at, end - at));
    if (!number || !std::isfinite(*number)) {
      throw Error("{}: row {} has '{}', expected a number",
                  calibration.string(),
                  key,
                  row.substr(at, std::min<std::size_t>(end - at, 40)));
    }
    numbers.push_back(*number);
    at = end;
  }
  if (numbers.size() != 12) {
    throw Error(
        "{}: row {} has {} numbers, expected twelve", calibration.string(), key, numbers.size());
  }
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
}

// Where a camera is in the coordinates of camera 0: they all look the same way.
Eigen::Vector3d position_of(const Projection& P) {
  return -P.leftCols<3>().inverse() * P.col(3);
}

StereoCalibration calibration_of(const Projection& left,
                                 const Projection& right,
                                 cv::Size size,
                                 const fs::path& file) {
  StereoCalibration calibration;
  for (auto [camera, P] : {std::pair(&calibration.left, &left), {&calibration.right, &right}}) {
    camera->name = "kitti";
    camera->width_px = size.width;
    camera->height_px = size.height;
    camera->fx = (*P)(0, 0);
    camera->fy = (*P)(1, 1);
    camera->cx = (*P)(0, 2);
    camera->cy = (*P)(1, 2);
    check_camera(*camera, file.string());
  }
  // The images are rectified: what the matrices have of other directions is rounding.
  calibration.T_left_right = Eigen::Isometry3d::Identity();
  calibration.T_left_right.translation().x() = (position_of(right) - position_of(left)).x();
  return calibration;
}

using FilesByNumber = std::map<std::size_t, fs::path>;

FilesByNumber numbered(const fs::path& folder) {
  FilesByNumber files;
  for (const fs::path& file : files_ending(folder, "")) {
    const std::optional<std::size_t> number = parse_number<std::size_t>(file.stem().string());
    if (number) files.emplace(*number, file);
  }
  return files;
}

std::vector<SequenceEntry> read_entries(const fs::path& folder, const CameraPair& cameras) {
  const TextTable times = TextTable::read(folder / "times.txt", "seconds");
  const FilesByNumber left = numbered(images_of(folder, cameras.left));
  const FilesByNumber right = numbered(images_of(folder, cameras.right));
  std::vector<SequenceEntry> entries;
  for (const auto& [number, file] : left) {
    const auto partner = right.find(number);
    if (partner == right.end() || number >= times.rows().size()) continue;
    const TextRow& row = times.rows()[number];
    const Stamp stamp = times.stamp(row, 0);
    if (!entries.empty() && stamp.seconds <= entries.back().stamp.seconds) {
      throw Error("{}: stamp {} does not come after {}, expected increasing stamps",
                  times.place(row),
                  stamp.text,
                  entries.back().stamp.text);
    }
    entries.push_back({stamp, stamp.seconds, file, partner->second});
  }
  if (entries.empty()) {
    throw Error(
        "{}: no image of image_{} has a partner of its number in image_{} and a row in "
        "times.txt",
        folder.string(),
        cameras.left,
        cameras.right);
  }
  return entries;
}

fs::path poses_file(const fs::path& folder) {
  if (path_exists(folder / "poses.txt")) return folder / "poses.txt";
  std::error_code ignored;
  const fs::path full = fs::canonical(folder, ignored);
  const fs::path file =
      full.parent_path().parent_path() / "poses" / (full.filename().string() + ".txt");
  return path_exists(file) ? file : fs::path();
}

GroundTruth read_poses(const fs::path& file,
                       const std::vector<SequenceEntry>& entries,
                       const Eigen::Vector3d& left) {
  return groundtruth_or_warning([&] {
    GroundTruth truth;
    const Trajectory rows = read_any_trajectory(file).poses;
    for (const SequenceEntry& entry : entries) {
      const std::optional<std::size_t> number =
          parse_number<std::size_t>(entry.color_file.stem().string());
      if (!number || *number >= rows.size()) continue;
      truth.poses.push_back(
          {entry.stamp, rows[*number].T_world_camera * Eigen::Translation3d(left)});
    }
    return truth;
  });
}

}  // namespace

bool is_kitti(const fs::path& folder) {
  return path_exists(folder / "calib.txt") && path_exists(folder / "times.txt") &&
         find_cameras(folder).has_value();
}

SequenceContent open_kitti(const fs::path& folder, const ReadingOptions& /*options*/) {
  const std::optional<CameraPair> cameras = find_cameras(folder);
  if (!cameras) {
    throw Error("{}: no folders image_2 and image_3, or image_0 and image_1, in it",
                folder.string());
  }
  std::vector<SequenceEntry> entries = read_entries(folder, *cameras);
  const fs::path calibration = folder / "calib.txt";
  const Projection left = read_projection(calibration, cameras->left);
  const Projection right = read_projection(calibration, cameras->right);
  const cv::Size size = read_color(entries.front().color_file).mat.size();
  const auto rig = std::make_shared<const StereoRig>(calibration_of(left, right, size, calibration),
                                                     calibration.string());
  SequenceContent content = stereo_content(std::move(entries), rig);
  const fs::path poses = poses_file(folder);
  if (!poses.empty()) {
    content.groundtruth = [poses, entries = content.entries, at = position_of(left)] {
      return read_poses(poses, entries, at);
    };
  }
  return content;
}

}  // namespace stillmap
