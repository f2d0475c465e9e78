// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/dynamic_objects.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/motion/interaction.hpp"
#include "stillmap/perception/objects/object_size.hpp"

namespace stillmap {
namespace {

StateReason reason_of(Contact contact) {
  switch (contact) {
    case Contact::kTouching:
      return StateReason::kTouching;
    case Contact::kDepthUnknown:
      return StateReason::kDepthUnknown;
    case Contact::kDepthsApart:
      return StateReason::kDepthsApart;
    case Contact::kBoxesApart:
      break;
  }
  return StateReason::kBoxesApart;
}

/// The mask with the dynamic objects alone.
ObjectMask dynamic_pixels(const FrameObjects& objects,
                          const MaskAreas& areas,
                          const std::vector<ObjectState>& states,
                          cv::Size image) {
  cv::Mat1b result(image, std::uint8_t{0});
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!states[i].dynamic) continue;
    const auto id = static_cast<std::uint8_t>(i + 1);
    const cv::Rect& area = areas[id].bounds;
    for (int row = area.y; row < area.y + area.height; ++row) {
      const std::uint8_t* ids = objects.mask.mat[row];
      std::uint8_t* target = result[row];
      for (int x = area.x; x < area.x + area.width; ++x) {
        target[x] = static_cast<std::uint8_t>(target[x] | (ids[x] == id ? id : 0));
      }
    }
  }
  return ObjectMask(result);
}

}  // namespace

Mask DynamicMask::all() const {
  cv::Mat1b both;
  cv::bitwise_or(extended.mat, jumps.mat, both);
  return Mask(both);
}

Mask DynamicMask::moving(const JumpImage& counted) const {
  cv::Mat1b pixels(extended.mat.size());
  for (int row = 0; row < pixels.rows; ++row) {
    const std::uint8_t *ids = extended.mat[row], *jump = counted.mat[row];
    std::uint8_t* target = pixels[row];
    for (int x = 0; x < pixels.cols; ++x) {
      const bool moves = ids[x] != 0 && !resting[ids[x]];
      target[x] = moves || jump[x] != 0 ? 255 : 0;
    }
  }
  return Mask(pixels);
}

DynamicObjects::DynamicObjects(const DynamicObjectsConfig& config,
                               const CameraModel& camera,
                               const DynamicsMode& mode)
    : config_(config),
      mode_(mode),
      categories_(config.categories),
      camera_(camera),
      warper_(camera) {
  if (mode.extension == ExtensionRule::kBox) config_.extension.variant = "paper";
}

MeasuredObjects DynamicObjects::measure(const DepthImage& depth,
                                        const FrameObjects& objects) const {
  STILLMAP_CHECK(objects.mask.mat.empty() || objects.mask.mat.size() == depth.mat.size());
  MeasuredObjects measured{mask_areas(objects.mask), {}};
  const OutlierRule rule = outlier_rule(config_.extension);
  for (const TrackedObject& object : objects.objects) {
    const int id = object.detection.id;
    STILLMAP_CHECK(id == static_cast<int>(measured.depths.size()) + 1 && id <= 255);
    const MaskArea& area = measured.areas[static_cast<std::size_t>(id)];
    measured.depths.push_back(object_depths(depth, objects.mask, id, area, rule));
  }
  return measured;
}

DynamicsResult DynamicObjects::judge(const DepthImage& depth,
                                     const FrameObjects& objects,
                                     const MeasuredObjects& measured,
                                     std::span<const PreviousDepth> previous,
                                     const KnownMotions& motions) const {
  STILLMAP_CHECK(measured.depths.size() == objects.objects.size());
  DynamicsResult result;
  result.states = judge_states(objects, measured.depths, motions.moving);
  result.mask.resting = resting(result.states, motions.standing);
  result.mask.raw = dynamic_pixels(objects, measured.areas, result.states, depth.mat.size());
  HalfDepth expected, known_static;
  if (mode_.jumps == JumpRule::kWarpedFrames && !previous.empty()) {
    for (const PreviousDepth& earlier : previous) {
      expected =
          filled_from(std::move(expected),
                      warper_.warp(earlier.depth, earlier.T_current_previous, earlier.dynamic));
    }
    // Without that frame's dynamic pixels, an unchanged surface may be one that has not moved yet.
    if (!previous.front().dynamic.empty()) known_static = expected;
  }
  result.mask.extended = mode_.extension == ExtensionRule::kNone || !config_.extension.enabled
                             ? result.mask.raw
                             : extended_mask(depth, objects, measured, result, known_static);
  result.mask.jumps = jumps(depth, previous, expected);
  return result;
}

