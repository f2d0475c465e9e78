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

/// A network of a supported kind that runs on whole images.
class ImageNetwork {
 public:
  /// Runs the network once on an empty image to learn the shapes of its outputs. Throws Error for a
  /// network of no ExportKind.
  ImageNetwork(std::unique_ptr<Network> network, cv::Size image);

  /// The objects in an image, with the thresholds of score and overlap that are usual for the kind.
  /// Objects have no masks if the kind gives boxes only.
  [[nodiscard]] std::vector<FoundObject> find(const ColorImage& color) const;

 private:
  [[nodiscard]] std::vector<FoundObject> decode(const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<FoundObject> decode_map(const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<FoundObject> decode_yolo(const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<FoundObject> decode_ssd_and_map(
      const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<Candidate> decode_nanodet_levels(
      const std::vector<Tensor>& outputs) const;
  [[nodiscard]] std::vector<FoundObject> decode_boxes(const std::vector<Tensor>& outputs) const;

  std::unique_ptr<Network> network_;
  cv::Size image_;
  std::int64_t batch_ = 1;
  NetworkExport export_;
  InputPlacement placement_;
  InputFormat format_;
};

/// A segmenter of one network.
class NetworkSegmenter : public Segmenter {
 public:
  NetworkSegmenter(std::unique_ptr<Network> network, cv::Size image);

  [[nodiscard]] FrameDetections segment(const ColorImage& color, const Stamp& stamp) const override;

 private:
  cv::Size image_;
  ImageNetwork network_;
};

/// A segmenter of two networks: a detector finds boxes, and a matting network finds the masks of
/// people in them. A person for whom the matting network finds almost no pixels is dropped.
class PersonSegmenter : public Segmenter {
 public:
  /// `matting` takes a square crop and gives one value per pixel; values of at least `threshold`
  /// are a person's.
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
