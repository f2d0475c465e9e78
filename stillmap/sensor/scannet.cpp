// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/scannet.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/image_folders.hpp"
#include "stillmap/sensor/intrinsic_files.hpp"
#include "stillmap/sensor/numbered_images.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// Colour as the depth camera, which has the same centre, would see it.
class ResampledColor : public ImageReader {
 public:
  ResampledColor(std::shared_ptr<const ImageReader> images,
                 const CameraModel& color,
                 const CameraModel& depth)
      : images_(std::move(images)),
        size_(depth.width_px, depth.height_px),
        color_of_depth_px_(color.fx / depth.fx,
                           0,
                           color.cx - color.fx / depth.fx * depth.cx,
                           0,
                           color.fy / depth.fy,
                           color.cy - color.fy / depth.fy * depth.cy) {}

  [[nodiscard]] ColorFile color(std::size_t index) const override {
    ColorFile file = images_->color(index);
    cv::Mat3b resampled;
    cv::warpAffine(file.color.mat,
                   resampled,
                   color_of_depth_px_,
                   size_,
                   cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    return {ColorImage(resampled), std::move(file.warning)};
  }
  [[nodiscard]] DepthImage depth(std::size_t index, double depth_factor) const override {
    return images_->depth(index, depth_factor);
  }

 private:
  std::shared_ptr<const ImageReader> images_;
  cv::Size size_;
  cv::Matx23d color_of_depth_px_;
};

// intrinsic_KIND.txt; empty where there is none.
fs::path intrinsic_file(const fs::path& folder, const std::string& kind) {
  for (const char* place : {"intrinsic", "intrinsics", "."}) {
    for (const char* name : {"intrinsic_", "intrinsics_"}) {
      const fs::path path = folder / place / (name + kind + ".txt");
      if (path_exists(path)) return path;
    }
  }
  return {};
}

}  // namespace

bool is_scannet(const fs::path& folder) {
  return is_image_folders(folder) && path_exists(folder / "pose");
}

SequenceContent open_scannet(const fs::path& folder, const ReadingOptions& options) {
  const std::optional<ImageFolders> folders = find_image_folders(folder);
  if (!folders) throw Error("{}: no folders color and depth in it", folder.string());
  SequenceContent content = pair_numbered(
      files_ending(folders->color, ""), files_ending(folders->depth, ""), folder, options);
  const fs::path of_depth = intrinsic_file(folder, "depth");
  const fs::path of_color = intrinsic_file(folder, "color");
  if (!of_depth.empty() || !of_color.empty()) {
    const cv::Size color_size = content.images->color(0).color.mat.size();
    const cv::Size depth_size = content.images->depth(0, 1000).mat.size();
    content.camera = read_intrinsic_text(of_depth.empty() ? of_color : of_depth, depth_size);
    if (color_size != depth_size) {
      if (of_depth.empty() || of_color.empty()) {
        throw Error(
            "{}: colour is of another size than depth, which needs intrinsic_color.txt and "
            "intrinsic_depth.txt",
            folder.string());
      }
      content.images = std::make_shared<ResampledColor>(
          content.images, read_intrinsic_text(of_color, color_size), *content.camera);
      content.remarks.notes.push_back("colour is resampled to the depth camera");
    }
  }
  content.groundtruth = [poses = folder / "pose", entries = content.entries] {
    return read_pose_files(
        entries, [&](const fs::path& color) { return poses / (color.stem().string() + ".txt"); });
  };
  return content;
}

}  // namespace stillmap
