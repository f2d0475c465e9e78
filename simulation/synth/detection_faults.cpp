// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/detection_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/scene/hash_random.hpp"
#include "simulation/synth/mask_faults.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

// Each fault has its own random key, so that none depends on how many numbers others draw.
enum class Fault : std::uint64_t {
  kMissPhase = 1,
  kMiss,
  kLimb,
  kEdge,
  kLeak,
  kBox,
  kScore,
  kDuplicate,
  kFalse,
};

// Consecutive images are nearly equal, so most faults last for this number of frames.
constexpr std::uint32_t kSpellFrames = 5;

// Every object has one chance to be missed in each span of this number of frames. A run of misses
// ends before its span does, so that two never join.
constexpr std::uint32_t kMissSpanFrames = 11;
constexpr int kLongestMiss = 3;
constexpr double kMeanMiss = 2.0;  // of 1 to 3 frames

std::uint64_t fault_key(Fault fault, std::uint32_t seed, int object, std::uint32_t time) {
  const std::uint64_t what =
      (static_cast<std::uint64_t>(fault) << 32U) | static_cast<std::uint32_t>(object);
  return mix_bits(mix_bits((std::uint64_t{seed} << 32U) | time) + what);
}

// The number of a frame's spell; spells of different objects begin at different times.
std::uint32_t spell_of(FrameId frame, int object) {
  return (frame.value + 3U * static_cast<std::uint32_t>(object)) / kSpellFrames;
}

// Independent of the numbers that a stream of the same key gives.
bool happens(std::uint64_t key, double chance) {
  return static_cast<double>(hash_uniform(~key)) < chance;
}

double scale_of(cv::Size image) {
  return image.width / 640.0;
}

bool reported(const VisibleObject& object) {
  return object.pixels > 0 && is_coco_class(object.class_name);
}

// The pixels around a box with `margin` around them, as far as there is image.
cv::Rect room_around(const PixelBox& box, int margin, cv::Size image) {
  const cv::Point first(static_cast<int>(std::floor(box.x0)) - margin,
                        static_cast<int>(std::floor(box.y0)) - margin);
  const cv::Point end(static_cast<int>(std::ceil(box.x1)) + margin,
                      static_cast<int>(std::ceil(box.y1)) + margin);
  return cv::Rect(first, end) & cv::Rect(cv::Point(0, 0), image);
}

FrameDetections without_objects(const FrameTruth& truth) {
  FrameDetections detections;
  detections.stamp = truth.stamp;
  detections.mask.mat = cv::Mat1b(truth.mask.mat.size(), std::uint8_t{0});
  return detections;
}

void drop_empty_mask(FrameDetections& detections) {
  if (cv::countNonZero(detections.mask.mat) == 0) detections.mask = ObjectMask();
}

}  // namespace

FrameDetections perfect_detections(const FrameTruth& truth) {
  FrameDetections detections = without_objects(truth);
  for (const VisibleObject& object : truth.objects) {
    if (!reported(object)) continue;
    detections.objects.push_back({object.id, object.class_name, 1.F, object.box});
    detections.mask.mat.setTo(object.id, truth.mask.mat == object.id);
  }
  drop_empty_mask(detections);
  return detections;
}

struct DetectionFaults::Report {
  DetectedObject object;
  cv::Rect room;   // where the mask lies in the image
  cv::Mat1b mask;  // 255 where the object is detected; may be empty
  cv::Mat1b own;   // 255 where it truly is
};

DetectionFaults::DetectionFaults(std::uint32_t seed, const DetectionFaultOptions& options)
    : seed_(seed), options_(options) {
  STILLMAP_CHECK(options.miss_rate >= 0 && options.miss_rate * kMissSpanFrames <= kMeanMiss);
}

bool DetectionFaults::overlooked(int id, FrameId frame) const {
  const std::uint64_t phase_key = fault_key(Fault::kMissPhase, seed_, id, 0);
  const std::uint32_t time = frame.value + static_cast<std::uint32_t>(phase_key % kMissSpanFrames);
  const std::uint64_t key = fault_key(Fault::kMiss, seed_, id, time / kMissSpanFrames);
  if (!happens(key, options_.miss_rate * kMissSpanFrames / kMeanMiss)) return false;
  HashStream random(key);
  const int length = 1 + random.below(kLongestMiss);
  const int start = random.below(static_cast<int>(kMissSpanFrames) - length);
  const int now = static_cast<int>(time % kMissSpanFrames);
  return now >= start && now < start + length;
}

bool DetectionFaults::too_hard(const VisibleObject& object, const FrameTruth& truth) const {
  const double image_share = truth.mask.mat.size().area() / (640.0 * 480.0);
  return object.pixels < options_.min_pixels * image_share ||
         object.visible_share < options_.min_visible_share || overlooked(object.id, truth.frame);
}

PixelBox DetectionFaults::shifted(const PixelBox& box, cv::Size image, std::uint64_t key) const {
  HashStream random(key);
  const double most = options_.box_shift_px * scale_of(image);
  const auto moved = [&](double side) { return std::round(side + random.uniform(-most, most)); };
  const double x0 = std::clamp(moved(box.x0), 0.0, image.width - 1.0);
  const double y0 = std::clamp(moved(box.y0), 0.0, image.height - 1.0);
  const double x1 = std::clamp(moved(box.x1), x0 + 1.0, static_cast<double>(image.width));
  const double y1 = std::clamp(moved(box.y1), y0 + 1.0, static_cast<double>(image.height));
  return {x0, y0, x1, y1};
}

