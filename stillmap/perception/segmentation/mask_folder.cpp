// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/mask_folder.hpp"

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/perception/segmentation/class_map.hpp"
#include "stillmap/perception/segmentation/found_object.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

bool has_png(const fs::path& folder) {
  std::error_code failure;
  const fs::directory_iterator entries(folder, failure);
  if (failure) {
    throw Error("{}: cannot be read ({}), expected a folder of masks, one PNG an image",
                folder.string(),
                failure.message());
  }
  return std::any_of(fs::begin(entries), fs::end(entries), [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".png";
  });
}

void check_values(const cv::Mat1b& mask, const fs::path& path) {
  std::uint8_t person = 0;
  for (const std::uint8_t value : mask) {
    if (value == 0 || value == person) continue;
    if (person != 0) {
      throw Error(
          "{}: has the values 0, {} and {}, expected 0 for the background and 255 for people; "
          "masks with ids of objects need a detections.jsonl (docs/detections.md)",
          path.string(),
          std::min(person, value),
          std::max(person, value));
    }
    person = value;
  }
}

cv::Mat1b read_person_mask(const fs::path& path, cv::Size image) {
  cv::Mat1b mask = read_mask(path);
  check_mask_size(mask, image, path);
  check_values(mask, path);
  return mask;
}

}  // namespace

MaskFolder::MaskFolder(fs::path folder, cv::Size image, std::map<std::string, std::string> names)
    : folder_(std::move(folder)), image_(image), names_(std::move(names)) {
  if (has_png(folder_)) return;
  throw Error("{}: no PNG in it, expected one mask an image, named as the image or its stamp",
              folder_.string());
}

fs::path MaskFolder::file_of(const Stamp& stamp) const {
  fs::path by_stamp = folder_ / fs::path(stamp.text + ".png").filename();
  const auto name = names_.find(stamp.text);
  fs::path by_name =
      name == names_.end() ? by_stamp : folder_ / fs::path(name->second + ".png").filename();
  if (path_exists(by_name)) return by_name;
  if (path_exists(by_stamp)) return by_stamp;
  throw Error("{}: no such mask, expected one for each image; one without people is all 0",
              by_name.string());
}

FrameDetections MaskFolder::segment(const ColorImage&, const Stamp& stamp) const {
  constexpr int kLeastPixels = 50;
  const cv::Mat1b mask = read_person_mask(file_of(stamp), image_);
  const ClassMap map{cv::Mat1b((mask != 0) & 1), cv::Mat1f(image_, 1.0F)};
  return assemble_detections(
      stamp,
      image_,
      objects_of_class_map(map, {"background", "person"}, {.min_pixels = kLeastPixels}));
}

}  // namespace stillmap
