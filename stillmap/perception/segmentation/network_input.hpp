// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// How an image's plane is laid over a network's input: input = scale * image + offset, where
/// pixel u covers [u, u + 1) in both, so that its middle is at u + 0.5.
struct InputPlacement {
  cv::Size input;
  double scale_x = 1, scale_y = 1;
  double offset_x = 0, offset_y = 0;  ///< pixels of the input

  /// The whole image fills the whole input.
  [[nodiscard]] static InputPlacement stretch(cv::Size image, cv::Size input);
  /// The whole image in the middle of the input, its shape kept.
  [[nodiscard]] static InputPlacement letterbox(cv::Size image, cv::Size input);
  /// A part of the image, which may reach beyond it, fills the whole input.
  [[nodiscard]] static InputPlacement crop(const PixelBox& part, cv::Size input);

  /// The same for a plane of another size that covers all of the input (a network's output).
  [[nodiscard]] InputPlacement onto(cv::Size plane) const;

  [[nodiscard]] PixelBox to_input(const PixelBox& image_box) const;
  [[nodiscard]] PixelBox to_image(const PixelBox& input_box) const;
};

/// What a network wants to be given: (value / 255 - mean) / deviation for each channel.
struct InputFormat {
  bool channels_last = false;
  bool blue_first = false;  ///< channels in the order blue, green, red, also those of the next two
  std::array<float, 3> mean{0, 0, 0};
  std::array<float, 3> deviation{1, 1, 1};
  float padding = 0;  ///< what surrounds the image, from 0 to 255
};

/// The image as a network's input of one batch, 1x3xHxW or 1xHxWx3, sampled bilinearly.
[[nodiscard]] Tensor make_input(const ColorImage& image,
                                const InputPlacement& placement,
                                const InputFormat& format);

/// A network's output plane, sampled bilinearly at the pixels of a region of the image; `outside`
/// where the plane does not reach. `placement` is of the image on the plane.
[[nodiscard]] cv::Mat1f sample_at_image(const cv::Mat1f& plane,
                                        const InputPlacement& placement,
                                        cv::Rect region,
                                        float outside);

}  // namespace stillmap
