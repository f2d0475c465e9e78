// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/perception/objects/mask_propagation.hpp"

namespace stillmap {

struct ObjectTrackerConfig {
  int search_frames = 3;
  double min_iou = 0.2;
  double velocity_gain = 0.5;
  double duplicate_iou = 0.5;
  int min_sightings = 2;
  double carry_depth_margin_m = 0.15;
  bool masks_from_depth = true;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("search_frames",
          self.search_frames,
          FieldInfo{"number of frames searched each way for a missed box (3 in Fan 2020)",
                    "frames",
                    0,
                    30});
    visit("min_iou",
          self.min_iou,
          FieldInfo{"least overlap (IoU) of a box with its track's predicted box", "", 0.01, 1});
    visit("velocity_gain",
          self.velocity_gain,
          FieldInfo{"weight of the newest box in the velocity of its track", "", 0, 1});
    visit("duplicate_iou",
          self.duplicate_iou,
          FieldInfo{"overlap (IoU) with a detection of the same class above which a missed box is "
                    "not filled in",
                    "",
                    0,
                    1});
    visit(
        "min_sightings",
        self.min_sightings,
        FieldInfo{
            "number of detections that a track needs to be filled in (1 in Fan 2020)", "", 1, 10});
    visit("carry_depth_margin_m",
          self.carry_depth_margin_m,
          FieldInfo{"change of depth that a propagated mask allows its object", "m", 0, 10});
    visit("masks_from_depth",
          self.masks_from_depth,
          FieldInfo{
              "whether an object of which the network gives the box alone gets a mask by depth"});
  }
};

/// The frames from which missed boxes are filled in.
enum class FillRule : std::uint8_t {
  kBothWays,  ///< frames before and after (Fan 2020, section III-C, Eq. (10))
  kCausal,    ///< frames before only, with the velocity of the box
};

/// Tracks objects over frames and fills in objects that the network missed (Fan 2020, section
/// III-C).
///
/// Objects for which the network gives only a box get a mask by depth (mask_from_depth()).
///
/// A detection continues a track of its class when its box overlaps with the predicted box of the
/// track; the best overlaps are taken first. The same input gives the same bits. With kBothWays a
/// frame is returned `search_frames` frames after it was pushed, with kCausal at once.
class ObjectTracker {
 public:
  /// The input of object tracking for one frame.
  struct Observation {
    FrameId id;
    FrameDetections detections;
    DepthImage depth;  ///< as large as the mask
  };

  ObjectTracker(const ObjectTrackerConfig& config, FillRule rule);

  /// Takes the next frame, with a later stamp, and returns the frame that is complete now, if any.
  /// Images are kept as long as needed, without copying.
  [[nodiscard]] std::optional<FrameObjects> push(Observation frame);

  /// Ends the stream: returns the remaining frames in order. Nothing may be pushed afterwards.
  [[nodiscard]] std::vector<FrameObjects> flush();

  /// The objects of a frame that the network did not see, later than all pushed frames: the recent
  /// objects of the pushed frames, each filled in. With kCausal only.
  [[nodiscard]] FrameObjects carry_to(FrameId frame,
                                      const Stamp& stamp,
                                      const DepthImage& depth) const;

 private:
  struct Track {
    TrackId id;
    std::string class_name;
    PixelBox box;                   // of its last detection
    PixelBox velocity{0, 0, 0, 0};  // of each side, pixels per second
    double seen_s = 0;              // stamp of its last detection
    std::optional<float> depth_m;   // median of its mask then
    std::size_t seen_at = 0;        // position of that frame in the stream
    int sightings = 0;
  };
  struct Held {
    Observation frame;
    std::size_t position = 0;     // in the stream
    std::vector<TrackId> tracks;  // of frame.detections.objects
    std::vector<MaskSource> sources;
    std::shared_ptr<const MaskAreas> areas;
    bool looked_at = true;  // by a network
  };
  struct Sighting {
    const Held* held = nullptr;
    std::size_t object = 0;
    int distance = 0;  // number of frames in between
  };
  struct Fill {
    PixelBox box;
    BoxOrigin origin;
    Sighting nearest;
  };

  [[nodiscard]] static PixelBox predicted_box(const Track& track, double stamp_s);
  [[nodiscard]] std::vector<TrackId> associate(const Observation& frame);
  [[nodiscard]] std::vector<MaskSource> complete(Observation& frame,
                                                 const std::vector<TrackId>& tracks) const;
  void remember_depths(const Held& held);
  void see(Track& track, const DetectedObject& object, double stamp_s) const;
  [[nodiscard]] FrameObjects leave(const Held& held) const;
  [[nodiscard]] bool is_real(const Track& track, const Held& held) const;
  [[nodiscard]] std::optional<Fill> fill_of(const Track& track, const Held& held) const;
  [[nodiscard]] std::optional<Sighting> sighting(const Track& track,
                                                 const Held& held,
                                                 int direction) const;
  [[nodiscard]] bool is_duplicate(const Track& track, const Fill& fill, const Held& held) const;
  [[nodiscard]] PropagatedMask carried_mask(const Fill& fill, const Held& held) const;

  ObjectTrackerConfig config_;
  FillRule rule_;
  std::deque<Held> held_;      // the frames that may be needed, oldest first
  std::vector<Track> tracks_;  // seen not long ago, by id
  std::size_t pushed_ = 0;
  std::size_t left_ = 0;
  std::uint32_t next_track_ = 0;
};

}  // namespace stillmap
