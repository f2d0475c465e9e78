// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace stillmap {

/// A part of a sequence: the frames in [begin, end) in steps of `stride`, counted from 0.
struct FrameSelection {
  std::size_t begin = 0;
  std::optional<std::size_t> end;  ///< nullopt: to the last frame
  std::size_t stride = 1;          ///< at least 1
};

/// Reads "A:B", "A:" or ":B" with A < B, counted from 0, B left out. For any other text throws
/// Error that begins with `text`.
[[nodiscard]] FrameSelection parse_frames(const std::string& text);

}  // namespace stillmap
