// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/network_segmenter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/segmentation/centernet.hpp"
#include "stillmap/perception/segmentation/class_map.hpp"
#include "stillmap/perception/segmentation/detr.hpp"
#include "stillmap/perception/segmentation/export_readings.hpp"
#include "stillmap/perception/segmentation/matting.hpp"
#include "stillmap/perception/segmentation/nanodet.hpp"
#include "stillmap/perception/segmentation/ssd.hpp"
#include "stillmap/perception/segmentation/yolo.hpp"

namespace stillmap {
namespace {

constexpr double kMaxOverlap = 0.5;  // IoU of two boxes of a class
constexpr double kMaxOverlapOfFinal =
    0.9;  // the same for networks that suppress overlaps themselves
constexpr float kYoloScore = 0.25F;
constexpr float kDetrScore = 0.3F;
constexpr float kSsdScore = 0.4F;
constexpr float kNanoDetScore = 0.35F;
constexpr float kCenterNetScore = 0.28F;

// A missed person does more harm than a false one, and a false one gets no mask.
constexpr float kNanoDetPersonScore = 0.2F;

// People who fill much of the image, mostly cut off by it, have low scores; false boxes of that
// size are rare. Most others of so low a score lie on a person who has a better box.
constexpr float kNanoDetLargePersonScore = 0.12F;
constexpr double kLargeShare = 0.1;  // of the image
constexpr double kMostShared = 0.5;  // with a better box, of the smaller of the two

// Size of the crop relative to a person's box; size of the area in which the mask is kept, relative
// to the box; least share of that area that the mask of a person covers. Chosen on photographs and
// rendered offices.
constexpr double kCropScale = 1.0;
constexpr double kBoxScale = 1.1;
constexpr double kLeastShare = 0.1;

// The detector is trusted without a mask: backs and trunks before the camera often have none.
constexpr float kSurePersonScore = 0.35F;

cv::Size plane_size(const TensorShape& input, bool channels_last) {
  return {static_cast<int>(input[channels_last ? 2 : 3]),
          static_cast<int>(input[channels_last ? 1 : 2])};
}

bool channels_last(const TensorShape& input) {
  return input[1] != 3;
}

// The input format with which networks of a kind are trained.
InputFormat format_of(ExportKind kind, bool last) {
  InputFormat format{.channels_last = last};
  constexpr float kWhole = 1.0F / 255.0F;  // values from 0 to 255
  switch (kind) {
    case ExportKind::kClassMap:  // mean and deviation of ImageNet
      format.mean = {0.485F, 0.456F, 0.406F};
      format.deviation = {0.229F, 0.224F, 0.225F};
      break;
    case ExportKind::kSsd:
    case ExportKind::kCenterNet:
      format.deviation = {kWhole, kWhole, kWhole};
      break;
    case ExportKind::kYoloRows:
    case ExportKind::kYoloColumns:
    case ExportKind::kYoloFinal:
      format.padding = 114;
      break;
    case ExportKind::kDetr:
      break;
    case ExportKind::kNanoDet:
      format.blue_first = true;
      format.mean = {0.406F, 0.456F, 0.485F};
      format.deviation = {0.225F, 0.224F, 0.229F};
      break;
  }
  return format;
}

InputPlacement placement_of(ExportKind kind, cv::Size image, cv::Size input) {
  const bool keeps_shape = kind == ExportKind::kYoloRows || kind == ExportKind::kYoloColumns ||
                           kind == ExportKind::kYoloFinal || kind == ExportKind::kNanoDet;
  return keeps_shape ? InputPlacement::letterbox(image, input)
                     : InputPlacement::stretch(image, input);
}

// The stride at which the cells of a level cover the input.
int stride_of(std::int64_t cells, cv::Size input) {
  const double area = static_cast<double>(input.area());
  return std::max(1, static_cast<int>(std::lround(std::sqrt(area / static_cast<double>(cells)))));
}

bool is_person(const std::vector<std::string>& names, int label) {
  const auto index = static_cast<std::size_t>(label);
  return index < names.size() && coco_name(names[index]) == "person";
}

// The share of the smaller of two boxes that lies in the other.
double shared_part(const PixelBox& a, const PixelBox& b) {
  const double width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const double height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  return width > 0 && height > 0 ? width * height / std::min(a.area(), b.area()) : 0;
}

// Drops people of the lowest scores whose box shares much with that of a better one. Sorted by
// descending score.
void drop_repeated_people(std::vector<Candidate>& candidates,
                          const std::vector<std::string>& names) {
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    const bool weak = candidate.score < kNanoDetPersonScore && is_person(names, candidate.label);
    const bool repeats = weak && std::ranges::any_of(kept, [&](const Candidate& better) {
                           return better.label == candidate.label &&
                                  shared_part(better.box, candidate.box) > kMostShared;
                         });
    if (!repeats) kept.push_back(candidate);
  }
  candidates = std::move(kept);
}

PixelBox scaled(const PixelBox& box, double scale) {
  const double x = box.width() * (scale - 1) / 2, y = box.height() * (scale - 1) / 2;
  return {box.x0 - x, box.y0 - y, box.x1 + x, box.y1 + y};
}

// One image without content, of a batch's shape.
Tensor empty_image(TensorShape shape) {
  shape[0] = 1;
  return {shape, std::vector<float>(static_cast<std::size_t>(element_count(shape)))};
}

}  // namespace

