// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "stillmap/io/png_codec.hpp"

namespace stillmap {

/// The pixels of a sound PNG of the plainest sort: stored as the very kind asked for, not
/// interlaced, no larger than kMaxImageSidePx. Nothing for any other: that is left to libpng, which
/// reads more and says what is wrong. Takes 55 to 85 %
/// of libpng's time.
[[nodiscard]] std::optional<cv::Mat> decode_plain_png(std::string_view bytes, PngKind kind);

}  // namespace stillmap
