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
  }
};

/// How missed boxes are filled in.
enum class FillRule : std::uint8_t {
  kBothWays,  ///< Fan 2020, section 4 with Eq. (10): from the frames before and after
  kCausal,    ///< from the frames before alone, at the velocity the box had
};

/// Gives objects an identity over frames, and fills in those that the network has missed.
///
/// Boxes of a class are the same object when they overlap where the velocity of its box puts it;
/// best overlap first. The same input gives the same bits. With kBothWays a frame leaves
/// `search_frames` frames after it came, with kCausal at once.
class ObjectTracker {
 public:
  ObjectTracker(const ObjectTrackerConfig& config, FillRule rule);

  /// Takes the next frame, of a later stamp; gives the frame that leaves now, if any. The images
  /// are kept as long as they may be needed, not copied.
  [[nodiscard]] std::optional<FrameObjects> push(ObservedFrame frame);

  /// The end: the frames that have not left, in order. Nothing may be pushed afterwards.
  [[nodiscard]] std::vector<FrameObjects> flush();

  /// What is known of a frame that no network has looked at, later than those pushed: all that they
  /// show of late, each object filled in. With kCausal only.
  [[nodiscard]] FrameObjects carry_to(FrameId frame,
                                      const Stamp& stamp,
                                      const DepthImage& depth) const;

 private:
  struct Track {
    TrackId id;
    std::string class_name;
    PixelBox box;                   // when it was last detected
    PixelBox velocity{0, 0, 0, 0};  // of each side, pixels a second
    double seen_s = 0;              // the stamp of then
    std::size_t seen_at = 0;        // position of that frame in the stream
    int sightings = 0;
  };
  struct Held {
    ObservedFrame frame;
    std::size_t position = 0;     // in the stream
    std::vector<TrackId> tracks;  // of frame.detections.objects
    std::shared_ptr<const MaskAreas> areas;
    bool looked_at = true;  // by a network
  };
  struct Sighting {
    const Held* held = nullptr;
    std::size_t object = 0;
    int distance = 0;  // frames between
  };
  struct Fill {
    PixelBox box;
    BoxOrigin origin;
    Sighting nearest;
  };

  [[nodiscard]] static PixelBox predicted_box(const Track& track, double stamp_s);
  [[nodiscard]] std::vector<TrackId> associate(const ObservedFrame& frame);
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
