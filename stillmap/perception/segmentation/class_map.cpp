// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/class_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::int64_t kMostClasses = 256;

// One float image per class. They share the values of the tensor if these are stored plane by
// plane.
struct ClassPlanes {
  std::vector<cv::Mat1f> planes;
  bool are_labels = false;  // a single plane with class numbers
};

cv::Mat1f copy_plane(const TensorView& output,
                     cv::Size size,
                     std::int64_t offset,
                     std::int64_t step) {
  cv::Mat1f plane(size);
  std::int64_t index = offset;
  for (float& value : plane) {
    value = output.values[static_cast<std::size_t>(index)];
    index += step;
  }
  return plane;
}

ClassPlanes split_planes(const TensorView& output, bool channels_last) {
  const bool are_labels = without_batch(output.shape, 2).size() == 2;
  TensorShape shape = without_batch(output.shape, are_labels ? 2 : 3);
  if (are_labels) shape.insert(shape.begin(), 1);
  if (shape.size() == 3 && channels_last && !are_labels) {
    std::rotate(shape.begin(), shape.begin() + 2, shape.end());
  }
  const bool known = shape.size() == 3 && element_count(shape) > 0 && shape[0] <= kMostClasses &&
                     output.values.size() == static_cast<std::size_t>(element_count(shape));
  if (!known) {
    throw Error("a class map of shape {}: expected 1xCxHxW with at most {} classes C",
                shape_text(output.shape),
                kMostClasses);
  }
  const cv::Size size(static_cast<int>(shape[2]), static_cast<int>(shape[1]));
  const bool interleaved = channels_last && !are_labels;
  ClassPlanes split{{}, are_labels};
  for (std::int64_t c = 0; c < shape[0]; ++c) {
    split.planes.push_back(interleaved ? copy_plane(output, size, c, shape[0])
                                       : copy_plane(output, size, c * size.area(), 1));
  }
  return split;
}

// For each class that occurs a plane that is 1 at the class and 0 elsewhere.
std::vector<cv::Mat1f> indicator_planes(const cv::Mat1f& labels) {
  std::vector<cv::Mat1f> planes(kMostClasses);
  for (auto label = labels.begin(); label != labels.end(); ++label) {
    if (!(*label >= 0 && *label < kMostClasses)) continue;  // no class for this pixel
    cv::Mat1f& plane = planes[static_cast<std::size_t>(*label)];
    if (plane.empty()) plane = cv::Mat1f::zeros(labels.size());
    plane(label.pos()) = 1;
  }
  return planes;
}

// Replaces logits by the probabilities of all classes. Values in [0, 1] that sum to 1 in the first
// pixel count as probabilities already.
void softmax(std::vector<cv::Mat1f>& planes) {
  double sum = 0;
  bool all_in_range = true;
  for (const cv::Mat1f& plane : planes) {
    const float value = plane(0, 0);
    sum += value;
    all_in_range = all_in_range && value >= 0 && value <= 1;
  }
  if (planes.size() > 1 && all_in_range && std::abs(sum - 1) < 1e-3) return;
  const std::size_t pixels = planes.front().total();
  for (std::size_t i = 0; i < pixels; ++i) {
    float largest = planes.front().ptr<float>()[i];
    for (const cv::Mat1f& plane : planes) largest = std::max(largest, plane.ptr<float>()[i]);
    float total = 0;
    for (cv::Mat1f& plane : planes) {
      float& value = plane.ptr<float>()[i];
      value = std::exp(value - largest);
      total += value;
    }
    for (cv::Mat1f& plane : planes) plane.ptr<float>()[i] /= total;
  }
}

