// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace stillmap {

/// An image for BagWriter.
struct ImageToWrite {
  std::uint32_t width_px = 0, height_px = 0;
  std::string encoding;
  std::uint32_t row_bytes = 0;
  std::vector<std::uint8_t> bytes;
};

/// A calibration for BagWriter.
struct InfoToWrite {
  std::uint32_t width_px = 0, height_px = 0;
  std::string model;
  std::vector<double> D, K, P;  // of any, 9 and 12 numbers
};

/// Writes a bag of ROS 1 with its own library. Stamps are nanoseconds.
class BagWriter {
 public:
  enum class Compression { kNone, kLz4, kBz2 };

  explicit BagWriter(const std::string& path, Compression compression = Compression::kNone);
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;
  ~BagWriter();  ///< closes the bag

  void write(const std::string& topic, std::uint64_t stamp_ns, const ImageToWrite& image);
  void write(const std::string& topic, std::uint64_t stamp_ns, const InfoToWrite& info);
  void write_compressed(const std::string& topic,
                        std::uint64_t stamp_ns,
                        const std::string& format,
                        const std::vector<std::uint8_t>& file);
  void write_number(const std::string& topic, std::uint64_t stamp_ns, float number);

 private:
  class Library;
  std::unique_ptr<Library> library_;
};

}  // namespace stillmap
