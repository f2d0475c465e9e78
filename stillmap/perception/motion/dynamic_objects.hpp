// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

/// The dynamic pixels of a frame. All images have the frame's size.
struct DynamicMask {
  ObjectMask raw;       ///< masks of dynamic objects from the network
  ObjectMask extended;  ///< the same masks after extension
  JumpImage jumps;      ///< pixels with a depth jump
  /// By id: objects other than people that have stood still since they were first seen. Dynamic
  /// only because somebody is at them, they are static for the pose and the map.
  std::array<bool, 256> resting{};

  [[nodiscard]] bool covers(int row, int column) const {
    return extended.mat(row, column) != 0 || jumps.mat(row, column) != 0;
  }
  /// The union of extended masks and depth jumps.
  [[nodiscard]] Mask all() const;
  /// The same without the masks of the objects that rest.
  [[nodiscard]] Mask moving() const { return moving(jumps); }
  /// The same with other jumps, such as those of them that form areas.
  [[nodiscard]] Mask moving(const JumpImage& counted) const;
};

struct DynamicsResult {
  DynamicMask mask;
  std::vector<ObjectState> states;  ///< in the order of the frame's objects
};

/// The depth of an earlier frame, for comparison. JumpRule::kPreviousFrame compares with the
/// previous frame, pixel by pixel. For kWarpedFrames a frame 10 to 20 frames earlier, with its
/// dynamic pixels, is best: a moving object has left its place by then, and unchanged surface is
/// known to be static. Still earlier frames show the surface behind people who hid it in the later
/// one.
struct PreviousDepth {
  DepthImage depth;
  Eigen::Isometry3d T_current_previous = Eigen::Isometry3d::Identity();
  Mask dynamic = {};  ///< pixels of that frame that were not static
};

/// The tracks of objects whose motion is known.
struct KnownMotions {
  std::span<const TrackId> moving = {};    ///< move now
  std::span<const TrackId> standing = {};  ///< have stood still since they were first seen
};

/// The measurements of a frame's objects that need no other frame.
struct MeasuredObjects {
  MaskAreas areas;
  std::vector<ObjectDepths> depths;  ///< in the order of the frame's objects
};

/// Judges the objects of a frame and finds its dynamic pixels (Fan 2020, sections III-A and III-B).
/// Keeps no state between frames; the same input gives the same bits.
class DynamicObjects {
 public:
  /// Throws Error for invalid categories.
  DynamicObjects(const DynamicObjectsConfig& config,
                 const CameraModel& camera,
                 const DynamicsMode& mode);

  /// The part of the work that needs no earlier frame.
  [[nodiscard]] MeasuredObjects measure(const DepthImage& depth, const FrameObjects& objects) const;

  /// `measured` is the result of measure() for the same frame. `previous` are earlier frames, the
  /// best first; without any there are no depth jumps. JumpRule::kPreviousFrame needs one, without
  /// its pose. Objects that move are dynamic if the mode judges by motion; objects that rest
  /// keep the network's mask.
  [[nodiscard]] DynamicsResult judge(const DepthImage& depth,
                                     const FrameObjects& objects,
                                     const MeasuredObjects& measured,
                                     std::span<const PreviousDepth> previous,
                                     const KnownMotions& motions = {}) const;

  /// measure() and judge() in one call.
  [[nodiscard]] DynamicsResult judge(const DepthImage& depth,
                                     const FrameObjects& objects,
                                     std::span<const PreviousDepth> previous,
                                     const KnownMotions& motions = {}) const {
    return judge(depth, objects, measure(depth, objects), previous, motions);
  }

  [[nodiscard]] const CategoryTable& categories() const { return categories_; }

 private:
  [[nodiscard]] std::vector<ObjectState> judge_states(const FrameObjects& objects,
                                                      const std::vector<ObjectDepths>& depths,
                                                      std::span<const TrackId> moving) const;
  [[nodiscard]] ObjectState state_by_class(const TrackedObject& object,
                                           const ObjectDepths& depths) const;
  [[nodiscard]] std::array<bool, 256> resting(const std::vector<ObjectState>& states,
                                              std::span<const TrackId> standing) const;
  [[nodiscard]] ObjectMask extended_mask(const DepthImage& depth,
                                         const FrameObjects& objects,
                                         const MeasuredObjects& measured,
                                         const DynamicsResult& judged,
                                         const HalfDepth& known_static) const;
  [[nodiscard]] bool outgrows_its_class(const TrackedObject& object,
                                        const PixelPatch& patch,
                                        const DepthImage& depth) const;
  [[nodiscard]] JumpImage jumps(const DepthImage& depth,
                                std::span<const PreviousDepth> previous,
                                const HalfDepth& expected) const;

  DynamicObjectsConfig config_;
  DynamicsMode mode_;  // its row of the table
  CategoryTable categories_;
  CameraModel camera_;
  DepthWarper warper_;
};

}  // namespace stillmap
