// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/class_names.hpp"

#include <algorithm>
#include <array>

namespace stillmap {
namespace {

constexpr std::array<std::string_view, 80> kCoco = {
    "person",        "bicycle",      "car",
    "motorcycle",    "airplane",     "bus",
    "train",         "truck",        "boat",
    "traffic light", "fire hydrant", "stop sign",
    "parking meter", "bench",        "bird",
    "cat",           "dog",          "horse",
    "sheep",         "cow",          "elephant",
    "bear",          "zebra",        "giraffe",
    "backpack",      "umbrella",     "handbag",
    "tie",           "suitcase",     "frisbee",
    "skis",          "snowboard",    "sports ball",
    "kite",          "baseball bat", "baseball glove",
    "skateboard",    "surfboard",    "tennis racket",
    "bottle",        "wine glass",   "cup",
    "fork",          "knife",        "spoon",
    "bowl",          "banana",       "apple",
    "sandwich",      "orange",       "broccoli",
    "carrot",        "hot dog",      "pizza",
    "donut",         "cake",         "chair",
    "couch",         "potted plant", "bed",
    "dining table",  "toilet",       "tv",
    "laptop",        "mouse",        "remote",
    "keyboard",      "cell phone",   "microwave",
    "oven",          "toaster",      "sink",
    "refrigerator",  "book",         "clock",
    "vase",          "scissors",     "teddy bear",
    "hair drier",    "toothbrush"};

struct Alias {
  std::string_view voc;
  std::string_view coco;
};

constexpr std::array<Alias, 6> kAliases = {{{"aeroplane", "airplane"},
                                            {"diningtable", "dining table"},
                                            {"motorbike", "motorcycle"},
                                            {"pottedplant", "potted plant"},
                                            {"sofa", "couch"},
                                            {"tvmonitor", "tv"}}};

}  // namespace

std::span<const std::string_view> coco_class_names() {
  return kCoco;
}

bool is_coco_class(std::string_view name) {
  return std::ranges::find(kCoco, name) != kCoco.end();
}

std::string coco_name(std::string_view name) {
  const auto* const alias = std::ranges::find(kAliases, name, &Alias::voc);
  return std::string(alias == kAliases.end() ? name : alias->coco);
}

}  // namespace stillmap
