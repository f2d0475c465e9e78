// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "stillmap/sensor/sequence_content.hpp"
#include "tooling/recordings/stereo_rig.hpp"

namespace stillmap {

/// The content of a recording of stereo pairs: the rectified left images, their depth, camera and
/// noise. `entries` have the left image as `color_file` and the right one as `depth_file`.
[[nodiscard]] SequenceContent stereo_content(std::vector<SequenceEntry> entries,
                                             std::shared_ptr<const StereoRig> rig);

}  // namespace stillmap
