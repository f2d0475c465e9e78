// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/recording_formats.hpp"

#include <vector>

#include "tooling/recordings/euroc.hpp"
#include "tooling/recordings/kitti.hpp"
#include "tooling/recordings/oni.hpp"
#include "tooling/recordings/oni_file.hpp"
#include "tooling/recordings/ros_bag.hpp"

namespace stillmap {

std::span<const SequenceFormat> recording_formats() {
  static const std::vector<SequenceFormat> kFormats = [] {
    std::vector<SequenceFormat> formats = {
        {"rosbag", "a bag of ROS 1 (*.bag)", is_ros_bag, open_ros_bag},
        {"oni", "a recording of OpenNI (*.oni)", is_oni, open_oni}};
    const std::span<const SequenceFormat> folders = folder_formats();
    formats.insert(formats.end(), folders.begin(), folders.end());
    formats.push_back({"euroc", "mav0/ with cam0/ and cam1/", is_euroc, open_euroc});
    formats.push_back(
        {"kitti", "calib.txt, times.txt, image_0/ and image_1/", is_kitti, open_kitti});
    return formats;
  }();
  return kFormats;
}

}  // namespace stillmap
