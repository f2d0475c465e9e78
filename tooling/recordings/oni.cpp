// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/oni.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/depth_units.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/field_of_view.hpp"
#include "stillmap/sensor/pair_images.hpp"
#include "tooling/recordings/oni_depth.hpp"
#include "tooling/recordings/oni_file.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

const OniStream& stream_of(const OniFile& file, OniKind kind, const fs::path& path) {
  for (const OniStream& stream : file.streams()) {
    if (stream.kind == kind && !stream.images.empty()) return stream;
  }
  throw Error("{}: has no {} images; expected colour and depth",
              path.string(),
              kind == OniKind::kColor ? "colour" : "depth");
}

/// The images of a stream in the order of their stamps.
struct OniList {
  ImageList list;                // no files
  std::vector<OniImage> images;  // one for each
};

OniList list_of(const OniStream& stream) {
  OniList listed{{stream.name, {}, {}}, {}};
  std::vector<OniImage> sorted = stream.images;
  std::ranges::stable_sort(sorted, {}, &OniImage::stamp_us);
  for (const OniImage& image : sorted) {
    // In seconds, as absurd stamps differ by less than a number of seconds can tell.
    const double stamp_s = 1e-6 * static_cast<double>(image.stamp_us);
    if (!listed.images.empty() && listed.list.images.back().stamp.seconds >= stamp_s) continue;
    listed.list.images.push_back({Stamp{stamp_s, fmt::format("{:.6f}", stamp_s)}, {}});
    listed.images.push_back(image);
  }
  if (listed.images.size() < sorted.size()) {
    listed.list.remarks.warnings.push_back(
        fmt::format("{}: {} images have the stamp of another and are left out",
                    stream.name,
                    sorted.size() - listed.images.size()));
  }
  return listed;
}

template <class Image>
Image unmirrored(Image image, bool mirrored) {
  if (mirrored) cv::flip(image, image, 1);
  return image;
}

class OniImages : public ImageReader {
 public:
  OniImages(std::shared_ptr<const OniFile> file,
            OniStream color,
            OniStream depth,
            std::vector<std::pair<OniImage, OniImage>> pairs)
      : file_(std::move(file)),
        color_(std::move(color)),
        depth_(std::move(depth)),
        pairs_(std::move(pairs)) {}

  [[nodiscard]] ColorFile color(std::size_t index) const override {
    const std::string bytes = file_->read(pairs_.at(index).first);
    const std::string place = fmt::format("{}, frame {}", color_.name, index);
    const cv::Mat3b rgb =
        color_.codec == "JPEG" ? cv::Mat3b(decode_color(bytes, place).mat) : plain(bytes, place);
    return {ColorImage(unmirrored(rgb, color_.mirrored)), {}};
  }

  [[nodiscard]] DepthImage depth(std::size_t index, double) const override {
    const std::string place = fmt::format("{}, frame {}", depth_.name, index);
    const cv::Mat1w units =
        decode_oni_depth(file_->read(pairs_.at(index).second), depth_.codec, depth_.size, place);
    const DepthImage metres = depth_of_units(units, depth_.units_per_m);
    return DepthImage(unmirrored(metres.mat, depth_.mirrored));
  }

 private:
  [[nodiscard]] cv::Mat3b plain(const std::string& bytes, const std::string& place) const {
    if (color_.codec != "NONE") {
      throw Error("{}: colour of codec '{}', expected NONE or JPEG", place, color_.codec);
    }
    const cv::Size size = color_.size;
    if (size.empty() || bytes.size() != static_cast<std::size_t>(size.area()) * 3) {
      throw DamagedImage("{}: {} bytes, expected {}x{} pixels of RGB888",
                         place,
                         bytes.size(),
                         size.width,
                         size.height);
    }
    cv::Mat3b rgb(size);
    std::memcpy(rgb.data, bytes.data(), bytes.size());
    return rgb;
  }

  std::shared_ptr<const OniFile> file_;
  OniStream color_, depth_;
  std::vector<std::pair<OniImage, OniImage>> pairs_;
};

bool is_angle(double angle) {
  return angle > 0 && angle < std::numbers::pi;
}

}  // namespace

SequenceContent open_oni(const fs::path& path, const ReadingOptions& /*options*/) {
  const auto file = std::make_shared<const OniFile>(path);
  const OniStream& color = stream_of(*file, OniKind::kColor, path);
  const OniStream& depth = stream_of(*file, OniKind::kDepth, path);
  if (color.size != depth.size) {
    throw Error("{}: depth of {}x{} pixels, but colour of {}x{}; expected one size",
                path.string(),
                depth.size.width,
                depth.size.height,
                color.size.width,
                color.size.height);
  }
  const OniList colors = list_of(color), depths = list_of(depth);
  const PairedImages paired = pair_by_stamp(colors.list, depths.list, path.string());
  SequenceContent content;
  content.entries = entries_of(paired, colors.list, depths.list);
  std::vector<std::pair<OniImage, OniImage>> pairs;
  for (const auto& [i, j] : paired.pairs) pairs.emplace_back(colors.images[i], depths.images[j]);
  content.images = std::make_shared<OniImages>(file, color, depth, std::move(pairs));
  for (const Remarks* remarks : {&colors.list.remarks, &depths.list.remarks, &paired.remarks}) {
    content.remarks.add(*remarks);
  }
  if (file->rest() > 0) {
    content.remarks.warnings.push_back(
        fmt::format("{}: {} bytes at its end are no whole record: it is not complete",
                    path.string(),
                    file->rest()));
  }
  if (is_angle(color.across_rad) && is_angle(color.down_rad)) {
    content.camera = pinhole_of_view(color.size, color.across_rad, color.down_rad);
    content.camera->name = path.filename().string();
    content.camera->depth_factor = depth.units_per_m;
  } else {
    content.no_camera = "the recording tells no field of view";
  }
  return content;
}

}  // namespace stillmap
