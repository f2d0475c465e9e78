// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "stillmap/io/input_files.hpp"
#include "stillmap/sensor/sequence_content.hpp"

namespace stillmap {

/// Adds all that a command reads of a sequence: a folder in the TUM layout, or the file of a
/// recording. `entries`: the images that its lists name.
inline void add_sequence(InputFiles& inputs,
                         const std::filesystem::path& sequence,
                         std::span<const SequenceEntry> entries = {}) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(sequence, ignored)) return inputs.add(sequence);
  for (const char* name : {"rgb.txt",
                           "depth.txt",
                           "associations.txt",
                           "groundtruth.txt",
                           "camera.yaml",
                           "detections.jsonl",  // a sequence's own folder is none of detections
                           "rgb",
                           "depth",
                           "truth"}) {
    inputs.add(sequence / name);
  }
  std::filesystem::path color, depth;  // folders other than rgb/ and depth/
  for (const SequenceEntry& entry : entries) {
    for (auto [file, known] : {std::pair(&entry.color_file, &color), {&entry.depth_file, &depth}}) {
      const std::filesystem::path folder = file->parent_path();
      if (folder == *known) continue;
      *known = folder;
      inputs.add(folder == sequence ? *file : folder);
    }
  }
}

/// Adds the file of a camera, by the text of the option --camera, which may be a name, too.
inline void add_camera(InputFiles& inputs, const std::string& camera) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(camera, ignored)) inputs.add(camera);
}

/// Adds what a segmenter reads, by the text of the option --segmenter.
inline void add_segmenter(InputFiles& inputs, std::string_view description) {
  constexpr std::string_view kFolder = "detections:", kMasks = "masks:", kNetwork = "onnx:";
  if (description.starts_with(kFolder)) {
    const std::filesystem::path folder = description.substr(kFolder.size());
    inputs.add(folder / "detections.jsonl");
    inputs.add(folder / "masks");
  } else if (description.starts_with(kMasks)) {
    inputs.add(description.substr(kMasks.size()));
  } else if (description.starts_with(kNetwork)) {
    inputs.add(description.substr(kNetwork.size()));
  }
}

}  // namespace stillmap
