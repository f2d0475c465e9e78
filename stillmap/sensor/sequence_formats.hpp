// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "stillmap/io/stamp_unit.hpp"
#include "stillmap/sensor/sequence_content.hpp"

namespace stillmap {

/// How a recording is read where it does not tell itself.
struct ReadingOptions {
  double rate_hz = 30;                       ///< of frames that are only counted
  std::optional<StampUnit> stamp_unit = {};  ///< of all stamps; nothing: as they look
  std::string color_topic = {};              ///< of a bag; empty: the one that there is
  std::string depth_topic = {};              ///< of a bag; empty: the one that there is
};

/// A format of recordings: how it is recognised, and what reads it.
struct SequenceFormat {
  std::string_view name;   ///< for --format
  std::string_view looks;  ///< what a recording in it has, for messages
  bool (*recognized)(const std::filesystem::path& path);
  /// Throws Error, with file and line, for what it cannot read.
  SequenceContent (*open)(const std::filesystem::path& path, const ReadingOptions& options);
};

/// The formats that are folders of images. An earlier one is preferred where several fit.
[[nodiscard]] std::span<const SequenceFormat> folder_formats();

/// The format called `name`, or, where that is empty, the first that recognises `path`. Throws
/// Error for an unknown name, a path that does not exist, and one that no format recognises: the
/// text lists what was looked for.
[[nodiscard]] const SequenceFormat& choose_format(const std::filesystem::path& path,
                                                  const std::string& name,
                                                  std::span<const SequenceFormat> formats);

}  // namespace stillmap
