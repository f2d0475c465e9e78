// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/found_object.hpp"

#include <algorithm>
#include <optional>
#include <ranges>
#include <utility>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMostObjects = 255;

void paint(const FoundObject& object, int id, cv::Mat1b& ids) {
  if (object.mask.empty()) return;
  STILLMAP_CHECK(object.mask.size() == object.region.size());
  STILLMAP_CHECK((object.region & cv::Rect(cv::Point(), ids.size())) == object.region);
  if (object.region.area() > 0) ids(object.region).setTo(id, object.mask);
}

}  // namespace

std::vector<FoundObject> name_candidates(const std::vector<Candidate>& candidates,
                                         const std::vector<std::string>& names) {
  std::vector<FoundObject> objects;
  for (const Candidate& candidate : candidates) {
    const auto label = static_cast<std::size_t>(candidate.label);
    if (label >= names.size()) continue;
    objects.push_back({names[label], candidate.score, candidate.box, cv::Rect(), cv::Mat1b()});
  }
  return objects;
}

FrameDetections assemble_detections(const Stamp& stamp,
                                    cv::Size image,
                                    std::vector<FoundObject> objects) {
  std::ranges::stable_sort(objects, std::ranges::greater(), &FoundObject::score);
  FrameDetections frame{stamp, {}, ObjectMask()};
  std::vector<const FoundObject*> kept;
  for (const FoundObject& object : objects) {
    const std::optional<PixelBox> box = clip_box(object.box, image);
    if (!box || kept.size() == kMostObjects) continue;
    kept.push_back(&object);
    frame.objects.push_back({static_cast<int>(kept.size()),
                             coco_name(object.class_name),
                             std::clamp(object.score, 0.0F, 1.0F),
                             *box,
                             object.rough ? PixelSource::kRoughNetwork : PixelSource::kNetwork});
  }
  cv::Mat1b ids(image, 0);
  for (std::size_t i = kept.size(); i-- > 0;) paint(*kept[i], static_cast<int>(i) + 1, ids);
  if (cv::countNonZero(ids) > 0) frame.mask = ObjectMask(ids);
  return frame;
}

}  // namespace stillmap
