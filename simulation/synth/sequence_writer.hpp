// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "simulation/synth/sequence.hpp"

namespace stillmap {

/// Which folder of detections to make from the truth.
enum class DetectionKind {
  kNone,
  kPerfect,    ///< the truth itself
  kImperfect,  ///< with a network's faults, see DetectionFaults
};

struct WriteOptions {
  std::size_t threads = 1;  ///< that render, at least 1; the files do not depend on it
  DetectionKind detections = DetectionKind::kNone;
};

/// Writes a sequence in the layout of the TUM RGB-D benchmark, with PNG images, associations.txt,
/// camera.yaml, groundtruth.txt, the folder truth/ and, where asked for, detections/;
/// where assets are used, assets.txt says whose they are.
/// `on_progress`, where given, is called with the number of frames done and of all. Throws Error
/// for a folder that holds something already, and when anything cannot be written; the lists come
/// last, so that a folder with rgb.txt is complete.
void write_sequence(const SyntheticSequence& sequence,
                    const std::filesystem::path& folder,
                    const WriteOptions& options = {},
                    const std::function<void(std::size_t, std::size_t)>& on_progress = nullptr);

}  // namespace stillmap
