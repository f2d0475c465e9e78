// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/map_parts.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string_view>

#include <Eigen/LU>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr int kMaxTimes = 1 << 30;

bool is_number(double value) {
  return std::abs(value) <= kMaxCoordinate_m;  // false for NaN
}

bool are_numbers(std::span<const float> values) {
  return std::ranges::all_of(values, [](float v) { return is_number(static_cast<double>(v)); });
}

bool are_numbers(const Eigen::Vector3d& v) {
  return is_number(v.x()) && is_number(v.y()) && is_number(v.z());
}

std::span<const float> flat(const std::vector<Eigen::Vector2f>& points) {
  return points.empty() ? std::span<const float>()
                        : std::span(points.front().data(), 2 * points.size());
}

// Checks parts one by one; `what` names the part.
class PartsCheck {
 public:
  PartsCheck(const MapParts& parts, const std::string& place) : parts_(parts), place_(place) {}

  void check_levels() const {
    const std::vector<float>& scales = parts_.level_scales;
    require(!scales.empty() && scales.size() <= 256 && are_numbers(scales) && scales.front() > 0 &&
                std::ranges::is_sorted(scales),
            "scales of the pyramid's levels");
    require(parts_.next_keyframe.value <= kMaxId && parts_.next_landmark.value <= kMaxId,
            "next ids");
  }

  void check_keyframes() const {
    KeyframeId before;
    std::set<SubmapId> submaps, with_origin;
    for (const Keyframe& keyframe : parts_.keyframes) {
      const std::string what = fmt::format("key frame {}", keyframe.id.value);
      require(follows(keyframe.id, before) && keyframe.id < parts_.next_keyframe, what, "its id");
      before = keyframe.id;
      require(keyframe.submap.value < kMaxId, what, "its submap");
      require(is_rigid(keyframe.T_world_camera), what, "its pose");
      require(is_stamp(keyframe.stamp), what, "its stamp");
      require(keyframe.features != nullptr, what, "its features");
      check_features(*keyframe.features, what);
      submaps.insert(keyframe.submap);
      if (keyframe.is_origin) {
        require(with_origin.insert(keyframe.submap).second, what, "a second origin of its submap");
      }
    }
    require(submaps == with_origin, "submaps: one has no origin");
  }

  void check_dropped() const {
    KeyframeId before;
    for (const auto& [id, anchor] : parts_.dropped_keyframes) {
      const std::string what = fmt::format("dropped key frame {}", id.value);
      require(
          follows(id, before) && id < parts_.next_keyframe && find(id) == nullptr, what, "its id");
      before = id;
      require(is_rigid(anchor.T_anchor_dropped), what, "its pose");
    }
    check_anchors();
  }

  void check_landmarks() const {
    LandmarkId before;
    for (const Landmark& landmark : parts_.landmarks) {
      const auto require_of = [&](bool holds, std::string_view thing) {
        if (!holds) require(false, fmt::format("landmark {}", landmark.id.value), thing);
      };
      require_of(follows(landmark.id, before) && landmark.id < parts_.next_landmark, "its id");
      before = landmark.id;
      require_of(landmark.created_by < parts_.next_keyframe, "the key frame that made it");
      require_of(are_numbers(landmark.p_world), "its position");
      require_of(landmark.viewing_direction.cwiseAbs().maxCoeff() <= 1.000001 &&
                     landmark.viewing_direction.allFinite(),
                 "its viewing direction");
      require_of(landmark.min_distance_m >= 0 &&
                     landmark.min_distance_m <= landmark.max_distance_m &&
                     std::isfinite(landmark.max_distance_m),
                 "its distances");
      require_of(landmark.times_expected >= 0 && landmark.times_expected <= kMaxTimes &&
                     landmark.times_found >= 0 && landmark.times_found <= kMaxTimes,
                 "how often it was seen");
      require_of(are_observations(landmark.observations), "its observations");
    }
  }

 private:
  void require(bool holds, std::string_view what, std::string_view thing = "") const {
    if (holds) return;
    throw Error("{}: invalid {}{}{}", place_, what, thing.empty() ? "" : ": ", thing);
  }

  template <class AnyId>
  static bool follows(AnyId id, AnyId before) {
    return id.valid() && (!before.valid() || before < id);
  }