// The classes that have the largest value in at least one pixel.
std::vector<bool> winners(const std::vector<cv::Mat1f>& planes) {
  std::vector<bool> wins(planes.size(), false);
  const std::size_t pixels = planes.front().total();
  for (std::size_t i = 0; i < pixels; ++i) {
    std::size_t best = 0;
    for (std::size_t c = 1; c < planes.size(); ++c) {
      if (planes[c].ptr<float>()[i] > planes[best].ptr<float>()[i]) best = c;
    }
    wins[best] = true;
  }
  return wins;
}

std::vector<bool> present(const std::vector<cv::Mat1f>& planes) {
  std::vector<bool> is_there;
  for (const cv::Mat1f& plane : planes) is_there.push_back(!plane.empty());
  return is_there;
}

FoundObject component_object(const ClassMap& map,
                             const cv::Mat1i& components,
                             int component,
                             cv::Rect region) {
  FoundObject object;
  object.region = region;
  object.box = {static_cast<double>(region.x),
                static_cast<double>(region.y),
                static_cast<double>(region.x + region.width),
                static_cast<double>(region.y + region.height)};
  object.mask = components(region) == component;
  object.score = static_cast<float>(cv::mean(map.probability(region), object.mask)[0]);
  return object;
}

}  // namespace

ClassMap decode_class_map(const TensorView& output,
                          bool channels_last,
                          const InputPlacement& placement,
                          cv::Size image) {
  ClassPlanes split = split_planes(output, channels_last);
  const cv::Size plane_size = split.planes.front().size();
  std::vector<cv::Mat1f> planes =
      split.are_labels ? indicator_planes(split.planes.front()) : std::move(split.planes);
  if (!split.are_labels) softmax(planes);
  const std::vector<bool> used = split.are_labels ? present(planes) : winners(planes);
  const InputPlacement onto = placement.onto(plane_size);
  const cv::Rect whole(cv::Point(), image);
  ClassMap map{cv::Mat1b::zeros(image), cv::Mat1f::zeros(image)};
  for (std::size_t c = 0; c < planes.size(); ++c) {
    if (!used[c]) continue;
    const cv::Mat1f value = sample_at_image(planes[c], onto, whole, 0);
    const cv::Mat1b wins = value > map.probability;
    map.labels.setTo(static_cast<int>(c), wins);
    value.copyTo(map.probability, wins);
  }
  return map;
}

std::vector<FoundObject> objects_of_class_map(const ClassMap& map,
                                              const std::vector<std::string>& names,
                                              const ComponentOptions& options) {
  std::array<int, kMostClasses> counts{};
  for (const std::uint8_t label : map.labels) ++counts[label];
  std::vector<FoundObject> objects;
  for (std::size_t c = 1; c < std::min<std::size_t>(names.size(), kMostClasses); ++c) {
    if (counts[c] < options.min_pixels) continue;
    cv::Mat1i components;
    cv::Mat1i statistics;
    cv::Mat1d centres;
    const int count = cv::connectedComponentsWithStats(
        map.labels == static_cast<int>(c), components, statistics, centres, 8);
    for (int i = 1; i < count; ++i) {
      if (statistics(i, cv::CC_STAT_AREA) < options.min_pixels) continue;
      const cv::Rect region(statistics(i, cv::CC_STAT_LEFT),
                            statistics(i, cv::CC_STAT_TOP),
                            statistics(i, cv::CC_STAT_WIDTH),
                            statistics(i, cv::CC_STAT_HEIGHT));
      objects.push_back(component_object(map, components, i, region));
      objects.back().class_name = names[c];
    }
  }
  return objects;
}

std::vector<FoundObject> with_class_pixels(std::vector<FoundObject> objects,
                                           const ClassMap& map,
                                           const std::vector<std::string>& names) {
  for (FoundObject& object : objects) {
    const auto name = std::ranges::find(names, object.class_name);
    if (!object.mask.empty() || name == names.end()) continue;
    object.region = pixels_in(object.box, map.labels.size());
    object.mask = map.labels(object.region) == static_cast<int>(name - names.begin());
  }
  return objects;
}

}  // namespace stillmap
