// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "stillmap/concurrency/worker.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"
#include "tooling/pipeline/live_record.hpp"

namespace stillmap {

/// The result of an ObjectFeed for one frame.
struct ObjectFeedStep {
  /// Frames whose objects have arrived since the last step, in order.
  std::vector<std::pair<FramePtr, FrameDetections>> arrived;
  bool looking = false;  ///< the network begins work on this frame
};

/// The look that a frame asks for.
struct LookRequest {
  bool needs_own = false;  ///< waits for the objects of this frame, which come last
  int gap_frames = 1;      ///< least number of frames from the last look to one at this frame
};

/// The objects of some frames, which arrive while later frames are processed.
class ObjectFeed {
 public:
  ObjectFeed() = default;
  ObjectFeed(const ObjectFeed&) = delete;
  ObjectFeed& operator=(const ObjectFeed&) = delete;
  virtual ~ObjectFeed() = default;

  /// To be called for each frame that is to be processed, in order. Throws what the network throws.
  [[nodiscard]] virtual ObjectFeedStep step(const FramePtr& frame, const LookRequest& request) = 0;
};

/// A network on a separate thread. It takes a frame whenever it is idle and the gap that the frame
/// asks for has passed since the last frame that it took.
class NetworkFeed : public ObjectFeed {
 public:
  /// `segmenter` outlives the object.
  explicit NetworkFeed(const Segmenter& segmenter) : segmenter_(segmenter) {}

  [[nodiscard]] ObjectFeedStep step(const FramePtr& frame, const LookRequest& request) override;

 private:
  struct Look {
    FramePtr frame;
    std::future<FrameDetections> detections;
  };
  void look_at(const FramePtr& frame);
  [[nodiscard]] std::pair<FramePtr, FrameDetections> finish_look();

  const Segmenter& segmenter_;
  std::optional<FrameId> last_;
  std::optional<Look> look_;
  // Low priority: tracking goes first. The last member, because its thread uses all others.
  Worker worker_{Worker::Priority::kLow};
};

/// Gives the objects of the same frames at the same steps as in a recorded run.
class RecordedFeed : public ObjectFeed {
 public:
  /// `segmenter` outlives the object.
  RecordedFeed(const Segmenter& segmenter, LiveRecord record);

  /// The frames must be those of the record. Throws Error where the record has no objects of a
  /// frame that needs its own.
  [[nodiscard]] ObjectFeedStep step(const FramePtr& frame, const LookRequest& request) override;

 private:
  const Segmenter& segmenter_;
  LiveRecord record_;
  std::set<FrameId> looked_at_;
  std::map<FrameId, FramePtr> held_;
  std::size_t next_ = 0;
};

}  // namespace stillmap
