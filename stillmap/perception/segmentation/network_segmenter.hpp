// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "stillmap/perception/segmentation/export_kind.hpp"
#include "stillmap/perception/segmentation/found_object.hpp"
#include "stillmap/perception/segmentation/network.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"

namespace stillmap {

/// One network of a known kind, run on a whole image.
class ImageNetwork {
 public:
  /// Runs the network once on an empty image: shapes that it leaves open are known only then.
  /// Throws Error when it is none of ExportKind.
  ImageNetwork(std::unique_ptr<Network> network, cv::Size image);

  /// The objects that it finds, by the scores and overlaps that are usual for its kind; those of
  /// NanoDet and CenterNet are boxes without masks.
  [[nodiscard]] std::vector<FoundObject> find(const ColorImage& color) const;

 private:
  [[nodiscard]] std::vector<FoundObject> decode(const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<FoundObject> decode_yolo(const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<FoundObject> decode_ssd_and_map(
      const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<FoundObject> decode_boxes(const std::vector<Tensor>& outputs) const;

  std::unique_ptr<Network> network_;
  cv::Size image_;
  NetworkExport export_;
  InputPlacement placement_;
  InputFormat format_;
};

/// One network that gives boxes and masks.
class NetworkSegmenter : public Segmenter {
 public:
  NetworkSegmenter(std::unique_ptr<Network> network, cv::Size image);

  [[nodiscard]] FrameDetections segment(const ColorImage& color, const Stamp& stamp) const override;

 private:
  cv::Size image_;
  ImageNetwork network_;
};

/// A detector's boxes; those of people get a mask from a network that separates a person from what
/// is around. A person of which that network sees next to nothing is dropped.
class PersonSegmenter : public Segmenter {
 public:
  /// `matting` takes a square crop and gives one value a pixel, a person's from `threshold` up.
  PersonSegmenter(std::unique_ptr<Network> detector,
                  std::unique_ptr<Network> matting,
                  float threshold,
                  cv::Size image);

  [[nodiscard]] FrameDetections segment(const ColorImage& color, const Stamp& stamp) const override;

 private:
  [[nodiscard]] std::optional<FoundObject> with_mask(FoundObject person,
                                                     const ColorImage& color) const;

  cv::Size image_;
  ImageNetwork detector_;
  std::unique_ptr<Network> matting_;
  TensorShape crop_shape_;
  float threshold_;
};

}  // namespace stillmap
