// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/motion/dynamic_objects.hpp"
#include "stillmap/perception/motion/feature_filter.hpp"
#include "stillmap/perception/motion/motion_state.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"

namespace stillmap {

struct DynamicsConfig {
  std::string mode = "full";
  double feature_margin_px = 4;
  int compare_frames = 20;
  bool fill_boxes = true;
  DynamicObjectsConfig objects;
  ObjectTrackerConfig tracker;
  MotionStateConfig motion;
  FeatureFilterConfig features;

  /// How objects are followed in this mode.
  [[nodiscard]] ObjectTrackerConfig object_tracking() const;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("mode",
          self.mode,
          FieldInfo{"what is done about what moves", "", 0, 0, {"off", "mask", "paper", "full"}});
    visit("feature_margin_px",
          self.feature_margin_px,
          FieldInfo{"features this near to what moves are not used", "px", 0, 50});
    visit("compare_frames",
          self.compare_frames,
          FieldInfo{"full: how long ago depth was that it is compared with; also twice and 4 times",
                    "frames",
                    1,
                    60});
    visit("fill_boxes",
          self.fill_boxes,
          FieldInfo{"take over what a network has missed from the frames before and after"});
    DynamicObjectsConfig::fields(self.objects, visit);
    visit.group("tracker", self.tracker);
    visit.group("motion", self.motion);
    FeatureFilterConfig::fields(self.features, visit);
  }
};

/// What the dynamics stage makes of one frame.
struct FrameDynamics {
  FrameObjects objects;
  DynamicsResult judged;
  std::vector<ObjectMotion> motions;     ///< of `objects`, in their order; empty without a pose
  cv::Mat1b excluded;                    ///< not 0 where no feature may be
  std::vector<FeatureVerdict> verdicts;  ///< of the frame's features, in their order
  std::vector<RejectedFeature> dropped;  ///< features that were found, but are not used
};

/// Says which pixels of each frame must not be taken for the static world, and remembers what it
/// takes to say so of the next.
class DynamicsStage {
 public:
  DynamicsStage(const DynamicsConfig& config, const CameraModel& camera, std::uint32_t seed);

  /// Whether there is anything to do: the mode is not "off".
  [[nodiscard]] bool enabled() const { return objects_.has_value(); }

  /// What a frame alone says of its objects. May be called on any thread at any time.
  [[nodiscard]] MeasuredObjects measure(const RgbdFrame& frame, const FrameObjects& objects) const;

  /// Judges a frame whose pose is only expected; none when nothing is. `measured`: what measure()
  /// says of it.
  [[nodiscard]] FrameDynamics judge(
      const RgbdFrame& frame,
      FrameObjects objects,
      const MeasuredObjects& measured,
      const std::optional<Eigen::Isometry3d>& T_world_camera_expected) const;

  /// Both at once.
  [[nodiscard]] FrameDynamics judge(
      const RgbdFrame& frame,
      FrameObjects objects,
      const std::optional<Eigen::Isometry3d>& T_world_camera_expected) const {
    const MeasuredObjects measured = measure(frame, objects);
    return judge(frame, std::move(objects), measured, T_world_camera_expected);
  }

  /// Of the features off `dynamics.excluded`, those that may be used. The next frame's are compared
  /// with all of them.
  [[nodiscard]] FilteredFeatures filter(
      const RgbdFrame& frame,
      Features features,
      const FrameDynamics& dynamics,
      const std::optional<Eigen::Isometry3d>& T_world_camera_expected);

  /// The frame has a pose now: how its objects move; later frames are compared with it.
  void remember(const RgbdFrame& frame,
                const Eigen::Isometry3d& T_world_camera,
                FrameDynamics& dynamics);

  /// How the objects of a frame that was remembered with other masks move by its own, `dynamics`;
  /// later frames' objects are not known yet.
  void learn_motions(const RgbdFrame& frame,
                     const Eigen::Isometry3d& T_world_camera,
                     FrameDynamics& dynamics) {
    dynamics.motions =
        motions_.update(dynamics.objects, frame.depth, dynamics.judged.states, T_world_camera);
  }

  /// Tracking was lost: the next frame with a pose does not follow on the last. What was seen
  /// before stays known, for it is in the same world: when found again near there, people stand out
  /// at once.
  void forget() {
    last_.reset();
    features_.reset();
    found_again_ = number_;
  }

 private:
  struct PastView {
    DepthImage depth;
    Eigen::Isometry3d T_world_camera;
  };
  struct PastFrame {
    PastView view;
    cv::Mat1b dynamic;
    std::int64_t number;
  };
  [[nodiscard]] std::vector<PreviousDepth> previous(
      const std::optional<Eigen::Isometry3d>& T_world_camera) const;
  [[nodiscard]] const PastFrame* past_frame(std::int64_t frames_ago) const;
  [[nodiscard]] const PastFrame* first_since_lost() const;

  DynamicsConfig config_;
  std::optional<DynamicObjects> objects_;
  MotionStates motions_;
  std::optional<FeatureFilter> filter_;
  std::optional<PastView> last_;
  std::deque<PastFrame> past_;    // some of those before, the newest last
  std::int64_t number_ = 0;       // of frames remembered
  std::int64_t found_again_ = 0;  // number of the first of them since tracking was lost
  FeaturesPtr features_;          // of the last frame, as they were extracted
};

}  // namespace stillmap