std::vector<ObjectState> DynamicObjects::judge_states(const FrameObjects& objects,
                                                      const std::vector<ObjectDepths>& depths,
                                                      std::span<const TrackId> moving) const {
  std::vector<ContactParty> people;
  std::vector<TrackId> people_tracks;
  for (std::size_t i = 0; i < objects.objects.size(); ++i) {
    const TrackedObject& object = objects.objects[i];
    if (categories_.of(object.detection.class_name) != Category::kDynamic) continue;
    people.push_back({object.detection.box, depths[i].interval});
    people_tracks.push_back(object.track);
  }
  std::vector<ObjectState> states;
  for (std::size_t i = 0; i < objects.objects.size(); ++i) {
    ObjectState state = state_by_class(objects.objects[i], depths[i]);
    if (state.category == Category::kPotentiallyDynamic && mode_.interaction &&
        config_.interaction.enabled) {
      const Interaction touch = judge_interaction({state.box, state.depths}, people);
      state.reason = reason_of(touch.contact);
      state.dynamic = touch.interacts();
      if (touch.person) state.person = people_tracks[*touch.person];
    }
    const bool moves = std::ranges::find(moving, state.track) != moving.end();
    if (mode_.motion && moves && !state.dynamic) {
      state.reason = StateReason::kMoving;
      state.dynamic = true;
    }
    states.push_back(state);
  }
  return states;
}

// People sway, however long they have been where they are.
std::array<bool, 256> DynamicObjects::resting(const std::vector<ObjectState>& states,
                                              std::span<const TrackId> standing) const {
  std::array<bool, 256> rests{};
  if (!mode_.doubts) return rests;
  for (std::size_t i = 0; i < states.size(); ++i) {
    rests[i + 1] = states[i].category != Category::kDynamic &&
                   std::ranges::find(standing, states[i].track) != standing.end();
  }
  return rests;
}

ObjectState DynamicObjects::state_by_class(const TrackedObject& object,
                                           const ObjectDepths& depths) const {
  ObjectState state;
  state.track = object.track;
  state.class_name = object.detection.class_name;
  state.category = categories_.of(object.detection.class_name);
  state.dynamic = state.category == Category::kDynamic;
  if (state.dynamic) state.reason = StateReason::kDynamicClass;
  if (state.category == Category::kPotentiallyDynamic) state.reason = StateReason::kNotAsked;
  state.box = object.detection.box;
  state.score = object.detection.score;
  state.filled = object.filled.has_value();
  state.depths = depths.interval;
  state.median_depth_m = depths.median_m;
  return state;
}

ObjectMask DynamicObjects::extended_mask(const DepthImage& depth,
                                         const FrameObjects& objects,
                                         const MeasuredObjects& measured,
                                         const DynamicsResult& judged,
                                         const HalfDepth& known_static) const {
  ObjectMask extended(cv::Mat1b(depth.mat.size(), std::uint8_t{0}));
  for (std::size_t i = 0; i < judged.states.size(); ++i) {
    if (!judged.states[i].dynamic) continue;
    const TrackedObject& object = objects.objects[i];
    const int id = object.detection.id;
    // Fan 2020 knows masks from the network alone: Eq. (5) takes the box of any other object.
    const bool box_alone =
        mode_.extension == ExtensionRule::kBox && object.mask_source != MaskSource::kDetected;
    const MaskArea area = box_alone ? MaskArea{} : measured.areas[static_cast<std::size_t>(id)];
    const ObjectView view{depth, objects.mask, id, object.detection.box};
    // A box used as mask cannot be extended: it already holds every pixel. What rests would take
    // the limbs of the person at it that the network cut off.
    PixelPatch patch =
        (object.mask_source == MaskSource::kBox && !box_alone) || judged.mask.resting[i + 1]
            ? mask_patch(view, area)
            : extend_mask(view, area, measured.depths[i], config_.extension, known_static);
    if (outgrows_its_class(object, patch, depth)) patch = mask_patch(view, area);
    paint(extended, patch, static_cast<std::uint8_t>(id));
  }
  return extended;
}

// True when the mask has grown over furniture or a wall. Fan 2020 has no such bound.
bool DynamicObjects::outgrows_its_class(const TrackedObject& object,
                                        const PixelPatch& patch,
                                        const DepthImage& depth) const {
  return mode_.extension == ExtensionRule::kConfigured && config_.extension.bounded &&
         silhouette_m2(patch, depth, camera_) >
             largest_silhouette_m2(coco_name(object.detection.class_name));
}

JumpImage DynamicObjects::jumps(const DepthImage& depth,
                                std::span<const PreviousDepth> previous,
                                const HalfDepth& expected) const {
  if (!previous.empty() && config_.jump.enabled) {
    if (mode_.jumps == JumpRule::kWarpedFrames) return depth_jumps(depth, expected, config_.jump);
    if (mode_.jumps == JumpRule::kPreviousFrame) {
      return depth_jumps(depth, previous.front().depth, config_.jump.paper_jump_m);
    }
  }
  return JumpImage(cv::Mat1b(depth.mat.size(), std::uint8_t{kNoJump}));
}

}  // namespace stillmap
