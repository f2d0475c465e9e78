// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <opencv2/core/mat.hpp>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The pinhole camera of a JSON file with `width`, `height` and `intrinsic_matrix` (nine numbers,
/// column by column, as Open3D writes), and optionally `depth_scale` (default 1000); nothing for
/// JSON without `intrinsic_matrix`. Throws Error, naming the file and the key, for anything else.
[[nodiscard]] std::optional<CameraModel> read_intrinsic_json(const std::filesystem::path& path);

/// The pinhole camera of a text file with a 3x3 or 4x4 matrix, row by row, for images of `size`.
/// Throws Error, naming the file, for anything else.
[[nodiscard]] CameraModel read_intrinsic_text(const std::filesystem::path& path, cv::Size size);

}  // namespace stillmap
