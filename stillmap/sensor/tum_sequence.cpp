// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/tum_sequence.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/tum_lists.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// "rgbd_dataset_freiburg1_xyz/" -> "rgbd_dataset_freiburg1_xyz"; also for "." and links.
std::string folder_name(const fs::path& folder) {
  std::error_code error;
  const fs::path full = fs::canonical(folder, error);
  return (error ? folder : full).filename().string();
}

// The runs of letters and digits in a name, in lower case.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (capital || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) {
      words.back() += static_cast<char>(capital ? c - 'A' + 'a' : c);
    } else {
      words.emplace_back();
    }
  }
  return words;
}

std::optional<CameraModel> camera_of_name(const std::string& folder_name) {
  static constexpr std::pair<const char*, const char*> kWords[] = {{"freiburg1", "tum_fr1"},
                                                                   {"fr1", "tum_fr1"},
                                                                   {"freiburg2", "tum_fr2"},
                                                                   {"fr2", "tum_fr2"},
                                                                   {"freiburg3", "tum_fr3"},
                                                                   {"fr3", "tum_fr3"},
                                                                   {"bonn", "bonn"}};
  const std::vector<std::string> words = words_of(folder_name);
  for (const auto& [word, camera] : kWords) {
    if (std::ranges::find(words, word) != words.end()) return builtin_camera(camera);
  }
  return std::nullopt;
}

CameraModel find_camera(const fs::path& folder,
                        const std::string& name,
                        const SequenceOptions& options) {
  if (options.camera) {
    check_camera(*options.camera, "camera '" + options.camera->name + "'");
    return *options.camera;
  }
  if (path_exists(folder / "camera.yaml")) return read_camera_yaml(folder / "camera.yaml");
  if (const std::optional<CameraModel> camera = camera_of_name(name)) return *camera;
  const fs::path truth = folder / "truth" / "objects.json";
  if (path_exists(truth)) return read_truth_camera(truth);
  throw UnknownCamera("{}: which camera took it is unknown: name it, or put a camera.yaml there",
                      folder.string());
}

void check_size(const cv::Mat& image, const CameraModel& camera, const fs::path& file) {
  if (image.cols == camera.width_px && image.rows == camera.height_px) return;
  throw Error("{}: {}x{} pixels, expected {}x{} as camera '{}' has",
              file.string(),
              image.cols,
              image.rows,
              camera.width_px,
              camera.height_px,
              camera.name);
}

}  // namespace

TumSequence TumSequence::open(const fs::path& folder, const SequenceOptions& options) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw Error("{}: no such folder, expected a sequence in the TUM RGB-D layout", folder.string());
  }
  TumSequence sequence;
  sequence.folder_ = folder;
  sequence.name_ = folder_name(folder);
  sequence.entries_ = read_sequence_entries(folder);
  sequence.camera_ = find_camera(folder, sequence.name_, options);
  return sequence;
}

const SequenceEntry& TumSequence::entry(FrameId id) const {
  STILLMAP_CHECK(id.index() < entries_.size());
  return entries_[id.index()];
}

FramePtr TumSequence::read(FrameId id) const {
  return read_with_warning(id).frame;
}

FrameReading TumSequence::read_with_warning(FrameId id) const {
  const SequenceEntry& files = entry(id);
  RgbdFrame frame;
  frame.id = id;
  frame.stamp = files.stamp;
  frame.depth_stamp_s = files.depth_stamp_s;
  ColorFile color = read_color_file(files.color_file);
  frame.color = std::move(color.color);
  check_size(frame.color.mat, camera_, files.color_file);
  frame.depth = read_depth(files.depth_file, camera_.depth_factor);
  check_size(frame.depth.mat, camera_, files.depth_file);
  frame.gray = to_gray(frame.color);
  return {std::make_shared<const RgbdFrame>(std::move(frame)), std::move(color.warning)};
}

std::optional<fs::path> TumSequence::groundtruth_file() const {
  const fs::path path = folder_ / "groundtruth.txt";
  if (!path_exists(path)) return std::nullopt;
  return path;
}

}  // namespace stillmap
