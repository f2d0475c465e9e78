// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_live.hpp"

#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "stillmap/concurrency/prefetcher.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/stopwatch.hpp"
#include "stillmap/perception/motion/modes.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/sensor/arriving_stream.hpp"
#include "stillmap/sensor/clocked_stream.hpp"
#include "tooling/pipeline/live_log.hpp"
#include "tooling/pipeline/look_policy.hpp"
#include "tooling/pipeline/object_feed.hpp"
#include "tooling/pipeline/replayed_stream.hpp"

namespace stillmap {
namespace {

std::unique_ptr<ObjectFeed> make_feed(const LiveInput& input) {
  const Segmenter* segmenter = input.options.segmenter;
  if (segmenter == nullptr) return nullptr;
  const std::optional<LiveRecord>& record = input.options.live->record;
  if (record) return std::make_unique<RecordedFeed>(*segmenter, *record);
  return std::make_unique<NetworkFeed>(*segmenter);
}

/// The work on each frame that was not dropped.
class LiveLoop {
 public:
  LiveLoop(const LiveInput& input, System& system, RunLog& log)
      : system_(system),
        log_(log),
        tracker_(input.config.dynamics.object_tracking(), FillRule::kCausal),
        feed_(make_feed(input)),
        looks_(input.config.live,
               dynamics_mode(input.config.dynamics.mode).jumps == JumpRule::kWarpedFrames) {}

  /// Returns the time from the beginning to the pose, ms.
  double process(const FramePtr& frame);
  [[nodiscard]] LiveResult take_result() { return {record_.record(), std::move(report_)}; }

 private:
  [[nodiscard]] ObjectFeedStep look(const FramePtr& frame);

  System& system_;
  RunLog& log_;
  ObjectTracker tracker_;
  std::unique_ptr<ObjectFeed> feed_;
  LookPolicy looks_;
  std::optional<FrameId> last_seen_;  // the last frame whose objects have arrived
  LiveLog record_;
  LiveReport report_;
};

ObjectFeedStep LiveLoop::look(const FramePtr& frame) {
  LiveStep recorded{frame->id, {}, frame->stamp.text};
  ObjectFeedStep step;
  if (feed_) step = feed_->step(frame, {system_.needs_own_objects(), looks_.gap_frames()});
  for (const auto& arrived : step.arrived) recorded.objects_of.push_back(arrived.first->id);
  if (!step.arrived.empty()) last_seen_ = step.arrived.back().first->id;
  report_.looked_at += step.arrived.size();
  if (last_seen_) {
    report_.objects_age_frames.push_back(static_cast<double>(frame->id.value - last_seen_->value));
  }
  record_.push_back(recorded);
  return step;
}

double LiveLoop::process(const FramePtr& frame) {
  Stopwatch preparing;
  ObjectFeedStep step = look(frame);
  MaskOrigin origin = step.looking ? MaskOrigin::kAwaited : MaskOrigin::kCarried;
  std::optional<FrameObjects> own;
  std::vector<FrameObjects> of_earlier;
  for (auto& [seen, detections] : step.arrived) {
    std::optional<FrameObjects> objects =
        tracker_.push({seen->id, std::move(detections), seen->depth});
    STILLMAP_CHECK(objects.has_value());
    if (seen->id == frame->id) {
      own = std::move(objects);
    } else {
      of_earlier.push_back(*std::move(objects));
    }
  }
  if (own || !feed_) origin = MaskOrigin::kOwn;
  FrameObjects objects =
      own ? *std::move(own) : tracker_.carry_to(frame->id, frame->stamp, frame->depth);
  const double prepared_ms = preparing.lap_ms();
  if (feed_) log_.observers().on_stage_time("objects carried", prepared_ms);
  const FrameResult result = system_.process(frame, std::move(objects), origin);
  looks_.observe(result);
  // Only after the pose, for which the caller waits.
  Stopwatch taking;
  for (FrameObjects& earlier : of_earlier) system_.take_objects(std::move(earlier));
  if (!of_earlier.empty()) log_.observers().on_stage_time("own objects", taking.lap_ms());
  return prepared_ms + result.pose_ms;
}

// `camera`: an ArrivingStream or a ClockedStream.
template <class Camera>
void take_frames(Camera& camera, Clock& clock, LiveLoop& loop, RunLog& log, LiveReport& report) {
  while (const std::optional<StreamedFrame> next = camera.next()) {
    if (camera.dropped() > report.dropped) {
      log.observers().on_dropped(camera.dropped() - report.dropped);
    }
    report.dropped = camera.dropped();
    if (const DamagedFrame* const damaged = std::get_if<DamagedFrame>(&*next)) {
      log.skip(*damaged);
      continue;
    }
    const double waited_ms = 1000 * (clock.now_s() - camera.arrival_s());
    report.latency_ms.push_back(waited_ms + loop.process(std::get<FramePtr>(*next)));
  }
}

void run_by_clock(const LiveInput& input, LiveLoop& loop, RunLog& log, LiveReport& report) {
  const LiveOptions& live = *input.options.live;
  STILLMAP_CHECK(live.clock != nullptr);
  report.speed = live.speed;
  if (live.arriving) {
    ArrivingStream camera(input.stream, *live.clock, input.options.probe);
    return take_frames(camera, *live.clock, loop, log, report);
  }
  ClockedStream camera(input.stream, live.speed, *live.clock, input.options.probe);
  take_frames(camera, *live.clock, loop, log, report);
  if (camera.skipped_s() > 0) {
    log.observers().on_warning(
        fmt::format("of pauses of more than a minute between frames, {:.0f} s in all were not "
                    "waited for",
                    camera.skipped_s()));
  }
}

void run_recorded(const LiveInput& input, LiveLoop& loop, RunLog& log, LiveReport& report) {
  ReplayedStream recorded(
      input.stream, *input.options.live->record, input.options.live->record_name);
  // A frame, the time of reading it in ms, and the number of frames dropped before it.
  using Read = std::tuple<FramePtr, double, std::size_t>;
  const auto read = [&]() -> std::optional<Read> {
    begin_work(input.options.probe, Stage::kReading);
    Stopwatch reading;
    const std::optional<StreamedFrame> frame = recorded.next();
    if (!frame) return std::nullopt;
    return Read{std::get<FramePtr>(*frame), reading.lap_ms(), recorded.dropped()};
  };
  Prefetcher<Read> reader(read, input.options.threads > 1 ? 4 : 0);
  while (const std::optional<Read> next = reader.next()) {
    const auto& [frame, reading_ms, dropped] = *next;
    if (dropped > report.dropped) log.observers().on_dropped(dropped - report.dropped);
    report.dropped = dropped;
    log.observers().on_stage_time("reading", reading_ms);
    loop.process(frame);
  }
}

}  // namespace

LiveResult run_live(const LiveInput& input, System& system, RunLog& log) {
  LiveLoop loop(input, system, log);
  LiveReport report;
  if (input.options.live->record) {
    run_recorded(input, loop, log, report);
  } else {
    run_by_clock(input, loop, log, report);
  }
  LiveResult result = loop.take_result();
  report.looked_at = result.report.looked_at;
  report.objects_age_frames = std::move(result.report.objects_age_frames);
  result.report = std::move(report);
  return result;
}

}  // namespace stillmap
