// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/label_image.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

struct LabelRule {
  std::uint8_t label = 0;
  DepthInterval depths;
};

LabelRule rule_for(const TrackedObject& object, const ObjectState& state, bool rests) {
  // A box used as a mask contains too much around its object.
  const bool known = object.mask_source != MaskSource::kBox && state.depths.has_value();
  if ((state.dynamic && !rests) || !known) return {};
  return {class_label(object.detection.class_name), *state.depths};
}

}  // namespace

std::uint8_t class_label(std::string_view class_name) {
  const std::string name = coco_name(class_name);
  const std::span<const std::string_view> all = coco_class_names();
  const auto found = std::ranges::find(all, name);
  return found == all.end() ? std::uint8_t{0} : static_cast<std::uint8_t>(found - all.begin() + 1);
}

LabelImage label_image(const DepthImage& depth, const FrameDynamics& dynamics) {
  const cv::Mat1b& ids = dynamics.objects.mask.mat;
  if (ids.empty()) return {};
  const std::vector<TrackedObject>& objects = dynamics.objects.objects;
  STILLMAP_CHECK(ids.size() == depth.mat.size());
  STILLMAP_CHECK(dynamics.judged.states.size() == objects.size());
  std::array<LabelRule, 256> rules{};
  for (std::size_t i = 0; i < objects.size() && i + 1 < rules.size(); ++i) {
    rules[i + 1] =
        rule_for(objects[i], dynamics.judged.states[i], dynamics.judged.mask.resting[i + 1]);
  }
  cv::Mat1b labels(ids.size(), std::uint8_t{0});
  for (int row = 0; row < ids.rows; ++row) {
    for (int x = 0; x < ids.cols; ++x) {
      const LabelRule& rule = rules[ids(row, x)];
      if (rule.label != 0 && rule.depths.contains(depth.mat(row, x))) labels(row, x) = rule.label;
    }
  }
  return LabelImage(labels);
}

}  // namespace stillmap
