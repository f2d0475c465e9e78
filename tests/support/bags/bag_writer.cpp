// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bags/bag_writer.hpp"

#include <algorithm>

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Float32.h>

namespace stillmap {

class BagWriter::Library {
 public:
  rosbag::Bag bag;
};

namespace {

ros::Time time_of(std::uint64_t stamp_ns) {
  return {static_cast<std::uint32_t>(stamp_ns / 1000000000U),
          static_cast<std::uint32_t>(stamp_ns % 1000000000U)};
}

}  // namespace

BagWriter::BagWriter(const std::string& path, Compression compression)
    : library_(std::make_unique<Library>()) {
  library_->bag.open(path, rosbag::bagmode::Write);
  if (compression == Compression::kLz4) library_->bag.setCompression(rosbag::compression::LZ4);
  if (compression == Compression::kBz2) library_->bag.setCompression(rosbag::compression::BZ2);
}

BagWriter::~BagWriter() = default;

void BagWriter::write(const std::string& topic, std::uint64_t stamp_ns, const ImageToWrite& image) {
  sensor_msgs::Image message;
  message.header.stamp = time_of(stamp_ns);
  message.header.frame_id = "camera";
  message.width = image.width_px;
  message.height = image.height_px;
  message.encoding = image.encoding;
  message.step = image.row_bytes;
  message.data = image.bytes;
  library_->bag.write(topic, time_of(stamp_ns), message);
}

void BagWriter::write(const std::string& topic, std::uint64_t stamp_ns, const InfoToWrite& info) {
  sensor_msgs::CameraInfo message;
  message.header.stamp = time_of(stamp_ns);
  message.width = info.width_px;
  message.height = info.height_px;
  message.distortion_model = info.model;
  message.D = info.D;
  std::copy(info.K.begin(), info.K.end(), message.K.begin());
  std::copy(info.P.begin(), info.P.end(), message.P.begin());
  library_->bag.write(topic, time_of(stamp_ns), message);
}

void BagWriter::write_compressed(const std::string& topic,
                                 std::uint64_t stamp_ns,
                                 const std::string& format,
                                 const std::vector<std::uint8_t>& file) {
  sensor_msgs::CompressedImage message;
  message.header.stamp = time_of(stamp_ns);
  message.format = format;
  message.data = file;
  library_->bag.write(topic, time_of(stamp_ns), message);
}

void BagWriter::write_number(const std::string& topic, std::uint64_t stamp_ns, float number) {
  std_msgs::Float32 message;
  message.data = number;
  library_->bag.write(topic, time_of(stamp_ns), message);
}

}  // namespace stillmap
