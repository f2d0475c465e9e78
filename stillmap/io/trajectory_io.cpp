// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/trajectory_io.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/parse_number.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/io/stamp_unit.hpp"
#include "stillmap/io/text_table.hpp"

namespace stillmap {
namespace {

StampedPose parse_pose(const TextTable& table, const TextRow& row) {
  const auto n = [&](std::size_t column) { return table.number(row, column); };
  const Eigen::Isometry3d T = checked_pose(
      {n(1), n(2), n(3)}, Eigen::Quaterniond(n(7), n(4), n(5), n(6)), table.place(row));
  Stamp stamp = table.stamp(row, 0);
  stamp.seconds *= seconds_per(stamp_unit_by_size(stamp.seconds), 1);
  return {std::move(stamp), T};
}

bool has_gap(const TextRow& row) {
  return std::ranges::any_of(row.columns, [](std::string_view text) {
    const std::optional<double> value = parse_number<double>(text);
    return value && !std::isfinite(*value);
  });
}

ReadTrajectory read_rows(const std::filesystem::path& path, bool gaps_allowed) {
  const TextTable table = TextTable::read(path, "stamp tx ty tz qx qy qz qw");
  Trajectory poses;
  poses.reserve(table.rows().size());
  std::size_t left_out = 0;
  for (const TextRow& row : table.rows()) {
    if (gaps_allowed && has_gap(row)) {
      ++left_out;
    } else {
      poses.push_back(parse_pose(table, row));
    }
  }
  if (poses.empty()) throw Error("{}: no poses in the file", path.string());
  ReadTrajectory read = sorted_by_stamp(std::move(poses));
  read.rows_left_out = left_out;
  return read;
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path) {
  return read_rows(path, false).poses;
}

ReadTrajectory read_whole_trajectory(const std::filesystem::path& path) {
  return read_rows(path, false);
}

ReadTrajectory read_trajectory_with_gaps(const std::filesystem::path& path) {
  return read_rows(path, true);
}

ReadTrajectory sorted_by_stamp(Trajectory poses) {
  const auto seconds = [](const StampedPose& pose) { return pose.stamp.seconds; };
  std::ranges::stable_sort(poses, {}, seconds);
  ReadTrajectory sorted;
  sorted.poses.reserve(poses.size());
  for (StampedPose& pose : poses) {
    if (!sorted.poses.empty() && seconds(sorted.poses.back()) == seconds(pose)) {
      sorted.poses.pop_back();
      ++sorted.equal_stamps;
    }
    sorted.poses.push_back(std::move(pose));
  }
  return sorted;
}

void check_position(const Eigen::Vector3d& t, const std::string& place) {
  constexpr double kMaxCoordinateM = 1e9;
  if (t.cwiseAbs().maxCoeff() <= kMaxCoordinateM) return;
  throw Error("{}: position beyond {} m, expected metres", place, kMaxCoordinateM);
}

Eigen::Isometry3d checked_pose(const Eigen::Vector3d& t,
                               const Eigen::Quaterniond& q,
                               const std::string& place) {
  check_position(t, place);
  // The files of TUM have four decimals, so that norms are 1 to about 2e-4. A coarse bound detects
  // numbers that are no quaternion at all.
  if (!(q.norm() > 1e-6 && q.norm() < 1e6)) {
    throw Error("{}: quaternion of length {:.3g}, expected about 1", place, q.norm());
  }
  return make_pose(q.normalized(), t);
}

std::string format_trajectory(const Trajectory& trajectory) {
  std::string text;
  text.reserve(trajectory.size() * 100);
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d t = pose.T_world_camera.translation();
    Eigen::Quaterniond q(pose.T_world_camera.linear());
    q.normalize();
    if (q.w() < 0) q.coeffs() *= -1.0;  // chooses one of the two quaternions of a rotation
    text += fmt::format("{} {:.7f} {:.7f} {:.7f} {:.7f} {:.7f} {:.7f} {:.7f}\n",
                        stamp_text(pose.stamp),
                        t.x(),
                        t.y(),
                        t.z(),
                        q.x(),
                        q.y(),
                        q.z(),
                        q.w());
  }
  return text;
}

}  // namespace stillmap
