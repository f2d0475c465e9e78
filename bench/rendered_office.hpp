// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "simulation/synth/scene_names.hpp"
#include "simulation/synth/sequence.hpp"
#include "simulation/synth/sequence_writer.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/sensor/sequence.hpp"

namespace stillmap {

/// The first frames of `stillmap synth --scene walking_xyz --detections imperfect --assets none`,
/// on disk during the lifetime of the object.
class RenderedOffice {
 public:
  static constexpr std::uint32_t kFrames = 12;

  RenderedOffice()
      : sequence_(Sequence::open(folder_, kAsWritten)),
        detections_(DetectionsFolder::open(
            folder_ / "detections", {sequence_.camera().width_px, sequence_.camera().height_px})) {
    for (std::uint32_t k = 0; k < kFrames; ++k) {
      frames_.push_back(sequence_.read(FrameId(k)));
      found_.push_back(detections_.at(frames_[k]->stamp));
      poses_.push_back(rendered().pose(FrameId(k)));
    }
  }
  RenderedOffice(const RenderedOffice&) = delete;
  RenderedOffice& operator=(const RenderedOffice&) = delete;
  ~RenderedOffice() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  [[nodiscard]] const Sequence& sequence() const { return sequence_; }
  [[nodiscard]] const DetectionsFolder& detections() const { return detections_; }
  [[nodiscard]] const CameraModel& camera() const { return sequence_.camera(); }

  /// The frame at a step of an endless walk forwards and backwards.
  [[nodiscard]] static std::uint32_t at_step(std::uint32_t step) {
    const std::uint32_t at = step % (2 * (kFrames - 1));
    return at < kFrames ? at : 2 * (kFrames - 1) - at;
  }
  /// The same frame with the number and the stamp of the step.
  [[nodiscard]] FramePtr frame(std::uint32_t step) const {
    RgbdFrame frame = *frames_[at_step(step)];
    frame.id = FrameId(step);
    frame.stamp.seconds = step / 30.0;
    return std::make_shared<const RgbdFrame>(std::move(frame));
  }
  [[nodiscard]] FrameDetections found(std::uint32_t step) const {
    FrameDetections found = found_[at_step(step)];
    found.stamp.seconds = step / 30.0;
    return found;
  }
  [[nodiscard]] const Eigen::Isometry3d& T_world_camera(std::uint32_t step) const {
    return poses_[at_step(step)];
  }

 private:
  static const SyntheticSequence& rendered() {
    static const SyntheticSequence kSequence = [] {
      const NamedScene scene = named_scene("walking_xyz");
      SyntheticOptions options;
      options.path = scene.path;
      options.activity = scene.activity;
      options.frames = kFrames;
      options.frames_per_second = 10;
      return SyntheticSequence(options);
    }();
    return kSequence;
  }
  static std::filesystem::path write() {
    std::string name = (std::filesystem::temp_directory_path() / "stillmap_bench_XXXXXX").string();
    STILLMAP_CHECK(::mkdtemp(name.data()) != nullptr);
    write_sequence(rendered(), name, {.threads = 2, .detections = DetectionKind::kImperfect});
    return name;
  }

  // Named: GCC 12 takes the members of a temporary one for uninitialized here.
  inline static const SequenceOptions kAsWritten;

  std::filesystem::path folder_ = write();
  Sequence sequence_;
  DetectionsFolder detections_;
  std::vector<FramePtr> frames_;
  std::vector<FrameDetections> found_;
  std::vector<Eigen::Isometry3d> poses_;
};

/// Written once per program, removed at its end.
[[nodiscard]] inline const RenderedOffice& office() {
  static const RenderedOffice kOffice;
  return kOffice;
}

}  // namespace stillmap