std::vector<DetectionFaults::Report> DetectionFaults::reports_of(const VisibleObject& object,
                                                                 const FrameTruth& truth) const {
  const cv::Size image = truth.mask.mat.size();
  const double scale = scale_of(image);
  const std::uint32_t now = truth.frame.value;
  const std::uint32_t spell = spell_of(truth.frame, object.id);
  const double longer_side = std::max(object.box.width(), object.box.height());
  Report report;
  report.room = room_around(object.box, static_cast<int>(0.2 * longer_side) + 4, image);
  report.own = truth.mask.mat(report.room) == object.id;
  report.mask = with_wandering_edge(report.own,
                                    options_.edge_loss_px * scale,
                                    options_.edge_wander_px * scale,
                                    fault_key(Fault::kEdge, seed_, object.id, now));
  const std::uint64_t limb = fault_key(Fault::kLimb, seed_, object.id, spell);
  if (happens(limb, options_.limb_loss)) report.mask = with_end_cut_off(report.mask, limb);
  const std::uint64_t leak = fault_key(Fault::kLeak, seed_, object.id, spell);
  if (happens(leak, options_.leak)) report.mask = with_leak(report.mask, leak);

  const std::uint64_t score = fault_key(Fault::kScore, seed_, object.id, now);
  const double sure = 0.55 + 0.3 * std::min(object.visible_share, 1.0) + 0.1 * hash_normal(score);
  report.object = {0,
                   object.class_name,
                   static_cast<float>(std::clamp(sure, 0.3, 0.99)),
                   shifted(object.box, image, fault_key(Fault::kBox, seed_, object.id, now))};
  std::vector<Report> reports = {report};
  const std::uint64_t again = fault_key(Fault::kDuplicate, seed_, object.id, now);
  if (happens(again, options_.duplicate_rate)) {
    const PixelBox& box = object.box;
    const PixelBox part{box.x0, box.y0 + 0.25 * box.height(), box.x1 - 0.1 * box.width(), box.y1};
    const float less_sure = 0.6F * report.object.score;
    reports.push_back({{0, object.class_name, less_sure, shifted(part, image, again)}, {}, {}, {}});
  }
  return reports;
}

std::vector<DetectionFaults::Report> DetectionFaults::false_reports(const FrameTruth& truth) const {
  const std::uint64_t key = fault_key(Fault::kFalse, seed_, 0, spell_of(truth.frame, 0));
  if (!happens(key, options_.false_rate)) return {};
  const cv::Size image = truth.mask.mat.size();
  HashStream random(key);
  const int height = static_cast<int>(image.height * random.uniform(0.08, 0.2));
  const cv::Size size(static_cast<int>(image.width * random.uniform(0.04, 0.1)), height);
  const int top = random.below(image.height - size.height);
  const cv::Point corner(random.below(image.width - size.width), top);
  Report report;
  report.room = cv::Rect(corner, size);
  report.mask = cv::Mat1b(size, std::uint8_t{0});
  report.own = report.mask.clone();
  cv::ellipse(report.mask,
              cv::Point(size.width / 2, size.height / 2),
              cv::Size(size.width / 2, size.height / 2),
              0.0,
              0.0,
              360.0,
              cv::Scalar(255),
              cv::FILLED);
  const PixelBox box{static_cast<double>(corner.x),
                     static_cast<double>(corner.y),
                     static_cast<double>(corner.x + size.width),
                     static_cast<double>(corner.y + size.height)};
  const char* const class_name = random.below(2) == 0 ? "person" : "chair";
  report.object = {0, class_name, static_cast<float>(random.uniform(0.3, 0.5)), box};
  return {report};
}

FrameDetections DetectionFaults::apply(const FrameTruth& truth) const {
  FrameDetections detections = without_objects(truth);
  std::vector<Report> reports = false_reports(truth);
  for (const VisibleObject& object : truth.objects) {
    if (!reported(object) || too_hard(object, truth)) continue;
    for (Report& report : reports_of(object, truth)) reports.push_back(std::move(report));
  }
  // As detectors do; it also hides the true object of an id.
  std::ranges::stable_sort(
      reports, std::greater<>(), [](const Report& report) { return report.object.score; });
  for (std::size_t i = 0; i < reports.size(); ++i) reports[i].object.id = static_cast<int>(i) + 1;
  // True pixels of an object have priority; leaks take the remaining pixels.
  for (const bool own : {true, false}) {
    for (const Report& report : reports) {
      if (report.mask.empty()) continue;
      cv::Mat1b ids = detections.mask.mat(report.room);
      const cv::Mat1b wanted = own ? report.mask & report.own : report.mask & (ids == 0);
      ids.setTo(report.object.id, wanted);
    }
  }
  for (Report& report : reports) detections.objects.push_back(std::move(report.object));
  drop_empty_mask(detections);
  return detections;
}

}  // namespace stillmap
