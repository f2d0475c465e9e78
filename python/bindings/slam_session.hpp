// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include <pybind11/pybind11.h>

#include "python/bindings/lent_arrays.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/system/system.hpp"

namespace stillmap::python {

struct SlamOptions {
  int threads = 2;
  std::optional<std::filesystem::path> load;  ///< a session to continue
  bool localize_only = false;
};

/// A frame's result with the time that the library took for it, milliseconds.
struct ProcessedFrame {
  FrameResult result;
  double library_ms = 0;
};

/// The arguments of one call of process().
struct FrameArguments {
  pybind11::object color, depth, stamp, objects;
  bool copy = false;
};

/// A System with all that Python's `Slam` needs beside it. Every member takes the GIL with it and
/// releases it around the work; calls from several threads follow each other.
class Slam {
 public:
  Slam(const CameraModel& camera, const Settings& settings, const SlamOptions& options);
  ~Slam();
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  /// Tracks a frame. Objects of None: without a network, or carried from the frames before. Throws
  /// Error for arrays that are no such images, for a stamp that is not later than the last, and
  /// after finish().
  ProcessedFrame process(const FrameArguments& arguments);
  [[nodiscard]] bool needs_objects();
  [[nodiscard]] PointCloud map();
  /// Ends the run; later calls give the same result.
  [[nodiscard]] std::shared_ptr<const RunResult> finish();
  /// Throws Error before finish().
  void save(const std::filesystem::path& file);
  /// The camera with the readout time as learnt so far.
  [[nodiscard]] CameraModel camera();

 private:
  struct Input {
    FramePtr frame;
    std::optional<FrameDetections> detections;
  };
  [[nodiscard]] Input input_of(const FrameArguments& arguments);
  [[nodiscard]] FrameResult process(Input input);
  [[nodiscard]] System& running() const;

  LentArrays lent_;  // outlives the images in system_
  CameraModel camera_;
  Settings settings_;
  bool localize_only_;
  std::mutex mutex_;  // of all below; taken without the GIL
  ObjectTracker tracker_;
  bool has_network_ = false;
  std::uint32_t frames_ = 0;
  std::optional<Stamp> last_stamp_;
  std::unique_ptr<System> system_;           // null after finish()
  std::shared_ptr<const RunResult> result_;  // after finish()
  Session session_;                          // after finish()
};

}  // namespace stillmap::python
