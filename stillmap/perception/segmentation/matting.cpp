// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/matting.hpp"

#include <algorithm>
#include <limits>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

cv::Mat1f only_plane(const TensorView& output) {
  TensorShape shape = output.shape;
  if (shape.size() > 2 && shape.back() == 1) shape.pop_back();
  shape = without_batch(shape, 2);
  const std::int64_t count = element_count(shape);
  if (shape.size() != 2 || count <= 0 || output.values.size() != static_cast<std::size_t>(count)) {
    throw Error("a person's mask of shape {}: expected 1xHxWx1", shape_text(output.shape));
  }
  cv::Mat1f plane(static_cast<int>(shape[0]), static_cast<int>(shape[1]));
  std::ranges::copy(output.values, plane.begin());
  return plane;
}

}  // namespace

PixelBox crop_square(const PixelBox& box, double scale) {
  const double half_side = std::max(box.width(), box.height()) * scale / 2;
  const double x = (box.x0 + box.x1) / 2, y = (box.y0 + box.y1) / 2;
  return {x - half_side, y - half_side, x + half_side, y + half_side};
}

FoundObject with_matting(FoundObject person,
                         const TensorView& output,
                         float threshold,
                         const InputPlacement& placement,
                         cv::Size image) {
  const cv::Mat1f plane = only_plane(output);
  person.region = pixels_in(person.box, image);
  constexpr float kNobody = std::numeric_limits<float>::lowest();
  const cv::Mat1f sampled =
      sample_at_image(plane, placement.onto(plane.size()), person.region, kNobody);
  person.mask = sampled >= threshold;
  return person;
}

}  // namespace stillmap
