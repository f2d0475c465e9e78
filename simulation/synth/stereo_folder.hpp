// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/synth/sequence.hpp"
#include "stillmap/io/folder_replacement.hpp"

namespace stillmap {

/// The folder mav0/ of a sequence that a second camera records, in the layout of the EuRoC data
/// sets: the camera of the sequence is cam0, and also the body; cam1 is its equal, `baseline_m` to
/// its right. Images are colour.
class StereoFolder {
 public:
  /// Both outlive the object.
  StereoFolder(const SyntheticSequence& sequence,
               const FolderReplacement& result,
               double baseline_m);

  /// Renders and writes the images of both cameras for a frame of the sequence. May be called by
  /// several threads.
  void write_pair(const RgbdFrame& frame) const;
  /// Writes the lists, the calibration and the true poses.
  void write_lists() const;

 private:
  const SyntheticSequence& sequence_;
  const FolderReplacement& result_;
  double baseline_m_;
};

}  // namespace stillmap
