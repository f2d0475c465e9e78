// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/camera_io.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/synth/sequence.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

void create_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    throw Error("{}: the folder cannot be made ({}); name one in a place that can be written to",
                folder.string(),
                failure.message());
  }
}

// A sequence never mixes with what is there already.
void check_vacant(const fs::path& folder) {
  std::error_code failure;
  const fs::file_status status = fs::status(folder, failure);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) {
    throw Error("{}: is a file, expected a folder for the sequence; name another", folder.string());
  }
  const bool empty = fs::is_empty(folder, failure);
  if (failure) throw Error("{}: cannot be read ({})", folder.string(), failure.message());
  if (!empty) {
    throw Error("{}: is not empty; name a new folder for the sequence or empty this one first",
                folder.string());
  }
}

struct Lists {
  std::string rgb = "# color images\n# timestamp filename\n";
  std::string depth = "# depth maps\n# timestamp filename\n";
  std::string associations;

  void add(const std::string& stamp) {
    rgb += fmt::format("{0} rgb/{0}.png\n", stamp);
    depth += fmt::format("{0} depth/{0}.png\n", stamp);
    associations += fmt::format("{0} rgb/{0}.png {0} depth/{0}.png\n", stamp);
  }
};

}  // namespace

void write_tum_sequence(const SyntheticSequence& sequence,
                        const fs::path& folder,
                        const std::function<void(std::size_t, std::size_t)>& on_progress) {
  check_vacant(folder);
  create_folder(folder / "rgb");
  create_folder(folder / "depth");
  Lists lists;
  for (std::uint32_t i = 0; i < sequence.size(); ++i) {
    const FramePtr frame = sequence.frame(FrameId(i));
    const std::string name = frame->stamp.text + ".png";
    write_file_atomically(folder / "rgb" / name, encode_png(frame->color));
    write_file_atomically(folder / "depth" / name,
                          encode_depth_png(frame->depth, sequence.camera().depth_factor));
    lists.add(frame->stamp.text);
    if (on_progress) on_progress(i + 1, sequence.size());
  }
  // The lists come last: a folder with them is complete.
  write_file_atomically(folder / "camera.yaml", format_camera_yaml(sequence.camera()));
  write_file_atomically(folder / "groundtruth.txt", format_trajectory(sequence.ground_truth()));
  write_file_atomically(folder / "associations.txt", lists.associations);
  write_file_atomically(folder / "depth.txt", lists.depth);
  write_file_atomically(folder / "rgb.txt", lists.rgb);
}

}  // namespace stillmap
