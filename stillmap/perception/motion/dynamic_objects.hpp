// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/motion/depth_jump.hpp"
#include "stillmap/perception/motion/mask_extension.hpp"
#include "stillmap/perception/motion/modes.hpp"
#include "stillmap/perception/objects/categories.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

struct InteractionConfig {
  bool enabled = true;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled",
          self.enabled,
          FieldInfo{"whether an object that a person interacts with is dynamic"});
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

/// The pixels of a frame that must not be taken as static. All of the image's size.
struct DynamicMask {
  ObjectMask raw;       ///< the network's pixels of dynamic objects
  ObjectMask extended;  ///< the same after the extension
  JumpImage jumps;      ///< pixels that suddenly have another depth

  [[nodiscard]] bool covers(int row, int column) const {
    return extended.mat(row, column) != 0 || jumps.mat(row, column) != 0;
  }
  /// Both in one.
  [[nodiscard]] Mask all() const;
};

struct DynamicsResult {
  DynamicMask mask;
  std::vector<ObjectState> states;  ///< in the order of the frame's objects
};

/// The depth of an earlier frame, which shows what has changed since. JumpRule::kPreviousFrame
/// compares with the frame right before, pixel by pixel. For kWarpedFrames a frame from 10 to 20
/// frames before, with its dynamic pixels, is best: a moving object has left its place by then, and
/// what has not changed is known to stand still. Still earlier frames show the surface behind those
/// who were in the way then.
struct PreviousDepth {
  DepthImage depth;
  Eigen::Isometry3d T_current_previous = Eigen::Isometry3d::Identity();
  Mask dynamic = {};  ///< pixels of that frame that were not static
};

/// What a frame alone says of its objects.
struct MeasuredObjects {
  MaskAreas areas;
  std::vector<ObjectDepths> depths;  ///< in the order of the frame's objects
};

/// Judges the objects of a frame and finds the pixels of those that move: Fan 2020, sections III-B
/// and III-C. Keeps nothing between frames; the same input gives the same bits.
class DynamicObjects {
 public:
  /// Throws Error for categories that make no sense.
  DynamicObjects(const DynamicObjectsConfig& config,
                 const CameraModel& camera,
                 const DynamicsMode& mode);

  /// The part of the work that needs nothing of earlier frames.
  [[nodiscard]] MeasuredObjects measure(const DepthImage& depth, const FrameObjects& objects) const;

  /// `measured` is the result of measure() for the same frame. `previous` are earlier frames, the
  /// best first; without any, no pixel has jumped. JumpRule::kPreviousFrame needs one, and no
  /// motion of it. `moving` are the tracks known to move: dynamic where the mode judges by motion.
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
  [[nodiscard]] ObjectMask extended_mask(const DepthImage& depth,
                                         const FrameObjects& objects,
                                         const MeasuredObjects& measured,
                                         const std::vector<ObjectState>& states,
                                         const HalfDepth& known_static) const;
  [[nodiscard]] JumpImage jumps(const DepthImage& depth,
                                std::span<const PreviousDepth> previous,
                                const HalfDepth& expected) const;

  DynamicObjectsConfig config_;
  DynamicsMode mode_;  // its row of the table
  CategoryTable categories_;
  DepthWarper warper_;
};

}  // namespace stillmap
