// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/motion/dynamic_objects.hpp"
#include "stillmap/perception/motion/feature_filter.hpp"
#include "stillmap/perception/motion/modes.hpp"
#include "stillmap/perception/motion/motion_estimator.hpp"
#include "stillmap/perception/motion/multi_view.hpp"
#include "stillmap/perception/objects/object_identities.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"

namespace stillmap {

struct DynamicsConfig {
  std::string mode = default_dynamics_mode();
  double feature_margin_px = 4;
  bool search_masks = false;
  int compare_frames = 20;
  bool fill_boxes = true;
  DynamicObjectsConfig objects;
  MultiViewConfig multi_view;
  ObjectTrackerConfig tracker;
  IdentityConfig identity;
  MotionStateConfig motion;
  FeatureFilterConfig features;

  /// The settings of object tracking in this mode.
  [[nodiscard]] ObjectTrackerConfig object_tracking() const;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("mode",
          self.mode,
          common_setting(
              FieldInfo{"treatment of motion; docs/algorithm.md has the stages of each mode",
                        "",
                        0,
                        0,
                        dynamics_mode_names()}));
    visit("feature_margin_px",
          self.feature_margin_px,
          common_setting(
              FieldInfo{"distance that features keep from the pixels that move", "px", 0, 50}));
    visit("search_masks",
          self.search_masks,
          FieldInfo{
              "paper: whether features are looked for on masks, too, judged with the others and "
              "dropped then, as in Fan 2020; else all tracking.features are off the masks"});
    visit("compare_frames",
          self.compare_frames,
          common_setting(FieldInfo{"full: age of the depth that a frame is compared with; twice "
                                   "and four times that age, too",
                                   "frames",
                                   1,
                                   60}));
    visit("fill_boxes",
          self.fill_boxes,
          FieldInfo{"whether an object that the network misses is filled in from the frames before "
                    "and after"});
    DynamicObjectsConfig::fields(self.objects, visit);
    visit.group("multi_view", self.multi_view);
    visit.group("tracker", self.tracker);
    visit.group("identity", self.identity);
    visit.group("motion", self.motion);
    FeatureFilterConfig::fields(self.features, visit);
  }
};

/// The dynamics of one frame: its judged objects and its dynamic pixels.
struct FrameDynamics {
  FrameObjects objects;   ///< with the tracks of the ObjectTracker
  DynamicsResult judged;  ///< `judged.states` in the order of the objects, with lasting tracks
  std::vector<MoverSighting> movers;  ///< people, and what else moves by itself
  /// Pixels that are not static surface for the map: by MaskRule::kWidened `judged.mask` without
  /// objects that have stood still since first seen, and a margin; else `judged.mask`.
  Mask excluded;
  /// Pixels that no feature may have. By MaskRule::kWidened `excluded`; else the extended masks.
  Mask excluded_from_pose;
  /// Pixels on which no feature is looked for: `excluded_from_pose`, or none if filter() drops the
  /// features on it.
  Mask unsearched;
};

/// The excluded pixels on dynamic objects: whether they are static is only doubted.
struct DoubtedPixels {
  Mask others;      ///< all pixels but these
  cv::Mat1f trust;  ///< of each of these
};

/// Finds the pixels and features of each frame that are not static, and remembers the past frames
/// needed for that. Poses are in the odometry frame, which loop corrections do not change.
///
/// This base class is the null stage of a mode that judges nothing: it excludes no pixel and keeps
/// every feature.
class DynamicsStage {
 public:
  DynamicsStage() = default;
  DynamicsStage(const DynamicsStage&) = delete;
  DynamicsStage& operator=(const DynamicsStage&) = delete;
  virtual ~DynamicsStage() = default;

  /// The measurements of the objects that need no other frame. May be called on any thread at any
  /// time.
  [[nodiscard]] virtual MeasuredObjects measure(const RgbdFrame& frame,
                                                const FrameObjects& objects) const;

  /// Judges a frame by its predicted pose; nothing if there is no prediction. `measured` is the
  /// result of measure() for the same frame. The states in the result have lasting tracks.
  [[nodiscard]] virtual FrameDynamics judge(
      const RgbdFrame& frame,
      FrameObjects objects,
      const MeasuredObjects& measured,
      const std::optional<Eigen::Isometry3d>& T_odometry_camera_expected);

  /// The pixels on which further features may be looked for when the others are too few; nothing if
  /// there are none.
  [[nodiscard]] virtual std::optional<DoubtedPixels> doubted(const FrameDynamics& dynamics) const;

  /// The features, which are all off `dynamics.unsearched`, that may be used for the pose.
  /// Remembers those that the next frame is compared with.
  [[nodiscard]] virtual FilteredFeatures filter(
      const RgbdFrame& frame,
      Features features,
      const FrameDynamics& dynamics,
      const std::optional<Eigen::Isometry3d>& T_odometry_camera_expected);

  /// The states of the objects with their motion, for a frame with a pose. To be called with the
  /// objects found in each frame, if any, in the order of the frames; not with carried objects.
  [[nodiscard]] virtual std::vector<ObjectState> with_motion(
      const RgbdFrame& frame,
      const Eigen::Isometry3d& T_odometry_camera,
      const FrameDynamics& dynamics);

  /// Remembers the frame for comparison with later frames.
  virtual void remember(const RgbdFrame& frame,
                        const Eigen::Isometry3d& T_odometry_camera,
                        const FrameDynamics& dynamics);

  /// The tracks of earlier frames that turned out to be of one object, in the order of finding.
  [[nodiscard]] virtual std::vector<UnitedTracks> united_tracks() const { return {}; }

  /// Knows the objects of an earlier run, in the world frame of its map, as ObjectIdentities does.
  virtual void know_objects(std::vector<KnownObject> /*objects*/) {}
  /// Places them when the camera has been found in that map.
  virtual void place_known_objects(const Eigen::Isometry3d& /*T_odometry_world*/,
                                   double /*now_s*/) {}
  /// All objects known, in the world frame.
  [[nodiscard]] virtual std::vector<KnownObject> known_objects(
      const Eigen::Isometry3d& /*T_odometry_world*/) const {
    return {};
  }

  /// Tells the stage that tracking was lost: the next frame with a pose does not continue the last.
  /// Older frames are kept, because they are in the same odometry frame. They show moving people as
  /// soon as the camera is relocalised nearby.
  virtual void forget();
};

/// The stage of `config.mode`. Throws Error for an unknown mode or category.
[[nodiscard]] std::unique_ptr<DynamicsStage> make_dynamics_stage(const DynamicsConfig& config,
                                                                 const CameraModel& camera,
                                                                 std::uint32_t seed);

}  // namespace stillmap