  [[nodiscard]] const Keyframe* find(KeyframeId id) const {
    const auto at = std::ranges::lower_bound(parts_.keyframes, id, {}, &Keyframe::id);
    return at != parts_.keyframes.end() && at->id == id ? &*at : nullptr;
  }

  void check_features(const Features& features, const std::string& what) const {
    const std::size_t size = features.size();
    require(size <= kMaxFeatures, what, "the number of its features");
    require(features.raw_px.size() == size && features.ideal_px.size() == size &&
                features.sensor_depth_m.size() == size && features.depth_m.size() == size &&
                features.level.size() == size && features.angle_deg.size() == size &&
                features.descriptors.size() == size,
            what,
            "arrays of its features that differ in length");
    require(are_numbers(flat(features.raw_px)) && are_numbers(flat(features.ideal_px)) &&
                are_numbers(flat(features.px)) && are_numbers(features.sensor_depth_m) &&
                are_numbers(features.depth_m) && are_numbers(features.angle_deg),
            what,
            "a feature's pixel, depth or angle");
    require(std::ranges::all_of(features.level,
                                [&](std::uint8_t l) { return l < parts_.level_scales.size(); }),
            what,
            "a feature's level");
  }

  // Every chain of anchors must lead to a key frame: follows each chain and marks its members.
  void check_anchors() const {
    const auto& dropped = parts_.dropped_keyframes;
    std::vector<std::uint8_t> state(dropped.size(),
                                    0);  // 1: on the current chain, 2: leads to a key frame
    std::vector<std::size_t> way;
    for (std::size_t start = 0; start < dropped.size(); ++start) {
      way.clear();
      for (std::size_t i = start; state[i] != 2;) {
        const std::string_view what = "anchor of a dropped key frame";
        require(state[i] == 0, what, "a circle");
        state[i] = 1;
        way.push_back(i);
        const KeyframeId next = dropped[i].second.keyframe;
        if (find(next) != nullptr) break;
        const auto at =
            std::ranges::lower_bound(dropped, next, {}, &std::pair<KeyframeId, Anchor>::first);
        require(at != dropped.end() && at->first == next, what, "an unknown key frame");
        i = static_cast<std::size_t>(at - dropped.begin());
      }
      for (const std::size_t i : way) state[i] = 2;
    }
  }

  [[nodiscard]] bool are_observations(const std::vector<Observation>& observations) const {
    KeyframeId before;
    for (const Observation& observation : observations) {
      if (!follows(observation.keyframe, before)) return false;
      before = observation.keyframe;
      const Keyframe* keyframe = find(observation.keyframe);
      if (keyframe == nullptr || observation.feature >= keyframe->features->size()) return false;
    }
    return !observations.empty();
  }

  const MapParts& parts_;
  const std::string& place_;
};

}  // namespace

bool is_rigid(const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  return are_numbers(T.translation()) && R.allFinite() && R.cwiseAbs().maxCoeff() < 2 &&
         (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
         R.determinant() > 0;
}

bool is_stamp(const Stamp& stamp) {
  return std::isfinite(stamp.seconds) && stamp.text.size() <= 64 &&
         std::ranges::all_of(stamp.text, [](char c) { return c > ' ' && c < '\x7f'; });
}

void check_parts(const MapParts& parts, const std::string& place) {
  const PartsCheck check(parts, place);
  check.check_levels();
  check.check_keyframes();
  check.check_dropped();
  check.check_landmarks();
}

MapParts linked(MapParts parts, const std::string& place) {
  for (Keyframe& keyframe : parts.keyframes) {
    keyframe.landmarks.assign(keyframe.features->size(), LandmarkId{});
  }
  for (const Landmark& landmark : parts.landmarks) {
    for (const Observation& observation : landmark.observations) {
      LandmarkId& seen =
          std::ranges::lower_bound(parts.keyframes, observation.keyframe, {}, &Keyframe::id)
              ->landmarks[observation.feature];
      if (seen.valid()) {
        throw Error(
            "{}: invalid landmarks: feature {} of key frame {} sees two landmarks, {} and {}",
            place,
            observation.feature,
            observation.keyframe.value,
            seen.value,
            landmark.id.value);
      }
      seen = landmark.id;
    }
  }
  return parts;
}

}  // namespace stillmap
