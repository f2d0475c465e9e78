// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/network_input.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// The sample position of a target pixel along one axis: between two source pixels.
struct Tap {
  int first = 0, second = 0;
  float weight = 0;  // of the second source pixel
  bool inside = false;
};

// The centre of target pixel t is at scale * (t + 0.5) + offset of the source. Within half a pixel
// of the edge of the source only the outermost pixel counts.
std::vector<Tap> make_taps(int begin, int count, double scale, double offset, int source) {
  std::vector<Tap> taps(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double middle = scale * (begin + i + 0.5) + offset;
    if (!(middle >= 0 && middle < source)) continue;
    const double position = std::clamp(middle - 0.5, 0.0, source - 1.0);
    const int first = static_cast<int>(position);
    taps[static_cast<std::size_t>(i)] = {
        first, std::min(first + 1, source - 1), static_cast<float>(position - first), true};
  }
  return taps;
}

float blend(float first, float second, float weight) {
  return first + weight * (second - first);
}

// One row of the input: three values per pixel, 0 to 255.
void sample_row(const cv::Mat3b& image,
                const Tap& row,
                const std::vector<Tap>& columns,
                float padding,
                std::vector<float>& values) {
  const cv::Vec3b* const upper = image.ptr<cv::Vec3b>(row.first);
  const cv::Vec3b* const lower = image.ptr<cv::Vec3b>(row.second);
  float* value = values.data();
  for (const Tap& column : columns) {
    for (int channel = 0; channel < 3; ++channel, ++value) {
      *value =
          !column.inside
              ? padding
              : blend(
                    blend(
                        upper[column.first][channel], upper[column.second][channel], column.weight),
                    blend(
                        lower[column.first][channel], lower[column.second][channel], column.weight),
                    row.weight);
    }
  }
}

}  // namespace

InputPlacement InputPlacement::stretch(cv::Size image, cv::Size input) {
  return crop({0, 0, static_cast<double>(image.width), static_cast<double>(image.height)}, input);
}

InputPlacement InputPlacement::letterbox(cv::Size image, cv::Size input) {
  STILLMAP_CHECK(image.width > 0 && image.height > 0);
  const double scale = std::min(static_cast<double>(input.width) / image.width,
                                static_cast<double>(input.height) / image.height);
  return {input,
          scale,
          scale,
          (input.width - scale * image.width) / 2,
          (input.height - scale * image.height) / 2};
}

InputPlacement InputPlacement::crop(const PixelBox& part, cv::Size input) {
  STILLMAP_CHECK(part.width() > 0 && part.height() > 0);
  const double scale_x = input.width / part.width(), scale_y = input.height / part.height();
  return {input, scale_x, scale_y, -part.x0 * scale_x, -part.y0 * scale_y};
}

InputPlacement InputPlacement::onto(cv::Size plane) const {
  const double x = static_cast<double>(plane.width) / input.width;
  const double y = static_cast<double>(plane.height) / input.height;
  return {plane, scale_x * x, scale_y * y, offset_x * x, offset_y * y};
}

PixelBox InputPlacement::to_input(const PixelBox& image_box) const {
  return {scale_x * image_box.x0 + offset_x,
          scale_y * image_box.y0 + offset_y,
          scale_x * image_box.x1 + offset_x,
          scale_y * image_box.y1 + offset_y};
}

PixelBox InputPlacement::to_image(const PixelBox& input_box) const {
  return {(input_box.x0 - offset_x) / scale_x,
          (input_box.y0 - offset_y) / scale_y,
          (input_box.x1 - offset_x) / scale_x,
          (input_box.y1 - offset_y) / scale_y};
}

Tensor make_input(const ColorImage& image,
                  const InputPlacement& placement,
                  const InputFormat& format) {
  const int width = placement.input.width, height = placement.input.height;
  const std::size_t area = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::vector<Tap> rows = make_taps(
      0, height, 1 / placement.scale_y, -placement.offset_y / placement.scale_y, image.mat.rows);
  const std::vector<Tap> columns = make_taps(
      0, width, 1 / placement.scale_x, -placement.offset_x / placement.scale_x, image.mat.cols);
  Tensor input;
  input.shape =
      format.channels_last ? TensorShape{1, height, width, 3} : TensorShape{1, 3, height, width};
  input.values.resize(area * 3);
  std::vector<float> row_values(static_cast<std::size_t>(width) * 3);
  std::size_t pixel = 0;
  for (const Tap& row : rows) {
    if (row.inside) {
      sample_row(image.mat, row, columns, format.padding, row_values);
    } else {
      std::ranges::fill(row_values, format.padding);
    }
    for (std::size_t i = 0; i < row_values.size(); i += 3, ++pixel) {
      for (std::size_t c = 0; c < 3; ++c) {
        const float stored = row_values[i + (format.blue_first ? 2 - c : c)];
        const float value = (stored / 255.0F - format.mean[c]) / format.deviation[c];
        input.values[format.channels_last ? pixel * 3 + c : c * area + pixel] = value;
      }
    }
  }
  return input;
}

cv::Mat1f sample_at_image(const cv::Mat1f& plane,
                          const InputPlacement& placement,
                          cv::Rect region,
                          float outside) {
  const std::vector<Tap> rows =
      make_taps(region.y, region.height, placement.scale_y, placement.offset_y, plane.rows);
  const std::vector<Tap> columns =
      make_taps(region.x, region.width, placement.scale_x, placement.offset_x, plane.cols);
  cv::Mat1f sampled(region.height, region.width, outside);
  for (int y = 0; y < region.height; ++y) {
    const Tap& row = rows[static_cast<std::size_t>(y)];
    if (!row.inside) continue;
    const float* const upper = plane.ptr<float>(row.first);
    const float* const lower = plane.ptr<float>(row.second);
    float* const target = sampled.ptr<float>(y);
    for (int x = 0; x < region.width; ++x) {
      const Tap& column = columns[static_cast<std::size_t>(x)];
      if (!column.inside) continue;
      target[x] = blend(blend(upper[column.first], upper[column.second], column.weight),
                        blend(lower[column.first], lower[column.second], column.weight),
                        row.weight);
    }
  }
  return sampled;
}

}  // namespace stillmap
