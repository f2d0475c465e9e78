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

/// An object that may be visible in a frame.
struct VisibleObject {
  int id = 0;  ///< in the mask
  std::string class_name;
  PixelBox box;              ///< tight around its pixels
  int pixels = 0;            ///< number of its pixels; 0 is allowed
  double visible_share = 1;  ///< of the object within the image's borders, see share_in_view()
};

/// The true objects of a frame.
struct FrameTruth {
  FrameId frame;
  Stamp stamp;
  ObjectMask mask;  ///< as large as the image; may have ids of objects not listed
  std::vector<VisibleObject> objects;
};

/// The detections of a perfect network: every visible object of a COCO class, with its id, its
/// exact mask and box, and score 1. Objects without a COCO class (a carton) are not detected.
[[nodiscard]] FrameDetections perfect_detections(const FrameTruth& truth);

/// The faults of a network. Lengths in pixels refer to an image 640 wide and scale with the image.
struct DetectionFaultOptions {
  double edge_loss_px = 2.0;    ///< mean width of the rim that masks lack
  double edge_wander_px = 2.5;  ///< greatest deviation of the rim from that mean, outwards, too
  double limb_loss = 0.45;    ///< chance that a mask lacks one of its ends: a leg, an arm, the head
  double leak = 0.4;          ///< chance that a blob of the background is added to a mask
  double box_shift_px = 4.0;  ///< greatest shift of each side of a box
  double miss_rate = 0.065;   ///< share of frames in which an object is missed, at most 0.18
  double min_pixels = 600;    ///< smaller objects are always missed; at 640x480
  double min_visible_share = 0.5;  ///< objects with a smaller visible share are always missed
  /// chance that an object is detected a second time, as a box without mask
  double duplicate_rate = 0.03;
  double false_rate = 0.03;  ///< chance of a false detection
};

/// Turns truth into the detections of an imperfect network: the objects of perfect_detections()
/// with faults. Ids count from 1 in the order of scores and are unrelated to the true ids. A lost
/// limb, a leak or a false object persists for some frames; an object is missed for one to three
/// consecutive frames. The result depends on seed, truth and options alone, so that frames may come
/// in any order. Safe to use from several threads.
class DetectionFaults {
 public:
  explicit DetectionFaults(std::uint32_t seed, const DetectionFaultOptions& options = {});

  [[nodiscard]] FrameDetections apply(const FrameTruth& truth) const;

  /// Whether an object is missed in a frame at random.
  [[nodiscard]] bool overlooked(int id, FrameId frame) const;

 private:
  struct Report;  // a detection in the making
  [[nodiscard]] bool too_hard(const VisibleObject& object, const FrameTruth& truth) const;
  [[nodiscard]] std::vector<Report> reports_of(const VisibleObject& object,
                                               const FrameTruth& truth) const;
  [[nodiscard]] std::vector<Report> false_reports(const FrameTruth& truth) const;
  [[nodiscard]] PixelBox shifted(const PixelBox& box, cv::Size image, std::uint64_t key) const;

  std::uint32_t seed_;
  DetectionFaultOptions options_;
};

}  // namespace stillmap
