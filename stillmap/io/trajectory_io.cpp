// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/trajectory_io.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/io/stamp_unit.hpp"
#include "stillmap/io/text_table.hpp"

namespace stillmap {
namespace {

constexpr double kMaxCoordinateM = 1e9;  // beyond it squares and sums lose their precision

StampedPose parse_pose(const TextTable& table, const TextRow& row) {
  const auto n = [&](std::size_t column) { return table.number(row, column); };
  const Eigen::Vector3d t(n(1), n(2), n(3));
  if (t.cwiseAbs().maxCoeff() > kMaxCoordinateM) {
    throw Error("{}: position beyond {} m, expected metres", table.place(row), kMaxCoordinateM);
  }
  Eigen::Vector4d q(n(4), n(5), n(6), n(7));
  // The files of TUM have four decimals, so that norms are 1 to about 2e-4. A coarse bound detects
  // numbers that are no quaternion at all.
  if (q.cwiseAbs().maxCoeff() > 1e6 || q.norm() < 1e-6) {
    throw Error("{}: quaternion of length {:.3g}, expected about 1", table.place(row), q.norm());
  }
  q.normalize();
  Stamp stamp = table.stamp(row, 0);
  stamp.seconds *= seconds_per(stamp_unit_by_size(stamp.seconds), 1);
  return {std::move(stamp), make_pose(Eigen::Quaterniond(q[3], q[0], q[1], q[2]), t)};
}

bool has_gap(const TextRow& row) {
  return std::ranges::any_of(row.columns, [](std::string_view text) {
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    return status == std::errc() && end == text.data() + text.size() && !std::isfinite(value);
  });
}

// Keeps the last of equal stamps.
void sort_by_stamp(Trajectory& poses) {
  const auto seconds = [](const StampedPose& pose) { return pose.stamp.seconds; };
  std::ranges::stable_sort(poses, {}, seconds);
  Trajectory unique;
  unique.reserve(poses.size());
  for (StampedPose& pose : poses) {
    if (!unique.empty() && seconds(unique.back()) == seconds(pose)) unique.pop_back();
    unique.push_back(std::move(pose));
  }
  poses = std::move(unique);
}

PartialTrajectory read_rows(const std::filesystem::path& path, bool gaps_allowed) {
  const TextTable table = TextTable::read(path, "stamp tx ty tz qx qy qz qw");
  PartialTrajectory read;
  read.poses.reserve(table.rows().size());
  for (const TextRow& row : table.rows()) {
    if (gaps_allowed && has_gap(row)) {
      ++read.rows_left_out;
    } else {
      read.poses.push_back(parse_pose(table, row));
    }
  }
  if (read.poses.empty()) throw Error("{}: no poses in the file", path.string());
  sort_by_stamp(read.poses);
  return read;
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path) {
  return read_rows(path, false).poses;
}

PartialTrajectory read_trajectory_with_gaps(const std::filesystem::path& path) {
  return read_rows(path, true);
}

std::string format_trajectory(const Trajectory& trajectory) {
  std::string text;
  text.reserve(trajectory.size() * 100);
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d t = pose.T_world_camera.translation();
    Eigen::Quaterniond q(pose.T_world_camera.linear());
    q.normalize();
    if (q.w() < 0) q.coeffs() *= -1.0;  // chooses one of the two quaternions of a rotation
    fmt::format_to(std::back_inserter(text),
                   "{} {:.7f} {:.7f} {:.7f} {:.7f} {:.7f} {:.7f} {:.7f}\n",
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