ImageNetwork::ImageNetwork(std::unique_ptr<Network> network, cv::Size image)
    : network_(std::move(network)), image_(image) {
  const TensorShape shape = image_input_shape(network_->signature(), image);
  const bool last = channels_last(shape);
  const cv::Size input = plane_size(shape, last);
  batch_ = shape[0];
  export_ = identify_export(
      network_->signature(), run_on_image(*network_, empty_image(shape), batch_), input);
  placement_ = placement_of(export_.kind, image, input);
  format_ = format_of(export_.kind, last);
}

std::vector<FoundObject> ImageNetwork::find(const ColorImage& color) const {
  STILLMAP_CHECK(color.mat.size() == image_);
  return decode(run_on_image(*network_, make_input(color, placement_, format_), batch_));
}

std::vector<FoundObject> ImageNetwork::decode(const std::vector<Tensor>& outputs) const {
  switch (export_.kind) {
    case ExportKind::kClassMap:
      return decode_map(outputs);
    case ExportKind::kYoloRows:
    case ExportKind::kYoloColumns:
    case ExportKind::kYoloFinal:
      return decode_yolo(outputs);
    case ExportKind::kSsd:
      return decode_ssd_and_map(outputs);
    case ExportKind::kDetr:
    case ExportKind::kNanoDet:
    case ExportKind::kCenterNet:
      return decode_boxes(outputs);
  }
  return {};
}

std::vector<FoundObject> ImageNetwork::decode_map(const std::vector<Tensor>& outputs) const {
  // A real image can reveal what an empty image does not: class numbers without a name.
  const std::string problem = contradiction(export_, outputs);
  if (!problem.empty()) throw Error("the network's output: {}", problem);
  return objects_of_class_map(
      decode_class_map(
          outputs.at(export_.outputs[0]).view(), export_.channels_last, placement_, image_),
      export_.names,
      ComponentOptions());
}

std::vector<FoundObject> ImageNetwork::decode_yolo(const std::vector<Tensor>& outputs) const {
  const YoloOutputs yolo = yolo_outputs(export_, outputs);
  const bool is_final = export_.kind == ExportKind::kYoloFinal;
  const std::vector<Candidate> candidates =
      suppress_overlaps(decode_yolo_boxes(yolo, export_.names.size(), kYoloScore),
                        is_final ? kMaxOverlapOfFinal : kMaxOverlap);
  return yolo_objects(yolo, candidates, export_.names, placement_, image_);
}

std::vector<FoundObject> ImageNetwork::decode_ssd_and_map(
    const std::vector<Tensor>& outputs) const {
  const SsdOutputs ssd{outputs.at(export_.outputs[0]).view(),
                       outputs.at(export_.outputs[1]).view(),
                       outputs.at(export_.outputs[2]).view()};
  const Tensor& map = outputs.at(export_.outputs[3]);
  const std::vector<Candidate> candidates =
      suppress_overlaps(decode_ssd(ssd, placement_.input, kSsdScore), kMaxOverlap);
  const std::vector<std::string> without_background(export_.names.begin() + 1, export_.names.end());
  return with_class_pixels(name_candidates(to_image(candidates, placement_), without_background),
                           decode_class_map(map.view(), export_.channels_last, placement_, image_),
                           export_.names);
}

