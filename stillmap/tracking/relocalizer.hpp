// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "stillmap/core/camera.hpp"
#include "stillmap/core/fields.hpp"
#include "stillmap/map/map.hpp"
#include "stillmap/optim/measurement_model.hpp"
#include "stillmap/place/place_index.hpp"

namespace stillmap {

struct RelocalizerConfig {
  int candidates = 5;
  int iterations = 200;
  int min_inliers = 25;
  int new_world_after_frames = 60;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("candidates",
          self.candidates,
          FieldInfo{"key frames tried in a frame while lost", "", 1, 1000});
    visit("iterations", self.iterations, FieldInfo{"of RANSAC, per key frame", "", 1, 100000});
    visit("min_inliers", self.min_inliers, FieldInfo{"that prove a place", "", 4, 1000});
    visit("new_world_after_frames",
          self.new_world_after_frames,
          FieldInfo{"lost for so long, the camera begins a new map, which joins the others when a "
                    "place is recognised",
                    "frames",
                    1,
                    1000000000});
  }
};

struct Relocalization {
  Eigen::Isometry3d T_camera_world;
  std::vector<std::pair<std::uint32_t, LandmarkId>> matches;  ///< (feature, landmark), inliers
};

/// Finds a frame's pose without knowing where the camera is, by appearance alone.
class Relocalizer {
 public:
  Relocalizer(const RelocalizerConfig& config,
              const CameraModel& camera,
              MeasurementModel measure,
              std::uint32_t seed);

  /// Tries the key frames that look most like the frame, best first. Nothing when none fits.
  /// `places` holds key frames of the map.
  [[nodiscard]] std::optional<Relocalization> find(FrameId frame,
                                                   const Features& features,
                                                   const Map& map,
                                                   const PlaceIndex& places) const;

 private:
  struct Correspondence {
    std::uint32_t feature;
    LandmarkId landmark;
    Eigen::Vector3d p_world;
    Eigen::Vector3d p_camera;  // from the feature's depth
    bool has_depth;
  };

  [[nodiscard]] std::vector<Correspondence> match(const Features& features,
                                                  const Keyframe& keyframe,
                                                  const Map& map) const;
  [[nodiscard]] std::optional<Eigen::Isometry3d> sample_pose(
      FrameId frame, std::span<const Correspondence> matches) const;

  RelocalizerConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  std::uint32_t seed_;
};

}  // namespace stillmap
