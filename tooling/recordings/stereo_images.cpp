// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/stereo_images.hpp"

#include <utility>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

class StereoImages : public ImageReader {
 public:
  StereoImages(std::vector<SequenceEntry> entries, std::shared_ptr<const StereoRig> rig)
      : entries_(std::move(entries)), rig_(std::move(rig)) {}

  [[nodiscard]] ColorFile color(std::size_t index) const override {
    ColorFile left = read_image(entries_.at(index).color_file);
    left.color = rig_->rectified_left(left.color);
    return left;
  }
  [[nodiscard]] DepthImage depth(std::size_t index, double depth_factor) const override {
    return pair(index, depth_factor).depth;
  }
  [[nodiscard]] ImagePair pair(std::size_t index, double /*depth_factor*/) const override {
    ImagePair images{color(index), {}};
    const ColorFile right = read_image(entries_.at(index).depth_file);
    images.depth = rig_->depth(images.color.color, rig_->rectified_right(right.color));
    return images;
  }

 private:
  [[nodiscard]] ColorFile read_image(const std::filesystem::path& file) const {
    ColorFile image = read_color_file(file);
    const CameraModel& camera = rig_->camera();
    if (image.color.mat.size() != cv::Size(camera.width_px, camera.height_px)) {
      throw Error("{}: {}x{} pixels, expected {}x{} as the calibration has",
                  file.string(),
                  image.color.mat.cols,
                  image.color.mat.rows,
                  camera.width_px,
                  camera.height_px);
    }
    return image;
  }

  std::vector<SequenceEntry> entries_;
  std::shared_ptr<const StereoRig> rig_;
};

}  // namespace

SequenceContent stereo_content(std::vector<SequenceEntry> entries,
                               std::shared_ptr<const StereoRig> rig) {
  SequenceContent content;
  content.entries = std::move(entries);
  content.camera = rig->camera();
  content.depth_noise = rig->noise();
  content.remarks.notes.push_back(fmt::format(
      "stereo with a baseline of {:.3f} m: depth by semi-global matching, up to {:.1f} m",
      rig->baseline_m(),
      rig->noise().max_depth_m));
  content.images = std::make_shared<StereoImages>(content.entries, std::move(rig));
  return content;
}

}  // namespace stillmap
