// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/image_files.hpp"

#include <string>
#include <string_view>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/input_file.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap {
namespace {

class ImageFiles : public ImageReader {
 public:
  explicit ImageFiles(std::vector<SequenceEntry> entries) : entries_(std::move(entries)) {}

  [[nodiscard]] ColorFile color(std::size_t index) const override {
    return read_color_file(entries_.at(index).color_file);
  }
  [[nodiscard]] DepthImage depth(std::size_t index, double depth_factor) const override {
    return read_depth(entries_.at(index).depth_file, depth_factor);
  }

 private:
  std::vector<SequenceEntry> entries_;
};

}  // namespace

std::shared_ptr<const ImageReader> read_image_files(std::vector<SequenceEntry> entries) {
  return std::make_shared<ImageFiles>(std::move(entries));
}

bool is_depth_file(const std::filesystem::path& path) {
  // The header of a PNG: signature, length and name of the first chunk, sizes, bits, kind of pixel.
  constexpr std::size_t kHeaderBytes = 26, kBits = 24, kKind = 25;
  try {
    const InputFile file(path);
    if (file.size() < kHeaderBytes) return false;
    const std::string header = file.read(0, kHeaderBytes);
    return is_png(header) && header[kBits] == 16 && header[kKind] == 0;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace stillmap