std::vector<Candidate> ImageNetwork::decode_nanodet_levels(
    const std::vector<Tensor>& outputs) const {
  std::vector<NanoDetLevel> levels;
  for (std::size_t i = 0; i + 1 < export_.outputs.size(); i += 2) {
    const Tensor& scores = outputs.at(export_.outputs[i]);
    levels.push_back({stride_of(scores.shape.at(1), placement_.input),
                      scores.view(),
                      outputs.at(export_.outputs[i + 1]).view()});
  }
  std::vector<Candidate> candidates =
      decode_nanodet(levels, placement_.input, kNanoDetLargePersonScore);
  std::erase_if(candidates, [&](const Candidate& candidate) {
    if (!is_person(export_.names, candidate.label)) return candidate.score < kNanoDetScore;
    const bool large = placement_.to_image(candidate.box).area() >= kLargeShare * image_.area();
    return candidate.score < (large ? kNanoDetLargePersonScore : kNanoDetPersonScore);
  });
  return candidates;
}

std::vector<FoundObject> ImageNetwork::decode_boxes(const std::vector<Tensor>& outputs) const {
  std::vector<Candidate> candidates;
  if (export_.kind == ExportKind::kDetr) {
    candidates = decode_detr(detr_outputs(export_, outputs), placement_.input, kDetrScore);
  } else if (export_.kind == ExportKind::kNanoDet) {
    candidates = decode_nanodet_levels(outputs);
  } else {
    candidates = decode_centernet(outputs.at(export_.outputs[0]).view(),
                                  outputs.at(export_.outputs[1]).view(),
                                  placement_.input,
                                  kCenterNetScore);
  }
  candidates = suppress_overlaps(
      std::move(candidates), export_.kind == ExportKind::kDetr ? kMaxOverlapOfFinal : kMaxOverlap);
  if (export_.kind == ExportKind::kNanoDet) drop_repeated_people(candidates, export_.names);
  return name_candidates(to_image(std::move(candidates), placement_), export_.names);
}

NetworkSegmenter::NetworkSegmenter(std::unique_ptr<Network> network, cv::Size image)
    : image_(image), network_(std::move(network), image) {}

FrameDetections NetworkSegmenter::segment(const ColorImage& color, const Stamp& stamp) const {
  return assemble_detections(stamp, image_, network_.find(color));
}

PersonSegmenter::PersonSegmenter(std::unique_ptr<Network> detector,
                                 std::unique_ptr<Network> matting,
                                 float threshold,
                                 cv::Size image)
    : image_(image),
      detector_(std::move(detector), image),
      matting_(std::move(matting)),
      crop_shape_(image_input_shape(matting_->signature(), image)),
      threshold_(threshold) {}

FrameDetections PersonSegmenter::segment(const ColorImage& color, const Stamp& stamp) const {
  std::vector<FoundObject> objects;
  for (FoundObject& object : detector_.find(color)) {
    if (coco_name(object.class_name) != "person") {
      objects.push_back(std::move(object));
    } else if (std::optional<FoundObject> person = with_mask(std::move(object), color)) {
      objects.push_back(*std::move(person));
    }
  }
  return assemble_detections(stamp, image_, std::move(objects));
}

std::optional<FoundObject> PersonSegmenter::with_mask(FoundObject person,
                                                      const ColorImage& color) const {
  const std::optional<PixelBox> box = clip_box(person.box, image_);
  if (!box) return std::nullopt;
  const bool last = channels_last(crop_shape_);
  const InputPlacement placement =
      InputPlacement::crop(crop_square(*box, kCropScale), plane_size(crop_shape_, last));
  const std::vector<Tensor> outputs = run_on_image(
      *matting_, make_input(color, placement, {.channels_last = last}), crop_shape_[0]);
  if (outputs.empty()) throw Error("a person's mask: the network has no output");
  person.box = scaled(*box, kBoxScale);
  person = with_matting(std::move(person), outputs[0].view(), threshold_, placement, image_);
  person.box = *box;
  person.rough = true;
  if (cv::countNonZero(person.mask) >= kLeastShare * person.region.area()) return person;
  if (person.score < kSurePersonScore) return std::nullopt;
  person.mask.release();
  person.rough = false;
  return person;
}

}  // namespace stillmap
