// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// Decodes a depth image of an .oni file, in the units of the file, 0 = missing. Codecs are "NONE"
/// (16 bits a pixel), "16zP" (differences to the pixel before) and "16zT" (the same of positions in
/// a table at the beginning). Throws DamagedImage, beginning with `place`, for bytes that do not
/// make `size` pixels, and Error for another codec.
[[nodiscard]] cv::Mat1w decode_oni_depth(std::string_view bytes,
                                         const std::string& codec,
                                         cv::Size size,
                                         const std::string& place);

}  // namespace stillmap
