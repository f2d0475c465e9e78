// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "stillmap/system/observer.hpp"
#include "tooling/pipeline/inpainting.hpp"

namespace stillmap {

/// Writes the frames of a run without what moves in them (Inpainter), as a sequence in the TUM
/// layout: rgb/, depth/, rgb.txt, depth.txt, camera.yaml. Frames without a pose are left out. Poses
/// are those of the time of the frame.
class InpaintedFolder : public Observer {
 public:
  /// Creates the folder. Throws Error if it cannot be made or is not empty.
  InpaintedFolder(const std::filesystem::path& folder, const CameraModel& camera);

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  /// Writes the lists.
  void on_end(const RunResult& result) override;

 private:
  std::filesystem::path folder_;
  CameraModel camera_;
  Inpainter inpainter_;
  std::string rgb_list_, depth_list_;
};

}  // namespace stillmap
