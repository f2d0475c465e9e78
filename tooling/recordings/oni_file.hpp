// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/io/input_file.hpp"

namespace stillmap {

/// What the images of a stream show.
enum class OniKind { kColor, kDepth, kOther };

/// An image of an .oni file: when it was taken, and where its bytes are.
struct OniImage {
  std::uint64_t stamp_us = 0;
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0;
};

/// A stream of images of an .oni file.
struct OniStream {
  std::string name;  ///< such as "Depth"
  OniKind kind = OniKind::kOther;
  std::string codec;  ///< how its images are stored: "NONE", "JPEG", "16zT", "16zP"
  cv::Size size;
  bool mirrored = false;                ///< left and right are exchanged
  double units_per_m = 1000;            ///< of depth
  double across_rad = 0, down_rad = 0;  ///< field of view; 0: not told
  std::vector<OniImage> images;         ///< in the order of the file
};

/// A recording of OpenNI (1 or 2): its records are listed, and images read one by one.
class OniFile {
 public:
  /// Throws Error for a file that is none. One that ends in the middle of a record has the images
  /// before that, and rest() is not 0.
  explicit OniFile(const std::filesystem::path& path);

  [[nodiscard]] const std::vector<OniStream>& streams() const { return streams_; }
  /// The bytes at the end that are no whole records.
  [[nodiscard]] std::uint64_t rest() const { return rest_; }
  /// The bytes of an image. Any thread may call. Throws DamagedImage for more than 256 MiB.
  [[nodiscard]] std::string read(const OniImage& image) const;

 private:
  struct Record;
  void list_records();
  void take(const Record& record);

  std::string path_;
  InputFile file_;
  std::vector<OniStream> streams_;
  std::map<std::uint32_t, std::size_t> stream_of_node_;
  std::uint64_t rest_ = 0;
};

/// Whether a file begins as those of OpenNI do.
[[nodiscard]] bool is_oni(const std::filesystem::path& path);

}  // namespace stillmap
