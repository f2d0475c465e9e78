// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/sensor/sequence.hpp"

namespace stillmap {

/// An object with its identity, as the first of its frame unless said otherwise.
[[nodiscard]] inline TrackedObject tracked_object(const std::string& class_name,
                                                  const PixelBox& box,
                                                  int id = 1) {
  return {{id, class_name, 0.9F, box},
          TrackId(static_cast<std::uint32_t>(id)),
          std::nullopt,
          MaskSource::kDetected};
}

/// The truth of a rendered sequence.
class TruthSequence {
 public:
  /// A frame: the position of each object, and the ids that move (people always).
  struct Frame {
    cv::Mat1b ids;
    std::array<bool, 256> dynamic{};
    std::vector<std::pair<int, PixelBox>> boxes;  // of objects in the image, by id
    std::map<int, double> speeds;                 // of the same, m/s
  };

  explicit TruthSequence(const std::filesystem::path& folder)
      : sequence_(Sequence::open(folder)),
        detections_(DetectionsFolder::open(
            folder / "detections", {sequence_.camera().width_px, sequence_.camera().height_px})) {
    std::ifstream file(folder / "truth" / "objects.json");
    const nlohmann::json truth = nlohmann::json::parse(file);
    for (const nlohmann::json& frame : truth.at("frames")) {
      lines_[frame.at("stamp").get<std::string>()] = frame.at("objects");
    }
  }

  [[nodiscard]] const Sequence& sequence() const { return sequence_; }
  [[nodiscard]] cv::Size image() const {
    return {sequence_.camera().width_px, sequence_.camera().height_px};
  }

  [[nodiscard]] FrameDetections detections(std::uint32_t index) const {
    return detections_.at(sequence_.entry(FrameId(index)).stamp);
  }

  [[nodiscard]] Frame truth(std::uint32_t index) const {
    const std::string& stamp = sequence_.entry(FrameId(index)).stamp.text;
    Frame frame;
    frame.ids = read_mask(sequence_.path() / "truth" / "masks" / (stamp + ".png"));
    for (std::size_t id = 1; id < 10; ++id) frame.dynamic[id] = true;
    for (const nlohmann::json& object : lines_.at(stamp)) {
      const int id = object.at("id");
      if (id >= 100) continue;
      if (object.at("moving")) frame.dynamic[static_cast<std::size_t>(id)] = true;
      if (!object.contains("box")) continue;
      const nlohmann::json& b = object.at("box");
      frame.boxes.emplace_back(id, PixelBox{b[0], b[1], b[2], b[3]});
      frame.speeds[id] = object.at("speed");
    }
    return frame;
  }

 private:
  Sequence sequence_;
  DetectionsFolder detections_;
  std::map<std::string, nlohmann::json> lines_;
};

/// The pose at a time, interpolated in a trajectory.
[[nodiscard]] inline Eigen::Isometry3d pose_at(const Trajectory& trajectory, double stamp_s) {
  const auto next = std::ranges::lower_bound(
      trajectory, stamp_s, {}, [](const StampedPose& p) { return p.stamp.seconds; });
  if (next == trajectory.begin()) return next->T_world_camera;
  if (next == trajectory.end()) return trajectory.back().T_world_camera;
  const StampedPose& before = *(next - 1);
  const double share =
      (stamp_s - before.stamp.seconds) / (next->stamp.seconds - before.stamp.seconds);
  return interpolate(before.T_world_camera, next->T_world_camera, share);
}

/// How well a set of pixels covers the moving objects.
struct Coverage {
  double hit = 0, missed = 0, wrong = 0, other = 0;  // pixels

  [[nodiscard]] double iou() const { return hit / (hit + missed + wrong); }
  [[nodiscard]] double recall() const { return hit / (hit + missed); }
  [[nodiscard]] double wrong_share() const { return wrong / (wrong + other); }

  /// `covered` is not 0 where covered.
  void add(const cv::Mat1b& covered, const TruthSequence::Frame& truth) {
    for (int row = 0; row < covered.rows; ++row) {
      for (int x = 0; x < covered.cols; ++x) {
        const bool dynamic = truth.dynamic[truth.ids(row, x)];
        double& count = covered(row, x) != 0 ? (dynamic ? hit : wrong) : (dynamic ? missed : other);
        ++count;
      }
    }
  }
};

}  // namespace stillmap
