// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/sequence.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "stillmap/core/ascii_lower.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// "rgbd_dataset_freiburg1_xyz/" -> "rgbd_dataset_freiburg1_xyz"; also for "." and links.
std::string name_of(const fs::path& path) {
  std::error_code error;
  const fs::path full = fs::canonical(path, error);
  return (error ? path : full).filename().string();
}

// The runs of letters and digits in a name, in lower case.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    const char lower = ascii_lower(c);
    if ((lower >= 'a' && lower <= 'z') || (c >= '0' && c <= '9')) {
      words.back() += lower;
    } else {
      words.emplace_back();
    }
  }
  return words;
}

// The camera of a data set, by a word in its folder's name.
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

CameraModel find_camera(const fs::path& path,
                        const std::string& name,
                        const std::optional<CameraModel>& chosen,
                        const SequenceContent& content) {
  if (content.depth_noise && chosen) {
    throw Error(
        "{}: stereo pairs have a camera of their own, that of their calibration; leave out "
        "--camera",
        path.string());
  }
  if (content.depth_noise) return content.camera.value();
  if (chosen) {
    check_camera(*chosen, "camera '" + chosen->name + "'");
    return *chosen;
  }
  if (path_exists(path / "camera.yaml")) return read_camera_yaml(path / "camera.yaml");
  if (content.camera) return *content.camera;
  if (const std::optional<CameraModel> camera = camera_of_name(name)) return *camera;
  const fs::path truth = path / "truth" / "objects.json";
  if (path_exists(truth)) return read_truth_camera(truth);
  const std::string why = content.no_camera.empty() ? "" : " (" + content.no_camera + ")";
  throw UnknownCamera("{}: which camera took it is unknown{}: name it, or put a camera.yaml there",
                      path.string(),
                      why);
}

}  // namespace

Sequence Sequence::open(const fs::path& path, const SequenceOptions& options) {
  const SequenceFormat& format = choose_format(path, options.format, options.formats);
  Sequence sequence;
  sequence.path_ = path;
  sequence.name_ = name_of(path);
  sequence.format_ = format.name;
  sequence.content_ = format.open(path, options.reading);
  STILLMAP_CHECK(!sequence.content_.entries.empty());
  sequence.use_camera(find_camera(path, sequence.name_, options.camera, sequence.content_));
  return sequence;
}

const SequenceEntry& Sequence::entry(FrameId id) const {
  STILLMAP_CHECK(id.index() < size());
  return entries()[id.index()];
}

FramePtr Sequence::read(FrameId id) const {
  return read_with_warning(id).frame;
}

FrameReading Sequence::read_with_warning(FrameId id) const {
  STILLMAP_CHECK(id.index() < size());
  return reader_.read(content_, id, path_);
}

DepthImage Sequence::stored_depth(FrameId id) const {
  STILLMAP_CHECK(id.index() < size());
  return content_.images->depth(id.index(), 1.0);
}

std::optional<GroundTruth> Sequence::groundtruth() const {
  if (!content_.groundtruth) return std::nullopt;
  return content_.groundtruth();
}

}  // namespace stillmap
