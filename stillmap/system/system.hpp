// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/system/observer.hpp"
#include "stillmap/system/results.hpp"
#include "stillmap/system/settings.hpp"

/// The library.
namespace stillmap {

class Map;
enum class Stage;
struct PreparedFrame;
struct Session;

/// Options of a System beside its settings.
struct SystemOptions {
  /// 1: all work is done inside the calls. 2 or more: mapping, dense map and loops run beside the
  /// caller, and the map is assembled on that many threads. The results are the same bits.
  int threads = 1;
  bool localize_only = false;  ///< the map stays as it is
  /// Observers are given the dense map so far each time this number of frames has been processed;
  /// 0: only at the end.
  std::int64_t snapshot_every_frames = 0;
  std::vector<Observer*> observers = {};  ///< not owned; they outlive the System
  std::function<void(Stage)> probe = {};  ///< concurrency/stage_probe.hpp; for tests
};

/// The SLAM system: owns the map and every stage.
///
/// Frames go in one after another, in the order of their stamps, from one thread; each comes back
/// with its pose. World coordinates are those of the first tracked camera: x right, y down, z
/// forward, metres.
///
///   System slam({}, builtin_camera("tum_fr1"), {.threads = 2});
///   FrameResult result = slam.process(make_frame(stamp, color, depth));
///   RunResult run = slam.finish();
class System {
 public:
  /// Throws Error for settings that contradict each other.
  System(const Settings& settings, const CameraModel& camera, const SystemOptions& options = {});
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Tracks a frame of the camera's size. `objects` are those that a network has found in it
  /// (ObjectFinder gives them). Only a frame with objects found in it (MaskOrigin::kOwn) may become
  /// a key frame, begin a map or add to the dense map.
  FrameResult process(const RgbdFrame& frame, FrameObjects objects = {});
  /// The same for a frame that the caller shares. `origin` says from which frame `objects` come.
  FrameResult process(const FramePtr& frame,
                      FrameObjects objects = {},
                      MaskOrigin origin = MaskOrigin::kOwn);

  /// The part of process() that needs no other frame. May be called on any thread while earlier
  /// frames are processed.
  [[nodiscard]] PreparedFrame prepare(FramePtr frame, FrameObjects objects) const;
  /// The rest of process() for a frame that prepare() has prepared.
  FrameResult process(PreparedFrame prepared, MaskOrigin origin = MaskOrigin::kOwn);

  /// Takes the objects found in a frame that was processed as kAwaited, in the order of the frames.
  /// The frame may now become a key frame, with the features off their masks, and add to the dense
  /// map. Nothing happens when it had no pose, or when a later frame's objects were taken before.
  void take_objects(FrameObjects objects);
  /// Whether the next frame may begin a map, for want of one to track in: it needs objects of kOwn.
  [[nodiscard]] bool needs_own_objects() const;

  /// The dense map so far: the bits that finish() would give now. The call does not change the run.
  /// Takes seconds for a large map.
  [[nodiscard]] PointCloud map_snapshot() const;

  /// Ends the run: waits for pending work and makes the map. Call once.
  [[nodiscard]] RunResult finish();
  /// The map with the frames at other poses, given in the order of RunResult::trajectory; frames
  /// without a pose add nothing to it. Only after finish().
  [[nodiscard]] PointCloud map_with_poses(
      std::span<const std::optional<Eigen::Isometry3d>> T_world_frames) const;

  /// Continues a saved session (session/session_io.hpp) once the camera sees a place known to it.
  /// Only before the first frame. Throws Error when the session is of another camera or of another
  /// image pyramid.
  void load(Session session);
  /// The session to be saved. Only after finish(); no other member may be called then.
  [[nodiscard]] Session take_session();

  /// The sparse map: key frames and landmarks.
  [[nodiscard]] const Map& map() const;
  /// Readout time of the camera's rolling shutter, seconds, as learnt so far.
  [[nodiscard]] double readout_s() const;
  /// How much later than their stamps depth images are taken, seconds, as learnt so far.
  [[nodiscard]] double depth_delay_s() const;

 private:
  struct Stages;
  std::unique_ptr<Stages> stages_;
};

}  // namespace stillmap
