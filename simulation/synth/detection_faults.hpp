// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// An object that may be seen in a frame.
struct VisibleObject {
  int id = 0;  ///< in the mask
  std::string class_name;
  PixelBox box;              ///< tight around its pixels
  int pixels = 0;            ///< how many show it; 0 is allowed
  double visible_share = 1;  ///< of the object within the image's borders, see share_in_view()
};

/// What is truly in a frame.
struct FrameTruth {
  FrameId frame;
  Stamp stamp;
  ObjectMask mask;  ///< as large as the image; may have ids of objects not listed
  std::vector<VisibleObject> objects;
};

/// What a network without fault says: every object of a class of COCO that has pixels, with its own
/// id, its very mask and box, score 1. What COCO has no class for (a carton) no network reports.
[[nodiscard]] FrameDetections perfect_detections(const FrameTruth& truth);

/// How badly a network sees. Lengths in pixels are those of an image 640 wide and scale with it.
struct DetectionFaultOptions {
  double edge_loss_px = 2.0;    ///< mean width of what masks lack along their edges
  double edge_wander_px = 2.5;  ///< how far the edge wanders about that mean, outwards too
  double limb_loss = 0.45;    ///< chance that a mask lacks one of its ends: a leg, an arm, the head
  double leak = 0.4;          ///< chance that a blob of the background is added to a mask
  double box_shift_px = 4.0;  ///< at most, of each side of a box
  double miss_rate = 0.065;   ///< share of frames in which an object is overlooked, at most 0.18
  double min_pixels = 600;    ///< smaller objects are always overlooked; for 640x480 pixels
  double min_visible_share = 0.5;  ///< objects with less of them in the image, too
  double duplicate_rate = 0.03;    ///< chance that an object is reported once more, as a mere box
  double false_rate = 0.03;        ///< chance of an object where there is none
};

/// Makes of the truth what an imperfect network would report: the objects of perfect_detections()
/// with the options' faults; ids count from 1 in the order of scores and say nothing of the
/// truth's. A lost limb, a leak or a false object stays for some frames, an object is overlooked
/// for one to three frames in a row. What is reported is a function of seed, truth and options
/// alone: frames may come in any order. Safe to use from several threads.
class DetectionFaults {
 public:
  explicit DetectionFaults(std::uint32_t seed, const DetectionFaultOptions& options = {});

  [[nodiscard]] FrameDetections apply(const FrameTruth& truth) const;

  /// Whether an object is overlooked in a frame for no reason that can be seen.
  [[nodiscard]] bool overlooked(int id, FrameId frame) const;

 private:
  struct Report;  // a detection on its way
  [[nodiscard]] bool too_hard(const VisibleObject& object, const FrameTruth& truth) const;
  [[nodiscard]] std::vector<Report> reports_of(const VisibleObject& object,
                                               const FrameTruth& truth) const;
  [[nodiscard]] std::vector<Report> false_reports(const FrameTruth& truth) const;
  [[nodiscard]] PixelBox shifted(const PixelBox& box, cv::Size image, std::uint64_t key) const;

  std::uint32_t seed_;
  DetectionFaultOptions options_;
};

}  // namespace stillmap
