// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/system/observer.hpp"

namespace stillmap {

/// Writes the objects of a run, as they were used, as a folder of detections: with filled-in
/// objects, masks by depth, and COCO class names. It includes frames without a pose, not damaged
/// ones.
class ObjectFolder : public Observer {
 public:
  /// Creates the folder. `image` is the size of the images. Throws Error as DetectionsWriter does.
  ObjectFolder(const std::filesystem::path& folder, cv::Size image) : writer_(folder, image) {}

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  /// Writes the list.
  void on_end(const RunResult& /*result*/) override { writer_.finish(); }

 private:
  DetectionsWriter writer_;
};

}  // namespace stillmap
