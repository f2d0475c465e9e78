// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/pair_images.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/associate.hpp"

namespace stillmap {
namespace {

std::vector<double> seconds_of(const std::vector<StampedImage>& images) {
  std::vector<double> seconds;
  seconds.reserve(images.size());
  for (const StampedImage& image : images) seconds.push_back(image.stamp.seconds);
  return seconds;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// How much later than a colour image the depth image nearest in time is: the median.
double nearest_offset_s(const std::vector<double>& color, const std::vector<double>& depth) {
  std::vector<double> offsets;
  for (const double stamp : color) {
    const auto after = std::ranges::lower_bound(depth, stamp);
    const bool take_before = after == depth.end() ||
                             (after != depth.begin() && stamp - *std::prev(after) < *after - stamp);
    offsets.push_back((take_before ? *std::prev(after) : *after) - stamp);
  }
  return median(std::move(offsets));
}

std::string offset_text(double offset_s) {
  return fmt::format("depth images are {:.1f} ms {} colour images (median)",
                     1e3 * std::abs(offset_s),
                     offset_s < 0 ? "before" : "after");
}

}  // namespace

PairedImages pair_by_stamp(const ImageList& color,
                           const ImageList& depth,
                           const std::string& place) {
  constexpr double kNoteworthyOffsetS = 1e-3;
  const std::vector<double> color_s = seconds_of(color.images), depth_s = seconds_of(depth.images);
  PairedImages paired{associate(color_s, depth_s, kMaxStampDifferenceS), {}};
  if (paired.pairs.empty()) {
    throw Error("{}: no stamp of {} is within {} s of one of {}; {}",
                place,
                color.name,
                kMaxStampDifferenceS,
                depth.name,
                offset_text(nearest_offset_s(color_s, depth_s)));
  }
  if (paired.pairs.size() < color.images.size()) {
    paired.remarks.notes.push_back(
        fmt::format("{} of {} colour images have no depth image within {} s and are left out",
                    color.images.size() - paired.pairs.size(),
                    color.images.size(),
                    kMaxStampDifferenceS));
  }
  std::vector<double> offsets;
  for (const auto& [i, j] : paired.pairs) offsets.push_back(depth_s[j] - color_s[i]);
  const double offset_s = median(std::move(offsets));
  if (std::abs(offset_s) > kNoteworthyOffsetS)
    paired.remarks.notes.push_back(offset_text(offset_s));
  return paired;
}

std::vector<SequenceEntry> entries_of(const PairedImages& paired,
                                      const ImageList& color,
                                      const ImageList& depth) {
  std::vector<SequenceEntry> entries;
  entries.reserve(paired.pairs.size());
  for (const auto& [i, j] : paired.pairs) {
    const StampedImage& image = color.images[i];
    entries.push_back(
        {image.stamp, depth.images[j].stamp.seconds, image.file, depth.images[j].file});
  }
  return entries;
}

}  // namespace stillmap
