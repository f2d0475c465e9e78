// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "simulation/synth/sequence.hpp"

namespace stillmap {

/// The kind of detections that are made from the truth.
enum class DetectionKind {
  kNone,
  kPerfect,    ///< the truth itself
  kImperfect,  ///< the truth with the faults of a network, see DetectionFaults
};

struct WriteOptions {
  std::size_t threads = 1;  ///< number of rendering threads, at least 1; files do not depend on it
  DetectionKind detections = DetectionKind::kNone;
  double stereo_baseline_m = 0;  ///< of a second camera, whose images are in mav0/; 0: none
};

/// Writes a sequence in the layout of the TUM RGB-D benchmark, with PNG images, associations.txt,
/// camera.yaml, groundtruth.txt, the folder truth/ and, on request, detections/ and mav0/ (see
/// StereoFolder). If assets are
/// used, assets.txt credits their authors. `on_progress`, unless empty, is called with the numbers
/// of finished and of all frames. Throws Error for a folder that is not empty, and when writing
/// fails. The sequence appears in the folder all at once, when it is complete.
void write_sequence(const SyntheticSequence& sequence,
                    const std::filesystem::path& folder,
                    const WriteOptions& options = {},
                    const std::function<void(std::size_t, std::size_t)>& on_progress = nullptr);

}  // namespace stillmap
