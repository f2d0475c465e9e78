// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/recording_formats.hpp"

#include <vector>

#include "tooling/recordings/ros_bag.hpp"

namespace stillmap {

std::span<const SequenceFormat> recording_formats() {
  static const std::vector<SequenceFormat> kFormats = [] {
    std::vector<SequenceFormat> formats = {
        {"rosbag", "a bag of ROS 1 (*.bag)", is_ros_bag, open_ros_bag}};
    const std::span<const SequenceFormat> folders = folder_formats();
    formats.insert(formats.end(), folders.begin(), folders.end());
    return formats;
  }();
  return kFormats;
}

}  // namespace stillmap
