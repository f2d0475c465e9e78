// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/text_file.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/number_text.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPoseBytes = std::size_t{64} << 10U;
constexpr std::size_t kMaxLogBytes = std::size_t{64} << 20U;
constexpr std::size_t kMatrixNumbers = 16;

// The pose of a 4x4 matrix; nothing where a number is not finite. Throws Error for one that is no
// rigid transform.
std::optional<Eigen::Isometry3d> pose_of(std::span<const double> n, const std::string& place) {
  for (const double number : n) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  Eigen::Matrix3d R;
  R << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  const double off = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (off > 0.01 || R.determinant() < 0) {  // files with few decimals are within 1e-3
    throw Error("{}: no rotation matrix, expected the 16 numbers of a camera-to-world pose", place);
  }
  return make_pose(Eigen::Quaterniond(R), {n[3], n[7], n[11]});
}

std::vector<std::string> left_out_warning(std::size_t frames, const fs::path& place) {
  if (frames == 0) return {};
  return {fmt::format("{}: {} frames without a finite pose are left out", place.string(), frames)};
}

}  // namespace

GroundTruth read_pose_files(const std::vector<SequenceEntry>& entries,
                            const std::function<fs::path(const fs::path&)>& pose_file) {
  return groundtruth_or_warning([&] {
    GroundTruth truth;
    std::size_t left_out = 0;
    for (const SequenceEntry& entry : entries) {
      const fs::path path = pose_file(entry.color_file);
      if (!path_exists(path)) {
        ++left_out;
        continue;
      }
      const std::vector<double> numbers =
          numbers_in(read_text(path, kMaxPoseBytes), path.string(), kMatrixNumbers);
      const std::optional<Eigen::Isometry3d> pose = pose_of(numbers, path.string());
      if (pose) {
        truth.poses.push_back({entry.stamp, *pose});
      } else {
        ++left_out;
      }
    }
    truth.warnings =
        left_out_warning(left_out, pose_file(entries.front().color_file).parent_path());
    return truth;
  });
}

GroundTruth read_pose_log(const fs::path& path, const std::vector<SequenceEntry>& entries) {
  constexpr std::size_t kBlockNumbers = 3 + kMatrixNumbers;
  return groundtruth_or_warning([&] {
    GroundTruth truth;
    const std::vector<double> numbers = numbers_in(read_text(path, kMaxLogBytes), path.string());
    if (numbers.size() % kBlockNumbers != 0) {
      throw Error("{}: {} numbers, expected {} for each frame",
                  path.string(),
                  numbers.size(),
                  kBlockNumbers);
    }
    std::size_t left_out = 0;
    for (std::size_t at = 0; at < numbers.size(); at += kBlockNumbers) {
      const std::span<const double> block(&numbers[at], kBlockNumbers);
      const std::optional<Eigen::Isometry3d> pose = pose_of(block.subspan(3), path.string());
      const bool known = block[0] >= 0 && block[0] < static_cast<double>(entries.size());
      const Stamp stamp = known ? entries[static_cast<std::size_t>(block[0])].stamp : Stamp{};
      const bool later = truth.poses.empty() || truth.poses.back().stamp.seconds < stamp.seconds;
      if (!pose || !known || !later) {
        ++left_out;
      } else {
        truth.poses.push_back({stamp, *pose});
      }
    }
    truth.warnings = left_out_warning(left_out, path);
    return truth;
  });
}

}  // namespace stillmap
