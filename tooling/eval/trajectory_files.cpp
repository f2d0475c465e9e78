// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/trajectory_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/parse_number.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/text_table.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxTrajectoryBytes = std::size_t{64} << 20U;
constexpr double kKittiFramesPerS = 10;

struct Line {
  std::string_view text;
  std::size_t number = 0;  // in the file, from 1
};

// Calls `visit` for each line with content that is no comment, until it returns false.
template <class Visit>
void for_each_row(std::string_view text, const Visit& visit) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    if (!visit(Line{line.substr(first, line.find_last_not_of(" \t\r") + 1 - first), number}))
      return;
  }
}

std::vector<std::string_view> split_at_commas(std::string_view line) {
  std::vector<std::string_view> columns;
  for (;;) {
    const std::size_t comma = std::min(line.find(','), line.size());
    std::string_view column = line.substr(0, comma);
    const std::size_t first = std::min(column.find_first_not_of(" \t"), column.size());
    column.remove_prefix(first);
    column = column.substr(0, column.find_last_not_of(" \t") + 1);
    columns.push_back(column);
    if (comma == line.size()) return columns;
    line.remove_prefix(comma + 1);
  }
}

std::size_t column_count(std::string_view row) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = row.find_first_not_of(" \t", at)) != std::string_view::npos;) {
    ++count;
    at = std::min(row.find_first_of(" \t", at), row.size());
  }
  return count;
}

template <class Number>
Number number_of(std::string_view text, const std::string& place) {
  const std::optional<Number> value = parse_number<Number>(text);
  bool good = value.has_value();
  if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(*value);
  if (!good) throw Error("{}: '{}', expected a number", place, text.substr(0, 40));
  return *value;
}

StampedPose euroc_pose(const Line& line, const std::string& place) {
  const std::vector<std::string_view> columns = split_at_commas(line.text);
  if (columns.size() < 8) {
    throw Error("{}: {} columns, expected stamp,x,y,z,qw,qx,qy,qz", place, columns.size());
  }
  const auto stamp_ns = number_of<std::uint64_t>(columns[0], place);
  std::array<double, 7> n{};
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = number_of<double>(columns[i + 1], place);
  const Eigen::Isometry3d T =
      checked_pose({n[0], n[1], n[2]}, Eigen::Quaterniond(n[3], n[4], n[5], n[6]), place);
  const Stamp stamp{static_cast<double>(stamp_ns) * 1e-9,
                    fmt::format("{}.{:09}", stamp_ns / 1'000'000'000, stamp_ns % 1'000'000'000)};
  return {stamp, T};
}

ReadTrajectory read_euroc(const std::string& text, const std::string& file) {
  Trajectory poses;
  for_each_row(text, [&](const Line& line) {
    poses.push_back(euroc_pose(line, fmt::format("{}:{}", file, line.number)));
    return true;
  });
  return sorted_by_stamp(std::move(poses));
}

StampedPose kitti_pose(const TextTable& table, const TextRow& row, std::size_t frame) {
  Eigen::Matrix<double, 3, 4> T;
  for (int i = 0; i < 12; ++i) T(i / 4, i % 4) = table.number(row, static_cast<std::size_t>(i));
  check_position(T.col(3), table.place(row));
  const Eigen::Matrix3d R = T.leftCols<3>();
  const double error = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(error < 1e-2 && R.determinant() > 0)) {
    throw Error("{}: no rotation in columns 1-3, 5-7 and 9-11, expected rows of [R t]",
                table.place(row));
  }
  const double seconds = static_cast<double>(frame) / kKittiFramesPerS;
  return {{seconds, fmt::format("{:.1f}", seconds)}, make_pose(Eigen::Quaterniond(R), T.col(3))};
}

Trajectory read_kitti(const std::filesystem::path& path) {
  const TextTable table = TextTable::read(path, "r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz");
  Trajectory poses;
  for (const TextRow& row : table.rows()) poses.push_back(kitti_pose(table, row, poses.size()));
  return poses;
}

}  // namespace

ReadTrajectory read_any_trajectory(const std::filesystem::path& path) {
  const std::string text = read_file(path, kMaxTrajectoryBytes);
  std::string_view first;
  for_each_row(text, [&](const Line& line) {
    first = line.text;
    return false;
  });
  if (first.find(',') != std::string_view::npos) {
    return read_euroc(text, path.string());
  }
  if (column_count(first) == 12) return {read_kitti(path)};
  return read_whole_trajectory(path);
}

}  // namespace stillmap
