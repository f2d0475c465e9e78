// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/motion/depth_jump.hpp"
#include "stillmap/perception/motion/mask_extension.hpp"
#include "stillmap/perception/objects/categories.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"

namespace stillmap {

/// How much is done about what moves.
enum class DynamicsMode : std::uint8_t {
  kMask,   ///< what the network's masks of dynamic classes cover
  kPaper,  ///< Fan 2020 to the letter: masks extended in their boxes, interaction, plain jumps
  kFull,   ///< extension as configured, jumps against warped static depth, what is seen to move
};

struct InteractionConfig {
  bool enabled = true;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled, FieldInfo{"what a person is at is taken as dynamic"});
  }
};

struct DynamicObjectsConfig {
  CategoryConfig categories;
  InteractionConfig interaction;
  MaskExtensionConfig extension;
  DepthJumpConfig jump;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.group("categories", self.categories);
    visit.group("interaction", self.interaction);
    visit.group("extension", self.extension);
    visit.group("jump", self.jump);
  }
};

/// Why an object is taken as dynamic or static in a frame.
enum class StateReason : std::uint8_t {
  kStaticClass,   ///< static
  kBoxesApart,    ///< static: nobody near it in the image
  kDepthsApart,   ///< static: somebody before or behind it
  kNotAsked,      ///< static: interaction is not judged
  kDynamicClass,  ///< dynamic: it moves by itself
  kTouching,      ///< dynamic: somebody is at it
  kDepthUnknown,  ///< dynamic: somebody may be at it
  kMoving,        ///< dynamic: it has been seen to move
};
[[nodiscard]] std::string_view reason_name(StateReason reason);

/// What a frame takes an object for.
struct ObjectState {
  TrackId track;
  Category category = Category::kStatic;
  bool dynamic = false;
  StateReason reason = StateReason::kStaticClass;
  std::optional<TrackId> person;  ///< who touches it, or is before or behind it
  PixelBox box;
  bool filled = false;                  ///< the network has missed it
  std::optional<DepthInterval> depths;  ///< of its mask, outliers removed
  float median_depth_m = 0;             ///< of its mask; 0 where nothing is measured
};

/// The pixels of a frame that must not be taken as static. All of the image's size.
struct DynamicMask {
  cv::Mat1b raw;       ///< as the network has it: number of the dynamic object in the frame's list
  cv::Mat1b extended;  ///< the same after the extension
  cv::Mat1b jumps;     ///< DepthJump of pixels that suddenly have another depth

  [[nodiscard]] bool covers(int row, int column) const {
    return extended(row, column) != 0 || jumps(row, column) != 0;
  }
};

struct DynamicsResult {
  DynamicMask mask;
  std::vector<ObjectState> states;  ///< in the order of the frame's objects
};

/// An earlier frame, for what has changed since. kPaper compares with the frame right before, pixel
/// by pixel. For kFull one from 10 to 20 frames before, with its dynamic pixels, is best: what
/// moves has left its place by then, and what has not changed is known to stand still. Still
/// earlier ones tell what is behind those who were in the way then.
struct PreviousDepth {
  DepthImage depth;
  Eigen::Isometry3d T_current_previous = Eigen::Isometry3d::Identity();
  cv::Mat1b dynamic = {};  ///< not 0 where that frame was not static; may be empty
};

/// What a frame alone says of its objects.
struct MeasuredObjects {
  MaskAreas areas;
  std::vector<ObjectDepths> depths;  ///< in the order of the frame's objects
};

/// Judges the objects of a frame and finds the pixels of those that move: sections 2 and 3 of
/// Fan 2020. Keeps nothing between frames; the same input gives the same bits.
class DynamicObjects {
 public:
  /// Throws Error for categories that make no sense.
  DynamicObjects(const DynamicObjectsConfig& config, const CameraModel& camera, DynamicsMode mode);

  /// The part of the work that needs nothing of earlier frames.
  [[nodiscard]] MeasuredObjects measure(const DepthImage& depth, const FrameObjects& objects) const;

  /// `measured`: what measure() says of the same. `previous`: earlier frames, the best first;
  /// without any nothing has jumped. kPaper needs one, and no motion of it. `moving`: tracks known
  /// to move, dynamic in kFull whoever is near.
  [[nodiscard]] DynamicsResult judge(const DepthImage& depth,
                                     const FrameObjects& objects,
                                     const MeasuredObjects& measured,
                                     std::span<const PreviousDepth> previous,
                                     std::span<const TrackId> moving = {}) const;

  /// Both at once.
  [[nodiscard]] DynamicsResult judge(const DepthImage& depth,
                                     const FrameObjects& objects,
                                     std::span<const PreviousDepth> previous,
                                     std::span<const TrackId> moving = {}) const {
    return judge(depth, objects, measure(depth, objects), previous, moving);
  }

  [[nodiscard]] const CategoryTable& categories() const { return categories_; }

 private:
  [[nodiscard]] std::vector<ObjectState> judge_states(const FrameObjects& objects,
                                                      const std::vector<ObjectDepths>& depths,
                                                      std::span<const TrackId> moving) const;
  [[nodiscard]] ObjectState state_by_class(const TrackedObject& object,
                                           const ObjectDepths& depths) const;
  [[nodiscard]] cv::Mat1b extended_mask(const DepthImage& depth,
                                        const FrameObjects& objects,
                                        const MeasuredObjects& measured,
                                        const std::vector<ObjectState>& states,
                                        const cv::Mat1f& known_static) const;
  [[nodiscard]] cv::Mat1b jumps(const DepthImage& depth,
                                std::span<const PreviousDepth> previous,
                                const WarpedDepth& expected) const;

  DynamicObjectsConfig config_;
  DynamicsMode mode_;
  CategoryTable categories_;
  DepthWarper warper_;
};

}  // namespace stillmap
