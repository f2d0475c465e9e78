// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The placement of an image on the input of a network: input = scale * image + offset. Pixel u
/// covers [u, u + 1) in both, with its centre at u + 0.5.
struct InputPlacement {
  cv::Size input;
  double scale_x = 1, scale_y = 1;
  double offset_x = 0, offset_y = 0;  ///< pixels of the input

  /// The whole image fills the whole input.
  [[nodiscard]] static InputPlacement stretch(cv::Size image, cv::Size input);
  /// The whole image in the middle of the input, with its aspect ratio kept.
  [[nodiscard]] static InputPlacement letterbox(cv::Size image, cv::Size input);
  /// A part of the image, which may reach beyond it, fills the whole input.
  [[nodiscard]] static InputPlacement crop(const PixelBox& part, cv::Size input);

  /// The placement on a plane of another size that covers the whole input (an output of the
  /// network).
  [[nodiscard]] InputPlacement onto(cv::Size plane) const;

  [[nodiscard]] PixelBox to_input(const PixelBox& image_box) const;
  [[nodiscard]] PixelBox to_image(const PixelBox& input_box) const;
};

/// The input format of a network: (value / 255 - mean) / deviation for each channel.
struct InputFormat {
  bool channels_last = false;
  /// channels in the order blue, green, red, also in the next two members
  bool blue_first = false;
  std::array<float, 3> mean{0, 0, 0};
  std::array<float, 3> deviation{1, 1, 1};
  float padding = 0;  ///< value around the image, from 0 to 255
};

/// The image as network input with a batch of one, 1x3xHxW or 1xHxWx3, sampled bilinearly.
[[nodiscard]] Tensor make_input(const ColorImage& image,
                                const InputPlacement& placement,
                                const InputFormat& format);

/// An output plane of a network, sampled bilinearly at the pixels of a region of the image;
/// `outside` beyond the plane. `placement` is that of the image on the plane.
[[nodiscard]] cv::Mat1f sample_at_image(const cv::Mat1f& plane,
                                        const InputPlacement& placement,
                                        cv::Rect region,
                                        float outside);

}  // namespace stillmap
