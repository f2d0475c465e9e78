// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/segmenter.hpp"

#include <filesystem>
#include <string>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/perception/segmentation/mask_folder.hpp"
#include "stillmap/perception/segmentation/model_folder.hpp"
#include "stillmap/perception/segmentation/network_segmenter.hpp"
#include "stillmap/perception/segmentation/onnx_runtime.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// Reads the detections of a folder.
class FolderSegmenter : public Segmenter {
 public:
  FolderSegmenter(const fs::path& folder, cv::Size image)
      : folder_(DetectionsFolder::open(folder, image)) {}

  [[nodiscard]] FrameDetections segment(const ColorImage&, const Stamp& stamp) const override {
    return folder_.at(stamp);
  }

 private:
  DetectionsFolder folder_;
};

std::unique_ptr<Network> open_fetched(const fs::path& name, const SegmenterOptions& options) {
  const fs::path file = model_folder() / name;
  if (!path_exists(file)) {
    throw Error("auto: there is no {}; run tools/fetch_models, which gets it", file.string());
  }
  return open_onnx_network(file, {options.threads});
}

std::unique_ptr<Segmenter> make_person_segmenter(cv::Size image, const SegmenterOptions& options) {
  constexpr float kPerson = 0.3F;
  std::unique_ptr<Network> detector = open_fetched("nanodet.onnx", options);
  std::unique_ptr<Network> matting = open_fetched("selfie.onnx", options);
  return std::make_unique<PersonSegmenter>(std::move(detector), std::move(matting), kPerson, image);
}

// Makes the call; begins the message of an Error with the file where it does not yet.
template <class Call>
auto naming_file(const fs::path& file, const Call& call) {
  try {
    return call();
  } catch (const Error& error) {
    const std::string text = error.what();
    throw Error(text.starts_with(file.string()) ? text : file.string() + ": " + text);
  }
}

// The network of one file.
class FileSegmenter : public Segmenter {
 public:
  FileSegmenter(fs::path file, cv::Size image, const SegmenterOptions& options)
      : file_(std::move(file)), network_(naming_file(file_, [&] {
          return std::make_unique<NetworkSegmenter>(open_onnx_network(file_, {options.threads}),
                                                    image);
        })) {}

  [[nodiscard]] FrameDetections segment(const ColorImage& color,
                                        const Stamp& stamp) const override {
    return naming_file(file_, [&] { return network_->segment(color, stamp); });
  }

 private:
  fs::path file_;
  std::unique_ptr<NetworkSegmenter> network_;
};

}  // namespace

std::unique_ptr<Segmenter> make_segmenter(std::string_view description,
                                          cv::Size image,
                                          const SegmenterOptions& options) {
  constexpr std::string_view kFolder = "detections:", kMasks = "masks:", kNetwork = "onnx:";
  if (description == "auto" || description == "onnx:auto") {
    return make_person_segmenter(image, options);
  }
  if (description.starts_with(kFolder) && description.size() > kFolder.size()) {
    return std::make_unique<FolderSegmenter>(description.substr(kFolder.size()), image);
  }
  if (description.starts_with(kMasks) && description.size() > kMasks.size()) {
    return std::make_unique<MaskFolder>(
        description.substr(kMasks.size()), image, options.image_names);
  }
  if (description.starts_with(kNetwork) && description.size() > kNetwork.size()) {
    return std::make_unique<FileSegmenter>(description.substr(kNetwork.size()), image, options);
  }
  throw Error("{}: expected detections:DIR, masks:DIR, onnx:MODEL.onnx or auto", description);
}

}  // namespace stillmap
